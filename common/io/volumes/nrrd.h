// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "common/files/atomic_file.h"
#include "common/io/volumes/data_file.h"
#include "common/label_volume.h"

namespace tetwright {

/// Reads an NRRD volume: raw, gzip or text, attached to its header or in another file, which `read` reads. Of
/// more than three axes those of size 1 are dropped. Names of segments as 3D Slicer writes them (.seg.nrrd)
/// are those of the labels; segments in several layers are refused with advice. `name` is used in messages.
/// Throws InputError with the line of the header for anything that is malformed.
///
/// Our own: libteem, where the format comes from, has had no release since 2012, reads through a FILE and
/// allocates what the header promises.
LabelVolume read_nrrd(std::string_view bytes, const std::string& name,
                      const FileReader& read = read_whole_file);

/// The content of an NRRD file: attached, gzip, in the smallest integer type that holds all labels. Origin
/// and directions are read back bit by bit.
std::string write_nrrd(const LabelVolume& volume);

}  // namespace tetwright
