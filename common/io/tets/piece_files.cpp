// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/piece_files.h"

#include <algorithm>
#include <filesystem>
#include <vector>

#include "common/files/byte_archive.h"
#include "common/mesh/piece_bytes.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

/// A piece that another process writes.
struct PieceOrder {
  std::string format;           ///< TetFormat::name
  std::string temporary, path;  ///< OutputFiles::reserve() and its argument
  DividedMesh whole;
  MeshPiece piece;
};

template <class Archive, IsType<PieceOrder> T>
void archive(Archive& members, T& order) {
  members(order.format, order.temporary, order.path, order.whole, order.piece);
}

void write_piece_file(const PieceOrder& order, const Progress* progress) {
  const auto format = std::find_if(tet_formats().begin(), tet_formats().end(), [&](const TetFormat& f) {
    return f.part_files.write_piece && f.name == order.format;
  });
  TETWRIGHT_CHECK(format != tet_formats().end());
  write_reserved_file(
      order.temporary, order.path,
      [&](const ByteSink& sink) { format->part_files.write_piece(order.piece, order.whole, sink); },
      progress);
}

}  // namespace

void write_part_files(const TetFormat& format, const MeshPieces& pieces, const std::string& path,
                      OutputFiles& files, const FileSharing* share) {
  const PartFiles& in_parts = format.part_files;
  if (in_parts.write) {
    in_parts.write(pieces, path, files, share);
    return;
  }
  const DividedMesh& whole = pieces.whole();
  const std::vector<std::string> names = in_parts.names(path, whole.parts);
  if (share && share->pieces) {
    std::vector<std::string> temporary;
    for (PartNumber part = 0; part < whole.parts; ++part) temporary.push_back(files.reserve(names[part]));
    const auto order = [&](std::size_t part) {
      return PieceOrder{format.name, temporary[part], names[part], whole,
                        pieces.piece(static_cast<PartNumber>(part))};
    };
    share->pieces({whole.parts, [&](std::size_t part) { write_piece_file(order(part), files.progress()); },
                   [&](std::size_t part) {
                     ByteWriter writer;
                     writer(order(part));
                     return std::move(writer.bytes);
                   }});
  } else {
    for (PartNumber part = 0; part < whole.parts; ++part) {
      const MeshPiece piece = pieces.piece(part);
      files.write(names[part], [&](const ByteSink& sink) { in_parts.write_piece(piece, whole, sink); });
    }
  }
  const std::string stem = std::filesystem::path(names.back()).stem().string();
  if (in_parts.write_index)
    files.write(names.back(), [&](const ByteSink& sink) { in_parts.write_index(whole, stem, sink); });
}

void write_ordered_piece(std::string_view bytes) {
  PieceOrder order;
  ByteReader reader(bytes, "piece of a mesh", "the message with it is incomplete");
  reader(order);
  write_piece_file(order, nullptr);
}

}  // namespace tetwright
