// SPDX-License-Identifier: Apache-2.0
#include "simplify/remesh/point_tree.h"

#include <algorithm>

#include "simplify/tuning/tuning.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

using Transfer = SimplifyTuning::Transfer;

constexpr Index root = 0;

}  // namespace

Index PointTree::new_node(Index parent) {
  if (free_.empty()) {
    nodes_.emplace_back();
    free_.push_back(static_cast<Index>(nodes_.size() - 1));
  }
  const Index node = free_.back();
  free_.pop_back();
  nodes_[node].axis = leaf;
  nodes_[node].parent = parent;
  return node;
}

void PointTree::free_node(Index node) {
  nodes_[node].points = {};
  free_.push_back(node);
}

void PointTree::build(const EditableMesh& mesh) {
  nodes_.clear();
  free_.clear();
  new_node(no_index);
  for (Index p = 0; p < mesh.point_slots(); ++p)
    if (mesh.incident_tet(p) != no_index) nodes_[root].points.push_back(p);
  // Reserve space for all possible nodes, so that no later change reallocates.
  nodes_.reserve(2 * (4 * nodes_[root].points.size() / Transfer::first_leaf_points + 1));
  halve(mesh, root, Transfer::first_leaf_points);
}

void PointTree::halve(const EditableMesh& mesh, Index first, std::size_t max_points) {
  std::vector<Index> open{first};
  while (!open.empty()) {
    const Index node = open.back();
    open.pop_back();
    std::vector<Index>& points = nodes_[node].points;
    if (points.size() <= max_points) continue;
    Box3 box;
    for (const Index p : points) box.add(mesh.position(p));
    int axis;
    if (!((box.high - box.low).maxCoeff(&axis) > 0)) continue;  // all points coincide
    const auto middle = points.begin() + static_cast<std::ptrdiff_t>(points.size() / 2);
    const auto before = [&](Index a, Index b) { return mesh.position(a)[axis] < mesh.position(b)[axis]; };
    std::nth_element(points.begin(), middle, points.end(), before);
    double split = mesh.position(*middle)[axis];
    // Neither side may be empty.
    if (split == box.low[axis]) {
      split = box.high[axis];
      for (const Index p : points)
        if (const double x = mesh.position(p)[axis]; x > box.low[axis]) split = std::min(split, x);
    }
    const auto upper =
        std::partition(points.begin(), points.end(), [&](Index p) { return mesh.position(p)[axis] < split; });
    std::vector<Index> low(points.begin(), upper), high(upper, points.end());
    const Index a = new_node(node), b = new_node(node);
    nodes_[node].split = split;
    nodes_[node].axis = axis;
    nodes_[node].children = {a, b};
    nodes_[node].points = {};
    nodes_[a].points = std::move(low);
    nodes_[b].points = std::move(high);
    open.push_back(a);
    open.push_back(b);
  }
}

Index PointTree::leaf_of(const Vec3& position) const {
  Index node = root;
  while (nodes_[node].axis != leaf)
    node = nodes_[node].children[position[nodes_[node].axis] < nodes_[node].split ? 0 : 1];
  return node;
}

void PointTree::repair(const EditableMesh& mesh, std::span<const ChangeJournal::OldPoint> changed) {
  const auto is = [&](Index p) { return mesh.incident_tet(p) != no_index; };
  std::vector<Index> coming;
  // Erase all before inserting any: leaves are halved by the current positions of their points.
  for (const ChangeJournal::OldPoint& p : changed) {
    if (is(p.point)) coming.push_back(p.point);
    if (p.existed) erase(p.point, p.position);
  }
  for (const Index p : coming) insert(mesh, p);
}

void PointTree::insert(const EditableMesh& mesh, Index point) {
  const Index node = leaf_of(mesh.position(point));
  nodes_[node].points.push_back(point);
  halve(mesh, node, Transfer::leaf_points);
}

void PointTree::erase(Index point, const Vec3& position) {
  const Index node = leaf_of(position);
  std::vector<Index>& points = nodes_[node].points;
  const auto found = std::find(points.begin(), points.end(), point);
  TETWRIGHT_CHECK(found != points.end());
  *found = points.back();
  points.pop_back();
  shrink(node);
}

void PointTree::shrink(Index node) {
  const Index parent = nodes_[node].parent;
  if (parent == no_index) return;
  const auto [a, b] = nodes_[parent].children;
  const Index other = a == node ? b : a;
  if (nodes_[other].axis == leaf) {
    if (nodes_[node].points.size() + nodes_[other].points.size() > Transfer::joined_points) return;
    nodes_[parent].points = std::move(nodes_[node].points);
    nodes_[parent].points.insert(nodes_[parent].points.end(), nodes_[other].points.begin(),
                                 nodes_[other].points.end());
    nodes_[parent].axis = leaf;
  } else {
    if (!nodes_[node].points.empty()) return;
    nodes_[parent].axis = nodes_[other].axis;
    nodes_[parent].split = nodes_[other].split;
    nodes_[parent].children = nodes_[other].children;
    for (const Index child : nodes_[other].children) nodes_[child].parent = parent;
  }
  free_node(node);
  free_node(other);
}

std::vector<Index> PointTree::points_in(const EditableMesh& mesh, const Box3& box) const {
  std::vector<Index> found, open{root};
  while (!open.empty()) {
    const Node& node = nodes_[open.back()];
    open.pop_back();
    if (node.axis == leaf) {
      for (const Index p : node.points)
        if (box.contains(mesh.position(p))) found.push_back(p);
      continue;
    }
    if (box.low[node.axis] < node.split) open.push_back(node.children[0]);
    if (box.high[node.axis] >= node.split) open.push_back(node.children[1]);
  }
  return found;
}

}  // namespace tetwright
