#include "mesher/distance/vdb_writer.h"

#include <openvdb/io/Stream.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <sstream>

#include "common/error.h"
#include "common/formats/atomic_file.h"
#include "common/parallel/parallel.h"
#include "mesher/distance/level_set_grid.h"

namespace tetwright {

namespace {

/// Where OpenVDB puts a random identifier of 36 characters, after magic, three numbers of 32 bits and a flag.
constexpr std::size_t identifier_start = 21, identifier_length = 36;

DistanceGrid::Ptr make_grid(const GridFrame& frame, double band_cells, const LevelSetSource& source) {
  const auto size = static_cast<float>(frame.cell_size);
  const auto band = static_cast<float>(band_cells);
  // What was cut off may be rounded.
  const float true_below = band * (1 - 1e-5F);
  const auto grid = DistanceGrid::create(size * band);
  std::vector<DistanceLeaf*> leaves(source.leaves.size());
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const auto& [x, y, z] = source.leaves[i];
    leaves[i] = grid->tree().touchLeaf({x, y, z});
  }
  parallel_for(0, leaves.size(), 16, [&](std::size_t begin, std::size_t end) {
    std::array<float, leaf_points> values;
    for (std::size_t i = begin; i < end; ++i) {
      source.distances(source.leaves[i], values);
      for (openvdb::Index k = 0; k < leaf_points; ++k)
        if (std::abs(values[k]) < true_below)
          leaves[i]->setValueOn(k, size * values[k]);
        else
          leaves[i]->setValueOff(k, std::copysign(size * band, values[k]));
    }
  });
  fill_tiles_outside_band(*grid, size * band);
  grid->setName(source.name);
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  // OpenVDB multiplies row vectors from the left: steps along the axes are rows.
  openvdb::math::Mat4d to_world = openvdb::math::Mat4d::identity();
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) {
      to_world(row, column) = frame.cell_size * frame.axes(column, row);
      to_world(3, column) = frame.origin[column];
    }
  const auto transform = openvdb::math::Transform::createLinearTransform(to_world);
  grid->setTransform(transform);
  return grid;
}

/// In place of the random identifier one that depends on the rest of the file alone (FNV-1a).
void settle_identifier(std::string& bytes) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (std::size_t i = 0; i < bytes.size(); ++i)
    if (i < identifier_start || i >= identifier_start + identifier_length)
      hash = (hash ^ static_cast<unsigned char>(bytes[i])) * 0x100000001b3;
  char digits[17] = "0000000000000000";
  std::array<char, 16> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), hash, 16).ptr;
  std::copy_backward(text.data(), end, digits + 16);
  // As random identifiers are written: 8-4-4-4-12 hexadecimal digits.
  std::string identifier = "00000000-0000-0000-0000-000000000000";
  identifier.replace(0, 8, digits, 8);
  identifier.replace(24, 8, digits + 8, 8);
  bytes.replace(identifier_start, identifier_length, identifier);
}

}  // namespace

void write_level_sets(const std::string& file, const GridFrame& frame, double band_cells,
                      std::span<const LevelSetSource> level_sets, OutputFiles* files) {
  initialise_openvdb();
  std::string bytes;
  try {
    openvdb::GridPtrVec grids;
    for (const LevelSetSource& source : level_sets) grids.push_back(make_grid(frame, band_cells, source));
    std::ostringstream stream;
    openvdb::io::Stream(stream).write(grids);
    bytes = std::move(stream).str();
  } catch (const openvdb::ArithmeticError&) {
    throw OutputError(file + ": OpenVDB has no transform for cells this small; scale the input up");
  }
  settle_identifier(bytes);
  if (files)
    files->write(file, bytes);
  else
    write_file_atomically(file, bytes);
}

}  // namespace tetwright
