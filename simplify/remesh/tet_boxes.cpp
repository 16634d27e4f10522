#include "simplify/remesh/tet_boxes.h"

#include <algorithm>
#include <bit>

#include "common/parallel/parallel.h"

namespace tetwright {

namespace {

/// Slots of a block: the boxes take little memory beside the tets, and a block is read at once.
constexpr std::size_t block_slots = 32;
constexpr std::size_t block_grain = 512;

}  // namespace

Box3 TetBoxes::block_box(const EditableMesh& mesh, std::size_t block) const {
  Box3 box;
  const std::size_t end = std::min(mesh.tet_slots(), (block + 1) * block_slots);
  for (std::size_t t = block * block_slots; t < end; ++t)
    if (!mesh.dead(static_cast<Index>(t)))
      for (Index p : mesh.points(static_cast<Index>(t))) box.add(mesh.position(p));
  return box;
}

void TetBoxes::build(const EditableMesh& mesh) {
  const std::size_t blocks = (mesh.tet_slots() + block_slots - 1) / block_slots;
  leaves_ = std::bit_ceil(std::max<std::size_t>(1, blocks));
  boxes_.assign(2 * leaves_, Box3());
  parallel_for(0, blocks, block_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) boxes_[leaves_ + b] = block_box(mesh, b);
  });
  for (std::size_t k = leaves_; k-- > 1;) {
    boxes_[k] = boxes_[2 * k];
    boxes_[k].add(boxes_[2 * k + 1]);
  }
}

void TetBoxes::repair(const EditableMesh& mesh, const std::vector<Index>& slots) {
  if (mesh.tet_slots() > leaves_ * block_slots) {  // the mesh has outgrown the tree
    build(mesh);
    return;
  }
  std::vector<std::size_t> nodes;
  nodes.reserve(slots.size());
  for (Index t : slots) nodes.push_back(leaves_ + t / block_slots);
  const auto unique = [&] {
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  };
  unique();
  for (std::size_t k : nodes) boxes_[k] = block_box(mesh, k - leaves_);
  while (!nodes.empty() && nodes.front() > 1) {
    for (std::size_t& k : nodes) k /= 2;
    unique();
    for (std::size_t k : nodes) {
      boxes_[k] = boxes_[2 * k];
      boxes_[k].add(boxes_[2 * k + 1]);
    }
  }
}

std::vector<Index> TetBoxes::tets_in(const EditableMesh& mesh, const Box3& box) const {
  std::vector<Index> found;
  std::vector<std::size_t> open{1};
  while (!open.empty()) {
    const std::size_t k = open.back();
    open.pop_back();
    if (!boxes_[k].intersects(box)) continue;
    if (k < leaves_) {
      open.push_back(2 * k + 1);
      open.push_back(2 * k);
      continue;
    }
    const std::size_t begin = (k - leaves_) * block_slots,
                      end = std::min(mesh.tet_slots(), begin + block_slots);
    for (std::size_t i = begin; i < end; ++i) {
      const auto t = static_cast<Index>(i);
      if (mesh.dead(t)) continue;
      const Tet& points = mesh.points(t);
      if (std::any_of(points.begin(), points.end(), [&](Index p) { return box.contains(mesh.position(p)); }))
        found.push_back(t);
    }
  }
  return found;
}

}  // namespace tetwright
