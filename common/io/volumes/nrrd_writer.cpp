// SPDX-License-Identifier: Apache-2.0
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <new>

#include "common/io/encodings/byte_order.h"
#include "common/io/volumes/nrrd.h"
#include "common/number_text.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

/// Number of labels converted at a time.
constexpr std::size_t block_labels = std::size_t{1} << 18;

/// Appends a gzip file of one member to `out`; some readers stop after the first member.
class GzipWriter {
 public:
  explicit GzipWriter(std::string& out) : out_(out) {
    // 15: maximum window; 16: gzip format.
    if (deflateInit2(&stream_, Z_DEFAULT_COMPRESSION, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY) != Z_OK)
      throw std::bad_alloc();
  }
  ~GzipWriter() { deflateEnd(&stream_); }
  GzipWriter(const GzipWriter&) = delete;
  GzipWriter& operator=(const GzipWriter&) = delete;

  void add(std::string_view bytes, bool last) {
    std::array<char, 1 << 16> buffer;
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));  // zlib only reads them
    stream_.avail_in = static_cast<uInt>(bytes.size());
    do {
      stream_.next_out = reinterpret_cast<Bytef*>(buffer.data());
      stream_.avail_out = static_cast<uInt>(buffer.size());
      TETWRIGHT_CHECK(deflate(&stream_, last ? Z_FINISH : Z_NO_FLUSH) != Z_STREAM_ERROR);
      out_.append(buffer.data(), buffer.size() - stream_.avail_out);
    } while (stream_.avail_out == 0);
  }

 private:
  std::string& out_;
  z_stream stream_{};
};

template <class Stored>
void append_labels(std::string& out, const std::vector<MaterialTag>& labels) {
  GzipWriter gzip(out);
  std::string block;
  for (std::size_t begin = 0; begin < labels.size(); begin += block_labels) {
    const std::size_t end = std::min(labels.size(), begin + block_labels);
    block.resize((end - begin) * sizeof(Stored));
    for (std::size_t i = begin; i < end; ++i) {
      auto bytes = std::bit_cast<std::array<char, sizeof(Stored)>>(static_cast<Stored>(labels[i]));
      if (!little_endian_machine) std::reverse(bytes.begin(), bytes.end());
      std::copy(bytes.begin(), bytes.end(),
                block.begin() + static_cast<std::ptrdiff_t>((i - begin) * sizeof(Stored)));
    }
    gzip.add(block, end == labels.size());
  }
}

void append_vector(std::string& out, const Vec3& v) {
  for (int k = 0; k < 3; ++k) {
    out += k == 0 ? '(' : ',';
    append_number(out, v[k]);
  }
  out += ')';
}

/// Whether the format has a name for this space.
bool is_nrrd_space(const std::string& space) {
  constexpr std::array<std::string_view, 9> names{"right-anterior-superior",
                                                  "RAS",
                                                  "left-anterior-superior",
                                                  "LAS",
                                                  "left-posterior-superior",
                                                  "LPS",
                                                  "scanner-xyz",
                                                  "3D-right-handed",
                                                  "3D-left-handed"};
  return std::find(names.begin(), names.end(), space) != names.end();
}

}  // namespace

std::string write_nrrd(const LabelVolume& volume) {
  TETWRIGHT_CHECK(!volume.labels.empty());
  const auto [min, max] = std::minmax_element(volume.labels.begin(), volume.labels.end());
  const auto fit = [min = *min, max = *max](std::int64_t low, std::int64_t high) {
    return min >= low && max <= high;
  };
  const char* type = fit(0, 255)          ? "uint8"
                     : fit(-32768, 32767) ? "int16"
                     : fit(0, 65535)      ? "uint16"
                                          : "int32";
  std::string out = std::string("NRRD0004\n# https://teem.sourceforge.net/nrrd/format.html\ntype: ") + type +
                    "\ndimension: 3\n";
  out += is_nrrd_space(volume.space) ? "space: " + volume.space : "space dimension: 3";
  out += "\nsizes:";
  for (const int n : volume.size) {
    out += ' ';
    append_number(out, n);
  }
  out += "\nspace directions:";
  for (int k = 0; k < 3; ++k) {
    out += ' ';
    append_vector(out, volume.directions.col(k));
  }
  out += "\nkinds: domain domain domain\nendian: little\nencoding: gzip\nspace origin: ";
  append_vector(out, volume.origin);
  out += "\n\n";
  if (type[0] == 'i')
    type[3] == '1' ? append_labels<std::int16_t>(out, volume.labels)
                   : append_labels<std::int32_t>(out, volume.labels);
  else
    type[4] == '8' ? append_labels<std::uint8_t>(out, volume.labels)
                   : append_labels<std::uint16_t>(out, volume.labels);
  return out;
}

}  // namespace tetwright
