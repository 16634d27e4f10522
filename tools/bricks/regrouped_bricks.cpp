// SPDX-License-Identifier: Apache-2.0
#include "tools/bricks/regrouped_bricks.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/mesh/point_joining.h"
#include "mesher/field_mesher.h"
#include "tools/bricks/brick_estimate.h"
#include "tools/bricks/joined_parts.h"
#include "tools/tuning/brick_rounds_tuning.h"

namespace tetwright {

ShiftedBricks::ShiftedBricks(const LabelInput& labels, double cell, int cells, int round)
    : origin_(labels.origin) {
  const std::array<double, 3> voxels = voxels_of_bricks(labels, cell, cells);
  const double offset = BrickRoundsTuning::offset[static_cast<std::size_t>(round - 1)];
  // The lattice is right-handed (label_frame()): cuts are counted from the other end of the last axis if the
  // volume is not.
  Eigen::Matrix3d steps = labels.directions;
  if (steps.determinant() < 0) {
    origin_ += steps.col(2) * (labels.size[2] - 1);
    steps.col(2) = -steps.col(2);
  }
  to_bricks_ = steps.inverse();
  for (int a = 0; a < 3; ++a) {
    to_bricks_.row(a) /= voxels[a];
    counts_[a] = static_cast<std::size_t>(std::max(1.0, std::ceil(labels.size[a] / voxels[a] + offset)));
    // The first voxel's lower side is `offset` bricks into the first brick.
    origin_ -= steps.col(a) * (0.5 + offset * voxels[a]);
  }
}

std::size_t ShiftedBricks::brick_at(const Vec3& centroid) const {
  const Vec3 at = to_bricks_ * (centroid - origin_);
  std::array<std::size_t, 3> brick;
  for (int a = 0; a < 3; ++a)
    brick[a] =
        static_cast<std::size_t>(std::clamp(std::floor(at[a]), 0.0, static_cast<double>(counts_[a] - 1)));
  return (brick[2] * counts_[1] + brick[1]) * counts_[0] + brick[0];
}

std::vector<CellBox> ShiftedBricks::boxes() const {
  std::vector<CellBox> boxes;
  for (std::size_t b = 0; b < count(); ++b) {
    const std::array<std::size_t, 3> at{b % counts_[0], b / counts_[0] % counts_[1],
                                        b / counts_[0] / counts_[1]};
    CellBox& box = boxes.emplace_back();
    for (std::size_t a = 0; a < 3; ++a) {
      box.low[a] = static_cast<int>(at[a]);
      box.high[a] = box.low[a] + 1;
    }
  }
  return boxes;
}

RegroupedBricks::RegroupedBricks(ShiftedBricks bricks, std::size_t count, Read read, const Progress& progress)
    : bricks_(std::move(bricks)), read_(std::move(read)), tets_(bricks_.count(), 0), bricks_of_part_(count) {
  std::vector<std::vector<Vec3>> points(count);
  std::vector<std::vector<Brick>> bricks_of_points(count);
  for (std::size_t p = 0; p < count; ++p) {
    progress.throw_if_stopped();
    const std::shared_ptr<const BrickPart> part = read_(p);
    const std::vector<Brick> of_tets = bricks_of_tets(part->mesh);
    for (const Brick b : of_tets) ++tets_[b];
    std::vector<Brick>& all = bricks_of_part_[p];
    all = of_tets;
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    all.shrink_to_fit();
    const std::vector<Brick> of_points = this->bricks_of_points(p, *part, of_tets);
    for (std::size_t i = 0; i < of_points.size(); ++i)
      if (part->flags[i] & BrickPart::shared) {
        points[p].push_back(part->mesh.points[i]);
        bricks_of_points[p].push_back(of_points[i]);
      }
  }
  std::vector<std::vector<std::uint8_t>> shared(count);
  std::vector<PiecePoints> pieces;
  for (std::size_t p = 0; p < count; ++p) {
    shared[p].assign(points[p].size(), 1);
    pieces.push_back({points[p], shared[p]});
  }
  JoinedPoints joined = join_points(pieces);
  brick_of_shared_.assign(joined.count, none);
  for (std::size_t p = 0; p < count; ++p)
    for (std::size_t i = 0; i < bricks_of_points[p].size(); ++i) {
      Brick& known = brick_of_shared_[joined.numbers[p][i]];
      const Brick brick = bricks_of_points[p][i];
      known = known == none || known == brick ? brick : several;
    }
  shared_of_part_ = std::move(joined.numbers);
}

std::vector<RegroupedBricks::Brick> RegroupedBricks::bricks_of_tets(const TetMesh& mesh) const {
  std::vector<Brick> bricks;
  bricks.reserve(mesh.tets.size());
  for (const Tet& t : mesh.tets)
    bricks.push_back(static_cast<Brick>(bricks_.brick_at(
        (mesh.points[t[0]] + mesh.points[t[1]] + mesh.points[t[2]] + mesh.points[t[3]]) / 4)));
  return bricks;
}

std::vector<RegroupedBricks::Brick> RegroupedBricks::bricks_of_points(
    std::size_t p, const BrickPart& part, const std::vector<Brick>& of_tets) const {
  std::vector<Brick> bricks(part.mesh.points.size(), none);
  for (std::size_t t = 0; t < of_tets.size(); ++t)
    for (const Index i : part.mesh.tets[t])
      bricks[i] = bricks[i] == none || bricks[i] == of_tets[t] ? of_tets[t] : several;
  if (shared_of_part_.empty()) return bricks;
  std::size_t next = 0;
  for (std::size_t i = 0; i < bricks.size(); ++i)
    if (part.flags[i] & BrickPart::shared) bricks[i] = brick_of_shared_[shared_of_part_[p][next++]];
  return bricks;
}

BrickPart RegroupedBricks::piece(std::size_t p, Brick brick, std::vector<Vec3>& shared) const {
  const std::shared_ptr<const BrickPart> part = read_(p);
  const TetMesh& mesh = part->mesh;
  const std::vector<Brick> of_tets = bricks_of_tets(mesh);
  const std::vector<Brick> of_points = bricks_of_points(p, *part, of_tets);
  std::vector<Index> number(mesh.points.size(), no_index);
  BrickPart piece;
  for (std::size_t t = 0; t < of_tets.size(); ++t) {
    if (of_tets[t] != brick) continue;
    Tet tet = mesh.tets[t];
    for (Index& i : tet) {
      if (number[i] == no_index) {
        number[i] = static_cast<Index>(piece.mesh.points.size());
        piece.mesh.points.push_back(mesh.points[i]);
        piece.flags.push_back(part->flags[i]);
        if (of_points[i] == several) {
          piece.flags.back() |= BrickPart::on_interface;
          shared.push_back(mesh.points[i]);
        }
      }
      i = number[i];
    }
    piece.mesh.tets.push_back(tet);
    piece.mesh.materials.push_back(mesh.materials[t]);
  }
  // Faces of tets in other bricks are among them; the joined mesh does not have these faces.
  for (InterfaceTriangle t : mesh.interfaces) {
    for (Index& i : t.ids) i = number[i];
    if (std::find(t.ids.begin(), t.ids.end(), no_index) == t.ids.end()) piece.mesh.interfaces.push_back(t);
  }
  return piece;
}

BrickPieces RegroupedBricks::pieces(std::size_t brick, const Progress* progress) const {
  const Brick number = static_cast<Brick>(brick);
  BrickPieces pieces;
  pieces.brick = bricks_.boxes()[brick];
  for (std::size_t p = 0; p < bricks_of_part_.size(); ++p)
    if (std::binary_search(bricks_of_part_[p].begin(), bricks_of_part_[p].end(), number)) {
      if (progress) progress->throw_if_stopped();
      pieces.parts.push_back(piece(p, number, pieces.shared));
    }
  return pieces;
}

BrickPart coarsen_pieces(BrickPieces pieces, const BrickTask& task, double density,
                         const std::shared_ptr<const MaterialField>& field, CoarsenOptions options,
                         Progress* progress) {
  BrickPart made;
  made.border.brick = pieces.brick;
  made.kept_surface = task.keep_surface;
  if (pieces.parts.empty()) return made;
  TetMesh mesh = join_parts(pieces.parts).mesh;
  std::vector<BrickPart>().swap(pieces.parts);
  double volume = 0;
  for (const Tet& t : mesh.tets) {
    const Vec3& a = mesh.points[t[0]];
    volume += (mesh.points[t[1]] - a).cross(mesh.points[t[2]] - a).dot(mesh.points[t[3]] - a) / 6;
  }
  options.target_tets = density * volume;
  options.frozen = flags_of(mesh, pieces.shared);
  for (std::uint8_t& flag : options.frozen) flag &= BrickPart::shared;
  if (task.keep_surface)
    for (const InterfaceTriangle& t : mesh.interfaces)
      if (!t.other && t.patch == 0)
        for (const Index p : t.ids) options.frozen[p] = 1;
  const auto reference = field ? reference_of(mesh, field) : nullptr;
  options.reference = reference.get();
  made.mesh = coarsen(std::move(mesh), options, nullptr, progress);
  made.flags = flags_of(made.mesh, pieces.shared);
  std::erase_if(made.mesh.interfaces, [](const InterfaceTriangle& t) { return t.patch == 0; });
  return made;
}

}  // namespace tetwright
