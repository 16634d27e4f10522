// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "tetwright/io.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Maximum length of a text that VtuData::texts() accepts, in bytes.
inline constexpr std::size_t max_vtu_text = 1000;

/// Whether a child of PointData or CellData is a numeric array; other children hold text.
bool holds_numbers(pugi::xml_node array);

/// Data arrays of a VTK XML file in any encoding. Used by vtu.cpp and vtp.cpp.
class VtuData {
 public:
  /// Parses the file. The bytes must outlive this object.
  /// \throws InputError if it is not VTK XML, or is compressed by anything but zlib, LZ4 and LZMA
  VtuData(std::string_view bytes, std::string name);

  const std::string& name() const { return name_; }
  /// The XML element VTKFile.
  pugi::xml_node root() const { return root_; }

  /// Pieces of a grid, "UnstructuredGrid" or "PolyData"; at least one.
  /// \throws InputError if the file holds another grid
  std::vector<pugi::xml_node> pieces(const char* grid) const;
  /// The only piece of a grid.
  /// \throws InputError if there are several
  pugi::xml_node only_piece(const char* grid) const;
  /// Number in an attribute of a piece.
  std::size_t count(pugi::xml_node piece, const char* attribute) const;
  /// Array with this name.
  /// \throws InputError if there is none
  pugi::xml_node array(pugi::xml_node parent, const char* name) const;
  /// The `n` points of a piece.
  /// \throws InputError if the number of points is not `n`, or one is not finite
  std::vector<Vec3> points(pugi::xml_node piece, std::size_t n) const;
  /// \throws InputError unless both sizes are equal
  void expect_size(pugi::xml_node array, std::size_t size, std::size_t expected) const;

  /// Reads the numbers of a DataArray.
  /// \param max_count maximum number of values, known to the caller from the size of the file or from other
  ///   arrays; no more memory is allocated
  /// \throws InputError if there are more, or if a number is not of the requested type
  std::vector<double> numbers(pugi::xml_node array, std::size_t max_count) const;
  std::vector<std::int64_t> integers(pugi::xml_node array, std::size_t max_count) const;
  /// Reads integers from 0 to 2^32 - 1, in half the memory.
  std::vector<std::uint32_t> counts(pugi::xml_node array, std::size_t max_count) const;
  /// Passes the texts of an array of type String to `take`, one by one. In the file each text ends with a
  /// zero byte; ascii arrays have a number for each byte.
  /// \throws InputError unless there are `count` texts of at most max_vtu_text bytes each
  void texts(pugi::xml_node array, std::size_t count,
             const std::function<void(std::string_view text)>& take) const;
  /// Reads the numeric arrays of PointData or CellData, which have a tuple for each of `n` items.
  /// \param chosen items whose values are returned; null: all
  /// \param rounded counts the integers that were rounded; may be null
  /// \throws InputError for an array of another size
  std::vector<MeshField> fields(pugi::xml_node data, std::size_t n,
                                const std::vector<std::size_t>* chosen = nullptr,
                                KindCounts* rounded = nullptr) const;

  /// \throws InputError with the byte offset of `node`
  [[noreturn]] void fail(pugi::xml_node node, const std::string& message) const;
  [[noreturn]] void fail(const std::string& message) const;

 private:
  /// Receives the bytes of an array piece by piece (a block of a compressed one), so that a large array need
  /// not be in memory as a whole.
  struct DecodedBytes {
    std::function<void(std::size_t size)> begin;
    std::function<void(std::string_view bytes)> piece;
    /// Receives the bytes from offset `begin` on, a multiple of `unit`. Called concurrently in any order; the
    /// pieces may follow if blocks turn out to be damaged. Null: only pieces.
    std::function<void(std::size_t begin, std::string_view bytes)> block;
    std::size_t unit;
  };
  /// Sizes of the blocks of a compressed array, in bytes.
  struct Blocks {
    const std::vector<std::uint64_t>& packed_sizes;
    std::uint64_t size_of_each;  ///< uncompressed; the last may be smaller
    std::uint64_t size;          ///< of the whole array
  };
  template <class Value, class Stored>
  Value checked(Stored stored, pugi::xml_node array, std::size_t place) const;
  template <class Value>
  std::vector<Value> values(pugi::xml_node array, std::size_t max_count) const;
  void decode(pugi::xml_node array, std::size_t max_bytes, const DecodedBytes& out) const;
  template <class Source>
  bool decode_blocks(const Source& source, const Blocks& blocks, const DecodedBytes& out) const;
  template <class Source>
  void decode_from(Source source, pugi::xml_node array, std::size_t max_bytes, const DecodedBytes& out) const;

  std::string name_;
  std::size_t file_size_;
  pugi::xml_document document_;
  pugi::xml_node root_;
  std::string_view appended_;  ///< data after the underscore
  bool appended_raw_ = false;
  bool swap_ = false;
  bool wide_header_ = false;  ///< true: sizes are UInt64
  std::string compressor_;    ///< empty: uncompressed
};

}  // namespace tetwright
