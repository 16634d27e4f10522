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
#include "tetwright/progress.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

/// Number of labels converted at a time.
constexpr std::size_t block_labels = std::size_t{1} << 18;
/// Voxels of a slab: many enough for the blocks of many threads, and 64 MB at most.
constexpr std::int64_t slab_voxels = std::int64_t{1} << 24;

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
void put_label(MaterialTag label, char* to) {
  auto bytes = std::bit_cast<std::array<char, sizeof(Stored)>>(static_cast<Stored>(label));
  if (!little_endian_machine) std::reverse(bytes.begin(), bytes.end());
  std::copy(bytes.begin(), bytes.end(), to);
}

template <class Stored>
void append_labels(std::string& out, const std::vector<MaterialTag>& labels) {
  GzipWriter gzip(out);
  std::string block;
  for (std::size_t begin = 0; begin < labels.size(); begin += block_labels) {
    const std::size_t end = std::min(labels.size(), begin + block_labels);
    block.resize((end - begin) * sizeof(Stored));
    for (std::size_t i = begin; i < end; ++i)
      put_label<Stored>(labels[i], &block[(i - begin) * sizeof(Stored)]);
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

std::string nrrd_header(const LabelGrid& grid, const char* type, const char* encoding) {
  std::string out = std::string("NRRD0004\n# https://teem.sourceforge.net/nrrd/format.html\ntype: ") + type +
                    "\ndimension: 3\n";
  out += is_nrrd_space(grid.space) ? "space: " + grid.space : "space dimension: 3";
  out += "\nsizes:";
  for (const int n : grid.size) {
    out += ' ';
    append_number(out, n);
  }
  out += "\nspace directions:";
  for (int k = 0; k < 3; ++k) {
    out += ' ';
    append_vector(out, grid.directions.col(k));
  }
  out += std::string("\nkinds: domain domain domain\nendian: little\nencoding: ") + encoding +
         "\nspace origin: ";
  append_vector(out, grid.origin);
  out += "\n\n";
  return out;
}

/// Slices that are written at a time: whole blocks of the source, if they fit.
int slices_at_once(const LabelSource& source) {
  const VoxelIndex& size = source.grid().size;
  const int block = source.block()[2];
  const auto fit = static_cast<int>(
      std::clamp<std::int64_t>(slab_voxels / (std::int64_t{size[0]} * size[1]), 1, source.grid().size[2]));
  return fit > block ? fit - fit % block : fit;
}

/// Passes the labels to the sink.
template <class Stored>
void write_slabs(const LabelSource& source, MaterialTag largest, const ByteSink& sink, Progress* progress) {
  const VoxelIndex& size = source.grid().size;
  const int slices = slices_at_once(source);
  const int block_rows = std::min(source.block()[1], size[1]);
  const int blocks = (size[1] + block_rows - 1) / block_rows;
  const std::size_t row_bytes = static_cast<std::size_t>(size[0]) * sizeof(Stored);
  std::string slab;
  // One for each worker: memory that is allocated again and again costs more time than the labels.
  std::vector<std::vector<MaterialTag>> labels_of(thread_count());
  for (int z = 0; z < size[2]; z += slices) {
    const int depth = std::min(slices, size[2] - z);
    slab.resize(static_cast<std::size_t>(depth) * static_cast<std::size_t>(size[1]) * row_bytes);
    parallel_chunks(static_cast<std::size_t>(blocks), [&](std::size_t block, unsigned worker) {
      const int y = static_cast<int>(block) * block_rows;
      const int rows = std::min(block_rows, size[1] - y);
      const std::size_t slice_labels = static_cast<std::size_t>(rows) * static_cast<std::size_t>(size[0]);
      std::vector<MaterialTag>& labels = labels_of[worker];
      labels.resize(static_cast<std::size_t>(depth) * slice_labels);
      source.read({0, y, z}, {size[0], y + rows, z + depth}, labels);
      for (std::size_t k = 0; k < static_cast<std::size_t>(depth); ++k) {
        char* to = &slab[(k * static_cast<std::size_t>(size[1]) + static_cast<std::size_t>(y)) * row_bytes];
        for (std::size_t i = 0; i < slice_labels; ++i, to += sizeof(Stored)) {
          const MaterialTag label = labels[k * slice_labels + i];
          TETWRIGHT_CHECK(0 <= label && label <= largest);
          put_label<Stored>(label, to);
        }
      }
    });
    sink(slab);
    if (progress) progress->update(static_cast<double>(z + depth) / size[2]);
  }
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
  std::string out = nrrd_header(volume, type, "gzip");
  if (type[0] == 'i')
    type[3] == '1' ? append_labels<std::int16_t>(out, volume.labels)
                   : append_labels<std::int32_t>(out, volume.labels);
  else
    type[4] == '8' ? append_labels<std::uint8_t>(out, volume.labels)
                   : append_labels<std::uint16_t>(out, volume.labels);
  return out;
}

void write_raw_nrrd(const LabelSource& source, MaterialTag largest, const ByteSink& sink,
                    Progress* progress) {
  const auto write = [&](const char* type, const auto& slabs) {
    sink(nrrd_header(source.grid(), type, "raw"));
    slabs(source, largest, sink, progress);
  };
  if (largest <= 255)
    write("uint8", write_slabs<std::uint8_t>);
  else if (largest <= 65535)
    write("uint16", write_slabs<std::uint16_t>);
  else
    write("uint32", write_slabs<std::uint32_t>);
}

}  // namespace tetwright
