// SPDX-License-Identifier: Apache-2.0
#include "common/io/encodings/vtu_arrays.h"

#include <zlib.h>

#include "common/io/encodings/base64.h"
#include "tetwright/error.h"
#include "tetwright/resources.h"

namespace tetwright {

void write_vtu_array(std::size_t size, const std::function<void(std::size_t begin, std::span<char>)>& fill,
                     const ByteSink& sink) {
  constexpr std::size_t block_size = std::size_t{1} << 18;
  // Much faster than zlib's default level of 6; the output is a few percent larger.
  constexpr int level = 4;
  const std::size_t blocks = (size + block_size - 1) / block_size;
  std::vector<std::string> packed(blocks);
  struct Buffers {
    std::vector<char> raw, packed;
  };
  std::vector<Buffers> buffers(thread_count());
  parallel_chunks(blocks, [&](std::size_t b, unsigned worker) {
    auto& [raw, out] = buffers[worker];
    raw.resize(std::min(block_size, size - b * block_size));
    fill(b * block_size, raw);
    uLongf packed_size = compressBound(raw.size());
    out.resize(packed_size);
    TETWRIGHT_CHECK(compress2(reinterpret_cast<Bytef*>(out.data()), &packed_size,
                              reinterpret_cast<const Bytef*>(raw.data()), raw.size(), level) == Z_OK);
    packed[b].assign(out.data(), packed_size);
  });
  std::string header;
  const auto append_size = [&](std::size_t n) {
    auto raw = std::bit_cast<std::array<char, 4>>(static_cast<std::uint32_t>(n));
    if (!little_endian_machine) std::reverse(raw.begin(), raw.end());
    header.append(raw.data(), raw.size());
  };
  append_size(blocks);
  if (blocks > 0) {
    append_size(block_size);
    append_size(size % block_size);  // 0: the last block is full
    for (const std::string& p : packed) append_size(p.size());
  }
  std::string text;
  append_base64(text, header);
  sink(text);
  // The blocks are encoded as one stream, since three bytes that become four characters may lie in two
  // blocks. A group of blocks is encoded in parallel, so that the whole text need not be in memory.
  constexpr std::size_t group = 64;
  std::string data;
  for (std::size_t first = 0; first < blocks; first += group) {
    for (std::size_t b = first; b < std::min(blocks, first + group); ++b) {
      data += packed[b];
      std::string().swap(packed[b]);
    }
    const std::size_t whole = data.size() / 3 * 3;
    sink(base64(std::string_view(data).substr(0, whole)));
    data.erase(0, whole);
  }
  text.clear();
  append_base64(text, data);
  sink(text);
}

}  // namespace tetwright
