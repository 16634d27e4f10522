#pragma once

#include <string>
#include <string_view>

#include "common/formats/atomic_file.h"
#include "common/formats/data_file.h"
#include "common/label_volume.h"

namespace tetwright {

/// MetaImage of ITK, its data behind the header (.mha) or in another file (.mhd), binary, compressed or text.
/// `read`: how to read that file. Throws InputError.
LabelVolume read_metaimage(std::string_view bytes, const std::string& name,
                           const FileReader& read = read_whole_file);

}  // namespace tetwright
