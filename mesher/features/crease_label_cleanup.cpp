// SPDX-License-Identifier: Apache-2.0
// The last steps of labelling: kinks of creases, islands of patches, points that may give way.
#include <algorithm>

#include "mesher/features/crease_labels.h"
#include "mesher/tuning/cut_tuning.h"

namespace tetwright {

using Labelling = CutTuning::Labelling;

void CreaseLabels::take_kinks() {
  // Choose among vertices on the crease, so that it passes through the kink.
  std::vector<Vec3> positions;
  std::vector<ProjectionTree::Item> items;
  for (Index i = 0; i < points_.size(); ++i) {
    positions.push_back(mesh_.points[points_[i]]);
    if (labels_[i].kind == Kind::crease) items.push_back({{i, i, i}, {i, 0, 0}});
  }
  const ProjectionTree tree(std::move(positions), std::move(items));
  for (Index c = 0; c < surface_.corners().size(); ++c) {
    const FeatureSurface::Corner& corner = surface_.corners()[c];
    if (corner.patches.size() > 2) continue;
    const double reach = Labelling::corner_reach * cell_of(surface_.sheet_of(corner.patches.front()));
    const auto hit = tree.nearest_of(corner.point, reach, [&](const ProjectionTree::Item& item) {
      const Index i = item.kind[0];
      // The vertex must lie between vertices of one patch and vertices of the other.
      return labels_[i].kind == Kind::crease &&
             std::all_of(corner.patches.begin(), corner.patches.end(), [&](FeatureSurface::Patch p) {
               if (!labels_[i].patches.contains(p)) return false;
               bool elsewhere = false;
               for_neighbours(i, [&](Index q) { elsewhere |= !labels_[number_[q]].patches.contains(p); });
               return elsewhere;
             });
    });
    if (!hit) continue;
    FeatureLabel& own = labels_[tree.items()[hit->item].kind[0]];
    own.kind = Kind::corner;
    own.corner = c;
  }
}

void CreaseLabels::dissolve_islands() {
  for (Index i = 0; i < points_.size(); ++i) {
    if (labels_[i].kind != Kind::patch) continue;
    PatchSet shared;
    bool first = true, alone = true;
    for_neighbours(i, [&](Index p) {
      const FeatureLabel& other = labels_[number_[p]];
      // Next to a corner a patch may have no other point.
      alone &= other.kind == Kind::crease;
      shared = first ? other.patches : shared.common(other.patches);
      first = false;
    });
    if (!alone) continue;
    for (const FeatureSurface::Patch patch : shared)
      if (!labels_[i].patches.contains(patch) &&
          surface_.sheet_of(patch) == surface_.sheet_of(*labels_[i].patches.begin()) &&
          surface_.nearest_of_patch(mesh_.points[points_[i]], patch,
                                    Labelling::island_reach * cell_of(surface_.sheet_of(patch)))) {
        labels_[i].patches = {patch};
        break;
      }
  }
}

void CreaseLabels::find_loose_points() {
  loose_.assign(points_.size(), 0);
  for (Index i = 0; i < points_.size(); ++i) {
    const InterfaceTriangle& first = mesh_.interfaces[triangles_at_[i].front()];
    loose_[i] = std::all_of(triangles_at_[i].begin(), triangles_at_[i].end(), [&](Index t) {
      const InterfaceTriangle& face = mesh_.interfaces[t];
      return face.patch == 0 && surface_.is_beside_bodies(face) && face.pair() == first.pair();
    });
  }
}

}  // namespace tetwright
