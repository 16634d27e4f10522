// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>

struct zip;

namespace tetwright {

/// The files in a ZIP archive in memory, by libzip.
class ZipArchive {
 public:
  /// The bytes must outlive this object; `name` is used in messages. Throws InputError if they are no
  /// archive.
  ZipArchive(std::string_view bytes, std::string name);

  /// Paths are compared without the case of ASCII letters.
  bool has(const std::string& path) const;

  /// The content of a file. Throws InputError if it is missing, encrypted or damaged, or so large for what it
  /// takes in the archive that it can only be meant to fill memory.
  std::string read(const std::string& path) const;

 private:
  struct Discard {
    void operator()(zip* archive) const;
  };

  std::string name_;
  std::unique_ptr<zip, Discard> archive_;
};

}  // namespace tetwright
