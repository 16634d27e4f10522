// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <set>

#include "mesher/complex/labelled_complex.h"

namespace tetwright {

/// Volume of a region, from the faces around it.
inline double volume_of(const LabelledComplex& complex, RegionIndex region) {
  double out = 0;
  for (const LabelledComplex::Face& f : complex.faces) {
    const auto& [a, b, c] = f.ids;
    const double volume = complex.points[a].dot(complex.points[b].cross(complex.points[c])) / 6;
    out += (f.behind == region ? volume : 0) - (f.front == region ? volume : 0);
  }
  return out;
}

/// Euler number of all contacts.
inline int contact_euler(const LabelledComplex& complex) {
  std::set<Index> points;
  std::set<std::array<Index, 2>> edges;
  int faces = 0;
  for (Index f = 0; f < complex.faces.size(); ++f) {
    if (!complex.is_contact(f)) continue;
    ++faces;
    const Triangle& t = complex.faces[f].ids;
    for (std::size_t k = 0; k < 3; ++k) {
      points.insert(t[k]);
      edges.insert(ascending_edge(t[k], t[(k + 1) % 3]));
    }
  }
  return static_cast<int>(points.size()) - static_cast<int>(edges.size()) + faces;
}

}  // namespace tetwright
