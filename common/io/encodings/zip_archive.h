// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>

struct zip;

namespace tetwright {

/// Files of a ZIP archive in memory, by libzip.
class ZipArchive {
 public:
  /// \param bytes must outlive this object
  /// \param name used in messages
  /// \throws InputError if the bytes are no archive
  ZipArchive(std::string_view bytes, std::string name);

  /// Whether the archive has a file. The case of ASCII letters is ignored.
  bool has(const std::string& path) const;

  /// Content of a file.
  /// \throws InputError if it is missing, encrypted or damaged, or so large for its compressed size that it
  ///   can only be meant to exhaust memory
  std::string read(const std::string& path) const;

 private:
  struct Discard {
    void operator()(zip* archive) const;
  };

  std::string name_;
  std::unique_ptr<zip, Discard> archive_;
};

}  // namespace tetwright
