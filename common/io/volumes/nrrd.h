// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/io/volumes/data_file.h"
#include "common/io/volumes/encoded_volume.h"
#include "common/io/volumes/raw_volume.h"
#include "tetwright/files.h"
#include "tetwright/label_source.h"

namespace tetwright {

class Progress;

/// Opens an NRRD volume: raw, gzip or text, attached to its header or in a separate file. If there are more
/// than three axes, those of size 1 are dropped, and an image may have an axis of channels, which is not
/// spatial: its kind is none of domain and space, or its direction none. Labels get the names of 3D Slicer's
/// segments (.seg.nrrd); segments in several layers are rejected with advice, see read_nrrd_layers().
///
/// No library is used: libteem, which defines the format, has had no release since 2012, reads through a FILE
/// and allocates as much memory as the header promises.
/// \param read reads the separate file
/// \throws InputError with the line of the header for malformed contents
EncodedVolume open_nrrd(std::string_view bytes, const std::string& name, const FileReader& read,
                        VoxelUse use);

/// Reads the labels of an NRRD volume.
LabelVolume read_nrrd(std::string_view bytes, const std::string& name,
                      const FileReader& read = read_whole_file);

/// Number of layers that the segments of a file are in; more than one if they overlap.
/// \throws InputError for a malformed header
std::int64_t nrrd_layers(const HeaderBytes& head, const std::string& name);

/// Reads all layers of segments, in one axis of kind list. Each has the names and colours of its segments.
std::vector<LabelVolume> read_nrrd_layers(std::string_view bytes, const std::string& name,
                                          const FileReader& read = read_whole_file);

/// RawVolumeFinder of NRRD.
std::optional<RawVolume> find_nrrd(const HeaderBytes& head, const std::string& name,
                                   VoxelUse use = VoxelUse::labels);

/// Content of an NRRD file: attached, gzip, in the smallest integer type that holds all labels. Origin and
/// directions round-trip bit by bit.
std::string write_nrrd(const LabelVolume& volume);

/// Writes an NRRD file slab by slab: attached and raw, so that it can be read by ranges, in the smallest of
/// uint8, uint16 and uint32 that holds `largest`. A slab has 2^24 voxels, or a slice if that has more;
/// threads share it. \param progress receives the fraction that is written; may be null \pre all labels are
/// between 0 and `largest`
void write_raw_nrrd(const LabelSource& source, MaterialTag largest, const ByteSink& sink, Progress* progress);

}  // namespace tetwright
