// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "common/io/encodings/file_ranges.h"

namespace tetwright {

/// A step in which the bytes of a chunk were encoded, as zarr names it.
enum class ChunkCodec { zlib, gzip, zstd, blosc, crc32c };

/// Codec of this name, in lower case; std::nullopt for another name.
std::optional<ChunkCodec> chunk_codec(std::string_view name);

/// CRC-32C (Castagnoli), RFC 3720, appendix B.4.
std::uint32_t crc32c(std::string_view bytes);

/// Maximum number of stored bytes of a chunk that has `size` bytes when decoded. Larger ones are damaged, or
/// stored by a compressor that makes them larger than they are.
std::size_t max_stored_size(std::size_t size);

/// Decodes the bytes of a chunk, the last codec first.
/// \param codecs in the order in which the chunk was encoded
/// \param size bytes of the decoded chunk; no step reserves much more memory
/// \param name file and chunk for messages
/// \throws InputError if the bytes are damaged, or make more or fewer than `size`
ByteBuffer decode_chunk(ByteBuffer stored, std::span<const ChunkCodec> codecs, std::size_t size,
                        const std::string& name);

}  // namespace tetwright
