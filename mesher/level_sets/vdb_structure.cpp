// SPDX-License-Identifier: Apache-2.0
#include "mesher/level_sets/vdb_structure.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <map>
#include <set>
#include <stdexcept>

namespace tetwright {

namespace {

/// The first eight bytes of every .vdb file.
constexpr std::string_view magic("\x20\x42\x44\x56\0\0\0\0", 8);
constexpr std::uint32_t oldest_format = 222, newest_format = 224;
constexpr std::string_view no_identifier = "00000000-0000-0000-0000-000000000000";
/// Bits of a grid's compression.
constexpr std::uint32_t zipped = 1, mask_compressed = 2, blosc = 4;
/// Binary logarithms of the number of children of a node along each axis, for the levels from below the root
/// to the leaves.
constexpr std::array<int, 3> node_levels{5, 4, 3};
constexpr std::string_view half_suffix = "_HalfFloat", usual_tree = "_5_4_3";

constexpr std::size_t values_of(int level) { return std::size_t{1} << 3 * node_levels[level]; }

[[noreturn]] void damaged() { throw std::runtime_error("is damaged or truncated; write it again"); }

void require(bool condition) {
  if (!condition) damaged();
}

/// Reads sequentially from the start; throws if too few bytes are left.
class Cursor {
 public:
  explicit Cursor(std::string_view bytes) : bytes_(bytes) {}
  std::size_t position() const { return position_; }
  std::string_view since(std::size_t start) const { return bytes_.substr(start, position_ - start); }
  void move_to(std::uint64_t position) {
    require(position >= position_ && position <= bytes_.size());
    position_ = position;
  }
  std::string_view take(std::uint64_t count) {
    require(count <= bytes_.size() - position_);
    position_ += count;
    return bytes_.substr(position_ - count, count);
  }
  template <class T>
  T number() {
    T value;
    std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
    return value;
  }
  std::string_view text() { return take(number<std::uint32_t>()); }

 private:
  std::string_view bytes_;
  std::size_t position_ = 0;
};

/// A mask with one bit for each value of a node.
struct VoxelMask {
  std::string_view bits;
  bool operator[](std::size_t i) const { return static_cast<unsigned char>(bits[i / 8]) >> i % 8 & 1; }
  std::size_t count() const {
    std::size_t sum = 0;
    for (const char byte : bits) sum += std::popcount(static_cast<unsigned char>(byte));
    return sum;
  }
};

/// Walks over the tree of one grid of numbers.
class TreeWalk {
 public:
  /// \param bytes size of a value
  /// \param as_half values of nodes are stored as half floats
  TreeWalk(Cursor& cursor, std::uint32_t compression, std::size_t bytes, bool as_half)
      : cursor_(cursor), compression_(compression), bytes_(bytes), half_(as_half) {}

  void tree() {
    require(cursor_.number<std::int32_t>() == 1);  // buffers
    cursor_.take(bytes_);                          // background
    const auto tiles = cursor_.number<std::uint32_t>(), children = cursor_.number<std::uint32_t>();
    for (std::uint32_t i = 0; i < tiles; ++i) {
      origin();
      cursor_.take(bytes_);                           // value
      require(cursor_.number<unsigned char>() <= 1);  // active
    }
    for (std::uint32_t i = 0; i < children; ++i) {
      origin();
      node(0);
    }
    for (std::size_t i = 0; i < leaves_; ++i) values(2, mask(2).count());
  }

 private:
  /// Reads the origin of a child of the root: none may repeat, be unaligned or make coordinates overflow.
  void origin() {
    constexpr std::int32_t side = 1 << (node_levels[0] + node_levels[1] + node_levels[2]);
    constexpr std::int32_t farthest = 1 << 30;
    std::array<std::int32_t, 3> place;
    for (std::int32_t& c : place) {
      c = cursor_.number<std::int32_t>();
      require(c % side == 0 && c >= -farthest && c < farthest);
    }
    require(origins_.insert(place).second);
  }

  VoxelMask mask(int level) { return {cursor_.take(values_of(level) / 8)}; }

  void node(int level) {
    if (level == 2) {
      mask(level);
      ++leaves_;
      return;
    }
    const VoxelMask children = mask(level), active = mask(level);
    values(level, active.count());
    for (std::size_t i = 0; i < values_of(level); ++i) {
      if (!children[i]) continue;
      require(!active[i]);
      node(level + 1);
    }
  }

  /// Reads the values of a node with `active` active ones.
  void values(int level, std::size_t active) {
    // 0 to 2: only active values; the others are the background, its negative, or one value that is stored.
    // 3 to 5: likewise, but each of the others is one of two values, selected by a mask. 6: all values.
    const auto layout = cursor_.number<std::int8_t>();
    require(layout >= 0 && layout <= 6);
    if (layout == 2 || layout == 4 || layout == 5) cursor_.take(bytes_);
    if (layout == 5) cursor_.take(bytes_);
    if (layout >= 3 && layout <= 5) mask(level);
    const bool only_active = compression_ & mask_compressed && layout != 6;
    data((only_active ? active : values_of(level)) * (half_ ? 2 : bytes_));
  }

  void data(std::size_t size) {
    if (half_ && size == 0) return;
    if (!(compression_ & (blosc | zipped))) {
      cursor_.take(size);
      return;
    }
    const auto written = cursor_.number<std::int64_t>();
    if (written > 0) {
      const std::string_view packed = cursor_.take(static_cast<std::uint64_t>(written));
      if (compression_ & blosc) check_blosc(packed, size);
    } else {  // not worth packing
      require(written == -static_cast<std::int64_t>(size));
      cursor_.take(size);
    }
  }

  /// Validates Blosc's header of 16 bytes: version, version, flags, size of a value, then the sizes unpacked,
  /// of a block, and packed.
  static void check_blosc(std::string_view packed, std::size_t size) {
    Cursor header(packed);
    header.take(4);
    require(header.number<std::uint32_t>() == size);
    const auto block = header.number<std::uint32_t>();
    require(block > 0 && block <= std::max<std::size_t>(size, 1));  // 1 if there are no values
    require(header.number<std::uint32_t>() == packed.size());
  }

  Cursor& cursor_;
  std::uint32_t compression_;
  std::size_t bytes_;
  bool half_;
  std::size_t leaves_ = 0;
  std::set<std::array<std::int32_t, 3>> origins_;
};

using Metadata = std::map<std::string_view, std::string_view>;

Metadata metadata(Cursor& cursor) {
  Metadata entries;
  const auto count = cursor.number<std::uint32_t>();
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::string_view name = cursor.text();
    cursor.text();  // type
    entries[name] = cursor.text();
  }
  return entries;
}

/// Skips a transform: the kind of map, and its numbers.
void transform(Cursor& cursor) {
  static const std::map<std::string_view, int> numbers{
      {"AffineMap", 16},       {"UnitaryMap", 16},        {"TranslationMap", 3},           {"ScaleMap", 15},
      {"UniformScaleMap", 15}, {"ScaleTranslateMap", 18}, {"UniformScaleTranslateMap", 18}};
  const auto kind = numbers.find(cursor.text());
  if (kind == numbers.end())
    throw std::runtime_error("is damaged or has a frustum for a transform; resample it to a box");
  cursor.take(static_cast<std::size_t>(kind->second) * sizeof(double));
}

/// The size in bytes of a value of a supported type; 0 for others.
std::size_t value_bytes(std::string_view type) {
  return type == "float" || type == "int32" ? 4 : type == "double" || type == "int64" ? 8 : 0;
}

template <class T>
void put(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

void put_text(std::string& bytes, std::string_view text) {
  put(bytes, static_cast<std::uint32_t>(text.size()));
  bytes += text;
}

/// A file with a single grid, without offsets.
std::string file_of_one(std::string_view header, std::string_view type, std::uint32_t compression,
                        bool as_half, std::string_view transform_bytes, std::string_view tree_bytes) {
  std::string bytes(header);
  bytes += '\0';  // no offsets
  bytes += no_identifier;
  put(bytes, std::uint32_t{0});  // metadata
  put(bytes, std::int32_t{1});   // grids
  put_text(bytes, "");           // name
  put_text(bytes, type);
  put_text(bytes, "");                           // grid whose tree it shares
  bytes.append(3 * sizeof(std::int64_t), '\0');  // offsets
  put(bytes, compression);
  put(bytes, std::uint32_t{as_half});  // metadata
  if (as_half) {
    put_text(bytes, "is_saved_as_half_float");
    put_text(bytes, "bool");
    put_text(bytes, "\1");
  }
  bytes += transform_bytes;
  bytes += tree_bytes;
  return bytes;
}

}  // namespace

std::vector<VdbGrid> split_vdb(std::string_view bytes) {
  if (!bytes.starts_with(magic)) throw std::runtime_error("is not a .vdb file");
  Cursor cursor(bytes);
  cursor.take(magic.size());
  const auto format = cursor.number<std::uint32_t>();
  if (format < oldest_format || format > newest_format)
    throw std::runtime_error("is damaged or of format " + std::to_string(format) +
                             "; write it again with OpenVDB 3 to 12");
  cursor.take(2 * sizeof(std::uint32_t));  // version of the library
  const std::string_view header = cursor.since(0);
  const bool has_offsets = cursor.number<char>();
  cursor.take(no_identifier.size());
  metadata(cursor);

  std::vector<VdbGrid> grids;
  const auto count = cursor.number<std::int32_t>();
  for (std::int32_t i = 0; i < count; ++i) {
    cursor.text();  // a name that is unique within the file
    const std::string_view full_type = cursor.text();
    const bool as_half = full_type.ends_with(half_suffix);
    const std::string_view type = full_type.substr(0, full_type.size() - (as_half ? half_suffix.size() : 0));
    const bool shares_tree = !cursor.text().empty();
    cursor.take(2 * sizeof(std::int64_t));  // offsets of the grid and its values
    const auto end = cursor.number<std::uint64_t>();

    const auto compression = cursor.number<std::uint32_t>();
    const Metadata about = metadata(cursor);
    const auto entry = [&](std::string_view name, std::string_view otherwise) {
      const auto it = about.find(name);
      return std::string(it == about.end() ? otherwise : it->second);
    };
    VdbGrid& grid = grids.emplace_back();
    grid.name = entry("name", "");
    grid.kind = entry("class", "unknown");
    grid.type = type.substr(std::min(type.size(), type.find('_') + 1));
    grid.type = grid.type.substr(0, grid.type.find('_'));
    const std::size_t bytes_each = value_bytes(grid.type);
    const bool is_float = grid.type == "float", halves = as_half && (is_float || grid.type == "double");
    const bool known =
        bytes_each > 0 && type == "Tree_" + grid.type + std::string(usual_tree) && !shares_tree;
    if (known) {
      Cursor ahead = cursor;
      try {
        const std::size_t transform_start = ahead.position();
        transform(ahead);
        const std::string_view transform_bytes = ahead.since(transform_start);
        const std::size_t tree_start = ahead.position();
        // Integers are never stored as half floats, whatever the file says.
        TreeWalk(ahead, compression, bytes_each, halves).tree();
        grid.alone = file_of_one(header, halves ? full_type : type, compression, halves, transform_bytes,
                                 ahead.since(tree_start));
        cursor = ahead;
        continue;
      } catch (const std::runtime_error& e) {
        // Grids of floats may be level sets that the caller needs, so damage to one is an error. A fault in
        // another grid is recorded and reported only if that grid is read.
        if (is_float || !has_offsets) throw;
        grid.fault = e.what();
      }
    }
    if (!has_offsets)
      throw std::runtime_error("has a grid of another kind, '" + grid.name +
                               "', and no offsets to skip it; write it again with its level sets alone");
    cursor.move_to(end);
  }
  return grids;
}

}  // namespace tetwright
