// SPDX-License-Identifier: Apache-2.0
#include "tools/bricks/brick_bytes.h"

#include <zstd.h>
#include <zstd_errors.h>

#include <memory>

#include "common/files/byte_archive.h"
#include "tetwright/error.h"

namespace tetwright {

// ByteWriter and ByteReader find these only outside the namespace without a name.

template <class Archive, IsType<BrickTask> T>
void archive(Archive& members, T& task) {
  members(task.brick, task.halo, task.keep_surface, task.thin, task.round);
}

/// As a piece of a brick: what coarsen_pieces() uses.
template <class Archive, IsType<BrickPart> T>
void archive(Archive& members, T& piece) {
  members(piece.mesh.points, piece.mesh.tets, piece.mesh.materials, piece.mesh.interfaces, piece.flags);
}

template <class Archive, IsType<BrickPieces> T>
void archive(Archive& members, T& pieces) {
  members(pieces.brick, pieces.shared, pieces.parts);
}

namespace {

/// The fastest one: a brick takes little time compared with what makes it.
constexpr int compression_level = 1;

/// A job that finds a damaged file at its beginning makes the brick again.
const std::string remedy = "; run the same call again";
const std::string incomplete = "the brick's data is incomplete" + remedy;
const std::string too_much = "the brick has more data than it should" + remedy;

/// Passes all members of a part to a writer or a reader, in a fixed order.
template <class Archive, class Part, class Statistics>
void archive_part(Archive& members, Part& part, Statistics& dense) {
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
  const auto fail = [] { throw OutputError("not enough memory to read a brick"); };
  if (!context) fail();
  std::string all, block(ZSTD_DStreamOutSize(), '\0');
  ZSTD_inBuffer in{bytes.data(), bytes.size(), 0};
  std::size_t left = 1;  // 0 at the end of the frame
  while (left != 0) {
    ZSTD_outBuffer out{block.data(), block.size(), 0};
    const std::size_t before = in.pos;
    left = ZSTD_decompressStream(context.get(), &out, &in);
    if (ZSTD_getErrorCode(left) == ZSTD_error_memory_allocation) fail();
    if (ZSTD_isError(left))
      throw InputError(name, 0, std::string("the brick is damaged: ") + ZSTD_getErrorName(left) + remedy);
    all.append(block.data(), out.pos);
    if (left != 0 && in.pos == before && out.pos == 0) throw InputError(name, 0, incomplete);
  }
  if (in.pos != in.size) throw InputError(name, 0, too_much);
  return all;
}

std::string compressed(const std::string& all) {
  const std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context(ZSTD_createCCtx(), ZSTD_freeCCtx);
  if (!context) throw OutputError("not enough memory to compress a brick");
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, compression_level);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, 1);
  std::string bytes(ZSTD_compressBound(all.size()), '\0');
  const std::size_t size = ZSTD_compress2(context.get(), bytes.data(), bytes.size(), all.data(), all.size());
  if (ZSTD_isError(size))
    throw OutputError(std::string("a brick cannot be compressed: ") + ZSTD_getErrorName(size));
  bytes.resize(size);
  bytes.shrink_to_fit();
  return bytes;
}

}  // namespace

std::string to_bytes(const BrickPart& part) {
  ByteWriter writer;
  archive_part(writer, part, part.dense);
  return compressed(writer.bytes);
}

BrickPart brick_part(std::string_view bytes, const std::string& name) {
  const std::string all = decompressed(bytes, name);
  BrickPart part;
  ByteReader reader(all, name, incomplete);
  archive_part(reader, part, part.dense);
  if (!reader.at_end()) throw InputError(name, 0, too_much);
  return part;
}

std::string to_bytes(const BrickRequest& request) {
  ByteWriter writer;
  writer(request.task, request.pieces);
  return compressed(writer.bytes);
}

BrickRequest brick_request(std::string_view bytes, const std::string& name) {
  const std::string all = decompressed(bytes, name);
  BrickRequest request;
  ByteReader reader(all, name, incomplete);
  reader(request.task, request.pieces);
  if (!reader.at_end()) throw InputError(name, 0, too_much);
  return request;
}

}  // namespace tetwright
