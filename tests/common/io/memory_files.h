// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>

#include "common/io/encodings/file_ranges.h"

namespace tetwright {

/// A file in memory.
class MemoryRanges final : public ByteRanges {
 public:
  MemoryRanges(std::string name, const std::string& bytes) : name_(std::move(name)), bytes_(bytes) {}
  const std::string& name() const override { return name_; }
  std::uint64_t size() const override { return bytes_.size(); }
  void read(std::uint64_t offset, char* to, std::size_t n) const override {
    check_range(offset, n);
    bytes_.copy(to, n, static_cast<std::size_t>(offset));
  }

 private:
  std::string name_;
  const std::string& bytes_;
};

/// Files in memory by their paths.
using MemoryFiles = std::map<std::string, std::string>;

/// Opener of files in memory, which must outlive it.
inline auto opener_of(const MemoryFiles& files) {
  return [&files](const std::string& path) -> std::unique_ptr<ByteRanges> {
    const auto found = files.find(path);
    if (found == files.end()) return nullptr;
    return std::make_unique<MemoryRanges>(path, found->second);
  };
}

}  // namespace tetwright
