// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "common/parallel/bucket_sort.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// A face of a tet with its vertices in ascending order.
struct SortedFace {
  Triangle vertices;
  /// True if the tet's outward order of the face (tet_faces) is an even permutation of `vertices`. The value
  /// differs between two positive tets on opposite sides of a face.
  bool even;
};

inline SortedFace sorted_face(const Tet& tet, int face) {
  const auto& f = tet_faces[static_cast<std::size_t>(face)];
  SortedFace s{{tet[f[0]], tet[f[1]], tet[f[2]]}, true};
  const auto order = [&](std::size_t i, std::size_t j) {
    if (s.vertices[i] <= s.vertices[j]) return;
    std::swap(s.vertices[i], s.vertices[j]);
    s.even = !s.even;
  };
  order(0, 1);
  order(1, 2);
  order(0, 1);
  return s;
}

/// Faces of a set of tets, in one bucket for each smallest vertex, built in parallel. Equal faces are in the
/// same bucket, which is sorted when it is visited. Takes four Codes for each tet; sorting all faces would
/// take eight times as much.
///
/// `Code` numbers a face as 4 * tet + face: std::uint32_t for fewer than 2^30 tets, otherwise std::uint64_t.
template <class Code>
class FaceBuckets {
 public:
  /// A tet that has the face.
  struct Use {
    Index tet;
    std::uint8_t face;  ///< index of the tet's vertex opposite the face
    bool even;          ///< SortedFace::even
  };
  /// Buffers reused between visits; one for each thread.
  struct Workspace {
    struct Entry {
      Index middle, largest;
      Use use;
    };
    std::vector<Entry> bucket;
    std::vector<Use> uses;
  };

  /// \param tet_at `tet_at(t)` returns the vertices of tet t, each below `vertices`
  /// \param candidates a flag for each vertex: only faces of three flagged vertices are listed; null: all
  ///   faces
  template <class TetAt>
  FaceBuckets(std::size_t tets, std::size_t vertices, const TetAt& tet_at,
              const std::vector<std::uint8_t>* candidates = nullptr) {
    bucket_sort(
        tets, vertices,
        [&](std::size_t t, const auto& emit) {
          const Tet& tet = tet_at(t);
          for (int f = 0; f < 4; ++f) {
            const auto& c = tet_faces[static_cast<std::size_t>(f)];
            const Index a = tet[c[0]], b = tet[c[1]], d = tet[c[2]];
            if (candidates && !((*candidates)[a] && (*candidates)[b] && (*candidates)[d])) continue;
            emit(std::min({a, b, d}), static_cast<Code>(4 * t + static_cast<std::size_t>(f)));
          }
        },
        [&](Code face) {
          const Tet& tet = tet_at(face / 4);
          const auto& c = tet_faces[face % 4];
          return std::min({tet[c[0]], tet[c[1]], tet[c[2]]});
        },
        starts_, faces_);
  }

  /// Calls `body(vertices, uses)` for each face whose smallest vertex is `vertex`, in lexicographic order of
  /// the vertices, with all its tets in ascending order. Different vertices may be visited concurrently.
  template <class TetAt, class Body>
  void visit(Index vertex, const TetAt& tet_at, Workspace& ws, const Body& body) const {
    ws.bucket.clear();
    for (Code i = starts_[vertex]; i < starts_[vertex + std::size_t{1}]; ++i) {
      const auto tet = static_cast<Index>(faces_[i] / 4);
      const auto face = static_cast<std::uint8_t>(faces_[i] % 4);
      const SortedFace s = sorted_face(tet_at(tet), face);
      ws.bucket.push_back({s.vertices[1], s.vertices[2], {tet, face, s.even}});
    }
    std::sort(ws.bucket.begin(), ws.bucket.end(), [](const auto& a, const auto& b) {
      return std::tie(a.middle, a.largest, a.use.tet, a.use.face) <
             std::tie(b.middle, b.largest, b.use.tet, b.use.face);
    });
    for (std::size_t i = 0; i < ws.bucket.size();) {
      const Index middle = ws.bucket[i].middle, largest = ws.bucket[i].largest;
      ws.uses.clear();
      for (; i < ws.bucket.size() && ws.bucket[i].middle == middle && ws.bucket[i].largest == largest; ++i)
        ws.uses.push_back(ws.bucket[i].use);
      body(Triangle{vertex, middle, largest}, std::span<const Use>(ws.uses));
    }
  }

 private:
  std::vector<Code> starts_;  ///< the bucket of vertex v is faces_[starts_[v]] to faces_[starts_[v + 1]]
  std::vector<Code> faces_;
};

}  // namespace tetwright
