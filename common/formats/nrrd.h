#pragma once

#include <string>
#include <string_view>

#include "common/formats/atomic_file.h"
#include "common/formats/data_file.h"
#include "common/label_volume.h"

namespace tetwright {

/// NRRD, attached or detached, raw, gzip or text. Of more than three axes those of size 1 are dropped.
/// `read`: how to read a detached body. Throws InputError.
LabelVolume read_nrrd(std::string_view bytes, const std::string& name,
                      const FileReader& read = read_whole_file);

/// Attached, gzip, in the smallest integers that hold the labels; numbers come back bit by bit.
std::string write_nrrd(const LabelVolume& volume);

}  // namespace tetwright
