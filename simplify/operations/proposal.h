// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "simplify/constraints/surface_grid.h"
#include "simplify/mesh/editable_mesh.h"
#include "simplify/mesh/outcome.h"
#include "simplify/mesh/star.h"
#include "simplify/operations/block_rules.h"

namespace tetwright {

/// A tet that an operation puts into a cavity.
struct NewTet {
  Tet points;
  RegionId region;
  float quality;
};

/// What an operation has decided: everything that its commit will write. Kept and used again, so that
/// deciding does not allocate.
struct Proposal {
  enum class Change : std::uint8_t {
    none,
    move,      ///< a point goes to another place
    collapse,  ///< a point goes, and with it the tets that have its target
    replace    ///< tets give way to others, which may have a new point
  };

  Change change = Change::none;
  Operation operation = Operation::collapse;
  /// The turn goes on with this stage of its list's attempt when this is committed; below 0: it ends.
  int next_stage = -1;

  /// The points of all tets that change. The first `read_set_size` of them are the read set: points whose
  /// stars were read, among them two points of each removed tet.
  std::vector<Index> write_set;
  std::size_t read_set_size = 0;

  Index centre = no_index;       ///< move, collapse: the point
  Index target = no_index;       ///< collapse: what it is drawn onto
  Vec3 position = Vec3::Zero();  ///< move: the new place; replace: that of the new point

  /// Move and collapse: a tet that stays, the slot of the centre in it, and its new quality.
  struct RatedTet {
    Index tet;
    std::uint8_t slot;
    float quality;
  };
  std::vector<RatedTet> rated;

  /// Collapse: a link that a tet gets in place of the one to a tet that goes.
  struct Relink {
    Index tet;
    std::uint8_t face;
    FaceLink link;
  };
  std::vector<Relink> relinks;
  /// Collapse: points whose incident tet goes, and the one they get.
  struct Incident {
    Index point, tet;
  };
  std::vector<Incident> incidents;

  std::vector<Index> removed;  ///< collapse and replace: tets that go
  std::vector<NewTet> added;   ///< replace: tets that come
  bool has_new_point = false;
  /// Replace: a face of the cavity's hull, ids ascending; on the boundary `tet` is no_index.
  struct HullFace {
    Triangle key;
    Index tet;          ///< outside the cavity
    std::uint8_t face;  ///< of that tet
    RegionId region;    ///< of that tet
    PatchId patch;      ///< of a boundary face
  };
  std::vector<HullFace> hull;
  std::vector<Index> orphans;  ///< replace: points whose incident tet goes

  SurfaceGrid::Edit edit;
  std::vector<VolumeChange> volumes;
  std::int64_t count_change = 0;
  CountBounds count_bounds;

  /// Filled when the proposal has won: the slots of added tets beyond the removed ones, the new point.
  std::vector<Index> new_tets;
  Index new_point_id = no_index;

  void clear();
  std::span<const Index> read_set() const { return std::span(write_set).first(read_set_size); }
  /// The write set becomes the star's points and its centre, the read set the centre.
  void claim_star(const Star& star);
  /// Write set and read set become all points of the removed tets; collects the hull and the orphans.
  /// `removed` must be filled.
  void claim_cavity(const EditableMesh& mesh);
};

// The steps of a batch of proposals. One thread at a time, but for commit().

/// Makes room for so many tets, beyond those that go, and points. All vertices are free; at most so many
/// proposals may win.
void begin_batch(EditableMesh& mesh, std::size_t proposals, std::size_t new_tets, std::size_t new_points);
/// Makes a proposal a winner: claims its write set, gives it free slots, and takes back those of removed
/// tets. \pre mesh.reservations().free(proposal.read_set()).
void grant(EditableMesh& mesh, SurfaceGrid& grid, Proposal& proposal);

/// Memory of commit().
struct CommitWorkspace {
  struct Side {
    Triangle key;
    Index tet;  ///< no_index: a boundary face of the hull
    std::uint8_t face;
    RegionId region;
    PatchId patch;
    bool outer;  ///< of the hull, else of a new tet
  };
  std::vector<Side> sides;
  std::vector<Index> slots;
};

/// Carries out a proposal that has won: writes its write set. Safe concurrently with other winners of its
/// batch.
void commit(EditableMesh& mesh, SurfaceGrid& grid, const Proposal& proposal, CommitWorkspace& ws);
/// After the last commit: what its winners gave back may be given again.
void end_batch(EditableMesh& mesh, SurfaceGrid& grid);

/// A batch of one, which wins.
void commit_alone(EditableMesh& mesh, SurfaceGrid& grid, Proposal& proposal, CommitWorkspace& ws);

}  // namespace tetwright
