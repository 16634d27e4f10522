// SPDX-License-Identifier: Apache-2.0
#include "tools/bricks/brick_bytes.h"

#include <zstd.h>

#include <cstring>
#include <memory>
#include <type_traits>
#include <vector>

#include "tetwright/error.h"

namespace tetwright {

namespace {

/// The fastest one: a brick takes little time compared with what makes it.
constexpr int compression_level = 1;

/// A job that finds a damaged file at its beginning makes the brick again.
const std::string remedy = "; run the same call again";
const std::string incomplete = "the brick's data is incomplete" + remedy;

/// Adds values to a string of bytes.
class ByteWriter {
 public:
  template <class... Values>
  void operator()(const Values&... values) {
    (add(values), ...);
  }
  std::string bytes;

 private:
  template <class Value>
  void add(const Value& value) {
    static_assert(std::is_trivially_copyable_v<Value>);
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  template <class Value>
  void add(const std::vector<Value>& values) {
    add(values.size());
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value));
  }
  void add(const std::vector<InterfaceTriangle>& triangles) {
    add(triangles.size());
    for (const InterfaceTriangle& t : triangles)
      (*this)(t.ids, t.material, t.other.has_value(), t.other.value_or(0), t.patch);
  }
  void add(const std::map<MaterialPair, InterfaceStatistics>& interfaces) {
    add(interfaces.size());
    for (const auto& [pair, known] : interfaces)
      (*this)(pair.first, pair.second.has_value(), pair.second.value_or(0), known.triangles, known.area);
  }
  void add(const std::map<MaterialTag, MaterialStatistics>& materials) {
    add(materials.size());
    for (const auto& [tag, material] : materials) (*this)(tag, material.tets, material.volume);
  }
};

/// Takes the values in the same order.
class ByteReader {
 public:
  ByteReader(std::string_view bytes, const std::string& name) : left_(bytes), name_(name) {}
  template <class... Values>
  void operator()(Values&... values) {
    (take(values), ...);
  }
  bool at_end() const { return left_.empty(); }

 private:
  void copy(void* to, std::size_t size) {
    if (size > left_.size()) throw InputError(name_, 0, incomplete);
    if (size > 0) std::memcpy(to, left_.data(), size);
    left_.remove_prefix(size);
  }
  std::size_t count(std::size_t bytes_each) {
    std::size_t size = 0;
    copy(&size, sizeof size);
    if (size > left_.size() / bytes_each) throw InputError(name_, 0, incomplete);
    return size;
  }
  template <class Value>
  void take(Value& value) {
    static_assert(std::is_trivially_copyable_v<Value>);
    copy(&value, sizeof value);
  }
  template <class Value>
  void take(std::vector<Value>& values) {
    values.resize(count(sizeof(Value)));
    copy(values.data(), values.size() * sizeof(Value));
  }
  void take(std::vector<InterfaceTriangle>& triangles) {
    triangles.resize(count(sizeof(Triangle)));
    for (InterfaceTriangle& t : triangles) {
      bool two_sided = false;
      MaterialTag other = 0;
      (*this)(t.ids, t.material, two_sided, other, t.patch);
      if (two_sided) t.other = other;
    }
  }
  void take(std::map<MaterialPair, InterfaceStatistics>& interfaces) {
    for (std::size_t n = count(sizeof(MaterialTag)); n > 0; --n) {
      MaterialPair pair;
      bool two_sided = false;
      MaterialTag other = 0;
      (*this)(pair.first, two_sided, other);
      if (two_sided) pair.second = other;
      InterfaceStatistics& known = interfaces[pair];
      (*this)(known.triangles, known.area);
    }
  }
  void take(std::map<MaterialTag, MaterialStatistics>& materials) {
    for (std::size_t n = count(sizeof(MaterialTag)); n > 0; --n) {
      MaterialTag tag = 0;
      (*this)(tag);
      MaterialStatistics& material = materials[tag];
      (*this)(material.tets, material.volume);
    }
  }

  std::string_view left_;
  const std::string& name_;
};

/// Passes all members of a part to a writer or a reader, in a fixed order.
template <class Archive, class Part, class Statistics>
void archive(Archive& members, Part& part, Statistics& dense) {
  members(part.border.brick, part.border.halo, part.kept_surface, part.border.seam.offered,
          part.border.seam.needed);
  members(part.mesh.points, part.mesh.tets, part.mesh.materials, part.mesh.interfaces, part.flags);
  members(part.surface.points, part.surface.interfaces, part.surface_shared, part.cut_faces);
  members(part.leaves, part.lattice_tets, part.isolated_vertices);
  members(dense.tets, dense.points, dense.materials, dense.volume, dense.min_solid_angle,
          dense.mean_solid_angle, dense.below_count, dense.below_percent, dense.min_dihedral,
          dense.max_dihedral, dense.histogram, dense.dihedrals, dense.interfaces);
}

/// Block by block: a damaged size in the frame must not ask for memory.
std::string decompressed(std::string_view bytes, const std::string& name) {
  const std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context(ZSTD_createDCtx(), ZSTD_freeDCtx);
  if (!context) throw OutputError("not enough memory to read a brick");
  std::string all, block(ZSTD_DStreamOutSize(), '\0');
  ZSTD_inBuffer in{bytes.data(), bytes.size(), 0};
  std::size_t left = 1;  // 0 at the end of the frame
  while (left != 0) {
    ZSTD_outBuffer out{block.data(), block.size(), 0};
    const std::size_t before = in.pos;
    left = ZSTD_decompressStream(context.get(), &out, &in);
    if (ZSTD_isError(left))
      throw InputError(name, 0, std::string("the brick is damaged: ") + ZSTD_getErrorName(left) + remedy);
    all.append(block.data(), out.pos);
    if (left != 0 && in.pos == before && out.pos == 0) throw InputError(name, 0, incomplete);
  }
  if (in.pos != in.size) throw InputError(name, 0, "the brick has more data than it should" + remedy);
  return all;
}

}  // namespace

std::string to_bytes(const BrickPart& part) {
  ByteWriter writer;
  archive(writer, part, part.dense);
  const std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context(ZSTD_createCCtx(), ZSTD_freeCCtx);
  if (!context) throw OutputError("not enough memory to compress a brick");
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, compression_level);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, 1);
  std::string bytes(ZSTD_compressBound(writer.bytes.size()), '\0');
  const std::size_t size =
      ZSTD_compress2(context.get(), bytes.data(), bytes.size(), writer.bytes.data(), writer.bytes.size());
  if (ZSTD_isError(size))
    throw OutputError(std::string("a brick cannot be compressed: ") + ZSTD_getErrorName(size));
  bytes.resize(size);
  return bytes;
}

BrickPart brick_part(std::string_view bytes, const std::string& name) {
  const std::string all = decompressed(bytes, name);
  BrickPart part;
  ByteReader reader(all, name);
  archive(reader, part, part.dense);
  if (!reader.at_end()) throw InputError(name, 0, "the brick has more data than it should" + remedy);
  return part;
}

}  // namespace tetwright
