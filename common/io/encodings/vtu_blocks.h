// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace tetwright {

/// Unpacks the blocks of a compressed array of a VTK XML file. Not to be used by several threads at a time.
class BlockUnpacker {
 public:
  virtual ~BlockUnpacker() = default;
  /// False unless the block is sound and fills `to` exactly.
  virtual bool unpack(std::string_view block, std::span<char> to) = 0;
  /// How many bytes one byte may become at most.
  virtual std::uint64_t max_ratio() const = 0;
};

/// For a VTKFile's attribute "compressor"; null for an unknown one. Throws std::bad_alloc.
std::unique_ptr<BlockUnpacker> make_block_unpacker(std::string_view compressor);

}  // namespace tetwright
