// SPDX-License-Identifier: Apache-2.0
#include "mesher/features/near_tets.h"

#include <algorithm>
#include <set>
#include <tuple>

namespace tetwright {

NearTets::NearTets(const TetMesh& mesh, const FeatureSurface& surface, const SheetParts* parts,
                   const std::vector<std::uint8_t>& is_near)
    : mesh_(mesh), surface_(surface), parts_(parts) {
  for (Index t = 0; t < mesh.tets.size(); ++t)
    if (std::any_of(mesh.tets[t].begin(), mesh.tets[t].end(), [&](Index p) { return is_near[p] != 0; }))
      tets_.push_back(t);
  number_points();
  find_neighbours(is_near);
  for (Index n = 0; n < tets_.size(); ++n)
    for (const Index p : points_of(n)) {
      at_[number_[p]].push_back(n);
      labels_at_[number_[p]].push_back(label(n));
    }
  for (Index i = 0; i < labels_at_.size(); ++i) {
    std::vector<Label>& own = labels_at_[i];
    if (is_on_boundary_[i]) own.push_back(Label{});
    std::sort(own.begin(), own.end());
    own.erase(std::unique(own.begin(), own.end()), own.end());
  }
}

void NearTets::number_points() {
  number_.assign(mesh_.points.size(), no_index);
  Index count = 0;
  for (Index n = 0; n < tets_.size(); ++n)
    for (const Index p : points_of(n))
      if (number_[p] == no_index) number_[p] = count++;
  at_.resize(count);
  labels_at_.resize(count);
  is_on_boundary_.assign(count, 0);
}

void NearTets::find_neighbours(const std::vector<std::uint8_t>& is_near) {
  struct Side {
    Triangle key;
    Index near, face;
  };
  std::vector<Side> sides;
  for (Index n = 0; n < tets_.size(); ++n)
    for (Index k = 0; k < 4; ++k) {
      Triangle key = face_of(n, k);
      std::sort(key.begin(), key.end());
      sides.push_back({key, n, k});
    }
  std::sort(sides.begin(), sides.end(),
            [](const Side& a, const Side& b) { return std::tie(a.key, a.near) < std::tie(b.key, b.near); });
  neighbours_.assign(tets_.size(), {far, far, far, far});
  std::set<Triangle> boundary;
  for (const InterfaceTriangle& f : mesh_.interfaces) {
    if (f.other || std::none_of(f.ids.begin(), f.ids.end(), [&](Index p) { return is_near[p]; })) continue;
    Triangle key = f.ids;
    std::sort(key.begin(), key.end());
    boundary.insert(key);
    for (const Index p : f.ids)
      if (has(p)) is_on_boundary_[number_[p]] = 1;
  }
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const Side& side = sides[i];
    if (i + 1 < sides.size() && sides[i + 1].key == side.key) {
      neighbours_[side.near][side.face] = sides[i + 1].near;
      neighbours_[sides[i + 1].near][sides[i + 1].face] = side.near;
      ++i;
    } else if (boundary.contains(side.key)) {
      neighbours_[side.near][side.face] = none;
    }
  }
}

NearTets::Label NearTets::label(Index near) const {
  const Index t = tets_[near];
  Label own;
  if (mesh_.materials[t] != outside_tag) own.material = mesh_.materials[t];
  if (parts_) own.part = parts_->of_tets[t];
  return own;
}

std::uint32_t NearTets::component_between(const Label& a, const Label& b) const {
  return parts_ && a.part != b.part ? parts_->field->component_between(a.part, b.part) : no_index;
}

bool NearTets::are_divided(const Label& a, const Label& b) const {
  return a.material != b.material || component_between(a, b) != no_index;
}

bool NearTets::are_any_divided(const std::vector<Label>& labels) const {
  for (auto a = labels.begin(); a != labels.end(); ++a)
    for (auto b = std::next(a); b != labels.end(); ++b)
      if (are_divided(*a, *b)) return true;
  return false;
}

std::optional<std::size_t> NearTets::sheet_at(Index p) const {
  std::optional<std::size_t> only;
  const std::vector<Label>& labels = labels_at(p);
  for (auto a = labels.begin(); a != labels.end(); ++a)
    for (auto b = std::next(a); b != labels.end(); ++b) {
      if (!are_divided(*a, *b)) continue;
      const auto sheet = sheet_between(*a, *b);
      if (!sheet || (only && *only != *sheet)) return {};
      only = sheet;
    }
  return only;
}

std::optional<std::size_t> NearTets::sheet_between(const Label& a, const Label& b) const {
  const Label &inside = a.material ? a : b, &other = a.material ? b : a;
  InterfaceTriangle face{{}, *inside.material, other.material};
  if (a.material == b.material) face.patch = static_cast<std::uint16_t>(component_between(a, b));
  return surface_.sheet_of(face);
}

}  // namespace tetwright
