// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>

struct zip;

namespace tetwright {

/// Files of a ZIP archive in memory; uses libzip.
class ZipArchive {
 public:
  /// \param bytes must outlive this object
  /// \param name file name for messages
  /// \throws InputError if the bytes are not an archive
  ZipArchive(std::string_view bytes, std::string name);

  /// Whether the archive has a file with this path, ignoring the case of ASCII letters.
  bool has(const std::string& path) const;

  /// Content of a file.
  /// \throws InputError if it is missing, encrypted or damaged, or so large relative to its compressed size
  ///   that it must be meant to exhaust memory
  std::string read(const std::string& path) const;

 private:
  struct Discard {
    void operator()(zip* archive) const;
  };

  std::string name_;
  std::unique_ptr<zip, Discard> archive_;
};

}  // namespace tetwright
