// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

namespace tetwright {

/// A file for a ZIP archive.
struct ZipEntry {
  std::string path;
  std::string bytes;
};

/// Bytes of a ZIP archive of these files, neither compressed nor dated: the same files give the same bytes.
/// Uses libzip. Takes the memory of the files a second time.
/// \param name file name for messages
/// \throws OutputError if memory runs out
std::string zip_bytes(std::span<const ZipEntry> files, const std::string& name);

}  // namespace tetwright
