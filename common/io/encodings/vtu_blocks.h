// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace tetwright {

/// Decompresses the blocks of a compressed array of a VTK XML file. Not for concurrent use.
class BlockUnpacker {
 public:
  virtual ~BlockUnpacker() = default;
  /// Decompresses a block.
  /// \return whether the block is intact and fills `to` exactly
  virtual bool unpack(std::string_view block, std::span<char> to) = 0;
  /// Maximum number of bytes that one compressed byte expands to.
  virtual std::uint64_t max_ratio() const = 0;
};

/// Decompressor for the attribute "compressor" of a VTKFile; null for an unknown one.
/// \throws std::bad_alloc
std::unique_ptr<BlockUnpacker> make_block_unpacker(std::string_view compressor);

}  // namespace tetwright
