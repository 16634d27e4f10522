// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "common/io/text/text_scanner.h"
#include "common/io/volumes/header_fields.h"
#include "common/io/volumes/voxel_data.h"
#include "tetwright/label_volume.h"

namespace tetwright {

/// Fields of 3D Slicer that describe the segments of a .seg.nrrd: "Segment3_Name:=liver",
/// "Segment3_LabelValue:=4", "Segment3_Color:=0.87 0.51 0.4".
class NrrdSegments {
 public:
  void add(std::string_view key, std::string_view value);
  /// Number of layers; overlapping segments are stored in several layers.
  std::int64_t layers() const { return layers_; }
  /// Gives the names and colours of the segments of a layer.
  void give_names_and_colours(LabelGrid& grid, std::int64_t layer = 0) const;

 private:
  using Colour = std::array<double, 3>;
  static std::optional<Colour> parse_colour(std::string_view value);

  struct Segment {
    std::string name;
    std::optional<Colour> colour;
    std::int64_t label = 0, layer = 0;
    bool has_label = false;
  };
  std::map<std::int64_t, Segment> segments_;
  std::int64_t layers_ = 1;
};

/// Reads the header of an NRRD file, including the empty line after it; a detached header may end without
/// one. \throws InputError with the line of an unknown or malformed field
HeaderFields read_nrrd_header(TextScanner& in, NrrdSegments& segments);

/// Type of the voxels that a header names.
VoxelType nrrd_voxel_type(const HeaderFields& header, VoxelUse use);

}  // namespace tetwright
