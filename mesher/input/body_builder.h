// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "mesher/input/divided_surface.h"
#include "mesher/input/partitioning.h"
#include "mesher/input/wall_separation.h"
#include "tetwright/mesher_input.h"
#include "tetwright/progress.h"

namespace tetwright {

/// Makes the bodies of an input from its surfaces.
class BodyBuilder {
 public:
  /// \param input receives the bodies and findings, and loses groups that are walls; has its layers
  /// \param tags in use
  /// \param progress may be null
  BodyBuilder(MesherInput& input, std::set<MaterialTag> tags, const ContactOptions& contact,
              const CapOptions& caps, Progress* progress)
      : input_(input), tags_(std::move(tags)), contact_(contact), caps_(caps), progress_(progress) {}

  /// Announces surfaces of which every cell becomes a body, also a single one: see join_patches().
  void set_joined(std::map<std::size_t, WalledSurface> joined) { joined_ = std::move(joined); }

  /// Closes flat holes, repairs the surfaces one by one and appends each as a body, followed by its nested
  /// components; or each of its cells, if inner walls divide it. Walls with one material on both sides are
  /// taken out, see walls().
  /// \param partitions further walls between cells
  /// \param names of patches in use; those of the surfaces' groups are added
  /// \throws InputError as repair_surface() does, and for a partition that divides nothing
  /// \throws UsageError for a contact tolerance that is not above 0, and as name_holes() does
  /// \throws Interrupted
  void add(std::vector<MaterialSurface> surfaces, NestedRule nested, RegionRule rule,
           const std::vector<Partition>& partitions = {}, std::set<std::string> names = {});

  /// Renames the cells that contain the points.
  /// \throws UsageError for a point that is in no cell, or in a cell that another seed names differently
  void name(const std::vector<RegionSeed>& seeds);

  /// Walls with one material on both sides, to be kept as sheets: those of each surface that has some.
  const std::vector<SheetSurface>& walls() const { return walls_; }

 private:
  /// A surface that was cleaned, without its walls and with its flat holes closed.
  struct ClosedSurface {
    CleanedSurface cleaned;
    std::optional<WalledSurface> walled;
    std::vector<Diagnostic> findings;

    bool has_cells() const { return walled && !walled->walls; }
  };

  std::vector<ClosedSurface> close_holes(std::vector<MaterialSurface>& surfaces, NestedRule nested,
                                         RegionRule rule, bool partitioned);
  MaterialTag free_tag();
  double tolerance_for(const CleanedSurface& cleaned, const MaterialSurface& from) const;
  bool add_cells(ClosedSurface& surface, const MaterialSurface& from, NestedRule nested);
  void take_walls(const InnerWalls& walls, const CleanedSurface& surface, const DividedSurface& divided,
                  const MaterialSurface& from, RegionRule rule, std::vector<Diagnostic>& findings);
  bool add_layers(const CleanedSurface& cleaned, const MaterialSurface& from, NestedRule nested,
                  const std::vector<Partition>& partitions, std::vector<Diagnostic>& findings);
  void add_bodies(std::vector<SurfaceCell> cells, const MaterialSurface& from,
                  const std::vector<SurfaceRegion>& groups);
  void report_partitions(const DividedSurface& divided, const PartitionedSurface& all,
                         const std::vector<Partition>& partitions, const MaterialSurface& from);
  void report_cells(const DividedSurface& divided, const InnerWalls& walls,
                    std::vector<Diagnostic>& findings) const;
  std::string cell_name(const SurfaceCell& cell, std::size_t number, const MaterialSurface& from,
                        std::set<std::string>& used) const;

  MesherInput& input_;
  std::set<MaterialTag> tags_;
  const ContactOptions& contact_;
  const CapOptions& caps_;
  Progress* progress_;
  MaterialTag next_tag_ = 1;
  std::set<std::size_t> cells_;  ///< bodies that are cells
  std::set<std::string> names_;  ///< of patches and sheets
  std::vector<SheetSurface> walls_;
  std::map<std::size_t, WalledSurface> joined_;  ///< by surface, until it is added
  /// Partitions that divide a body, and where borders of others end inside one.
  std::set<std::uint32_t> dividing_;
  std::map<std::uint32_t, std::string> ends_;
  std::map<std::uint32_t, std::string> repeated_;  ///< partitions that lie on others, and what is said of it
};

}  // namespace tetwright
