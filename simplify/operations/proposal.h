// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "simplify/constraints/surface_grid.h"
#include "simplify/mesh/editable_mesh.h"
#include "simplify/mesh/star.h"
#include "simplify/operations/block_rules.h"
#include "tetwright/simplify.h"

namespace tetwright {

/// A tet that an operation adds in a cavity.
struct NewTet {
  Tet points;
  RegionId region;
  float quality;
};

/// An operation's decision: all data that its commit will write. Reused, so that deciding does not allocate.
struct Proposal {
  enum class Change : std::uint8_t {
    none,
    move,      ///< a point moves
    collapse,  ///< a point is removed with the tets that also have its target
    replace    ///< tets are replaced by others, which may have a new point
  };

  Change change = Change::none;
  Operation operation = Operation::collapse;
  /// Stage at which processing of the item continues after this proposal is committed; below 0: it ends.
  int next_stage = -1;

  /// The points of all changed tets. The first `read_set_size` of them are the read set: points whose stars
  /// were read, including two points of each removed tet.
  std::vector<Index> write_set;
  std::size_t read_set_size = 0;

  Index centre = no_index;       ///< move, collapse: the point
  Index target = no_index;       ///< collapse: the point that it moves onto
  Vec3 position = Vec3::Zero();  ///< move: the new position; replace: that of the new point

  /// Move and collapse: a remaining tet, the centre's slot in it, and its new quality.
  struct RatedTet {
    Index tet;
    std::uint8_t slot;
    float quality;
  };
  std::vector<RatedTet> rated;

  /// Collapse: a tet's new link, replacing one to a removed tet.
  struct Relink {
    Index tet;
    std::uint8_t face;
    FaceLink link;
  };
  std::vector<Relink> relinks;
  /// Collapse: a point whose incident tet is removed, and its new one.
  struct Incident {
    Index point, tet;
  };
  std::vector<Incident> incidents;

  std::vector<Index> removed;  ///< collapse and replace: removed tets
  std::vector<NewTet> added;   ///< replace: added tets
  bool has_new_point = false;
  /// Replace: a face of the cavity's hull; key: ids ascending.
  struct HullFace {
    Triangle key;
    Index tet;          ///< tet outside the cavity; no_index: boundary
    std::uint8_t face;  ///< of that tet
    RegionId region;    ///< of that tet
    PatchId patch;      ///< of a boundary face
    bool interface;
  };
  std::vector<HullFace> hull;
  std::vector<Index> orphans;  ///< replace: points whose incident tet is removed

  SurfaceGrid::Edit edit;
  std::vector<VolumeChange> volumes;
  std::int64_t count_change = 0;
  CountBounds count_bounds;

  /// Filled when the proposal wins: slots for added tets in excess of the removed ones, id of the new point.
  std::vector<Index> new_tets;
  Index new_point_id = no_index;

  void clear();
  std::span<const Index> read_set() const { return std::span(write_set).first(read_set_size); }
  /// Sets the write set to the star's points and its centre, the read set to the centre.
  void claim_star(const Star& star);
  /// Sets write set and read set to all points of the removed tets; collects the hull and the orphans.
  /// \pre `removed` is filled.
  void claim_cavity(const EditableMesh& mesh);
};

// The steps of a batch of proposals. All but commit() run on one thread at a time.

/// Makes room for new points and for new tets in excess of those removed, and frees all vertices.
///
/// \param proposals max number of winners.
void begin_batch(EditableMesh& mesh, std::size_t proposals, std::size_t new_tets, std::size_t new_points);
/// Makes a proposal a winner: claims its write set, assigns free slots to it, and gives back those of removed
/// tets.
/// \pre mesh.reservations().free(proposal.read_set()).
void grant(EditableMesh& mesh, SurfaceGrid& grid, Proposal& proposal);

/// Scratch memory of commit().
struct CommitWorkspace {
  struct Side {
    Triangle key;
    Index tet;  ///< no_index: a boundary face of the hull
    std::uint8_t face;
    RegionId region;
    PatchId patch;
    bool outer;      ///< a face of the hull, else of a new tet
    bool interface;  ///< of a face of the hull
  };
  std::vector<Side> sides;
  std::vector<Index> slots;
};

/// Carries out a winning proposal: writes its write set. Safe concurrently with other winners of its batch.
void commit(EditableMesh& mesh, SurfaceGrid& grid, const Proposal& proposal, CommitWorkspace& ws);
/// Ends the batch after its last commit: slots given back by its winners become free.
void end_batch(EditableMesh& mesh, SurfaceGrid& grid);

/// Grants and commits this proposal as a batch of its own.
void commit_alone(EditableMesh& mesh, SurfaceGrid& grid, Proposal& proposal, CommitWorkspace& ws);

}  // namespace tetwright
