// SPDX-License-Identifier: Apache-2.0
#include "common/io/encodings/hdf5_file.h"

#include "common/io/encodings/hdf5_image.h"

namespace tetwright {

void write_hdf5_file(const std::string& path, OutputFiles& files,
                     const std::function<void(Hdf5Writer&)>& content, const FileSharing* share) {
  // Standard output is that of this process alone.
  if (share && share->hdf5 && path != "-") {
    share->hdf5(files.reserve(path), path, content);
    return;
  }
  Hdf5Image image;
  content(image);
  const std::string bytes = image.bytes();
  files.write(path, bytes);
}

}  // namespace tetwright
