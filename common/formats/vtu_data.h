#pragma once

#include <cstdint>
#include <functional>
#include <pugixml.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/formats/atomic_file.h"

namespace tetwright {

/// The data arrays of a VTK XML file: knows how the file encodes them. For vtu.cpp.
class VtuData {
 public:
  /// Parses the file; the bytes must outlive this. Throws InputError if it is not VTK XML, or compressed by
  /// something other than zlib.
  VtuData(std::string_view bytes, std::string name);

  /// The element VTKFile.
  pugi::xml_node root() const { return root_; }

  /// A DataArray's numbers. `most` is the largest number of values that makes sense (from the file's size or
  /// other arrays); more, or a value of the wrong kind, is an InputError.
  std::vector<double> numbers(pugi::xml_node array, std::size_t most) const;
  std::vector<std::int64_t> integers(pugi::xml_node array, std::size_t most) const;

  /// Throws InputError with the byte at which `node` stands.
  [[noreturn]] void fail(pugi::xml_node node, const std::string& message) const;
  [[noreturn]] void fail(const std::string& message) const;

 private:
  template <class Value>
  std::vector<Value> values(pugi::xml_node array, std::size_t most) const;
  std::string decode(pugi::xml_node array, std::size_t most_bytes) const;
  template <class Source>
  std::string decode_from(Source source, pugi::xml_node array, std::size_t most_bytes) const;

  std::string name_;
  std::size_t file_size_;
  pugi::xml_document document_;
  pugi::xml_node root_;
  std::string_view appended_;  ///< what follows the underscore
  bool appended_raw_ = false;
  bool swap_ = false;
  bool wide_header_ = false;  ///< sizes are UInt64
  bool compressed_ = false;
};

/// Compresses with zlib in blocks (in parallel) and encodes as VTK does inline: for format="binary",
/// header_type="UInt32", compressor="vtkZLibDataCompressor".
/// `fill(begin, bytes)` is called concurrently and writes the array's bytes from `begin` on, as many as there
/// is room for; blocks begin at multiples of 2^18. Of the array, `size` bytes long, only what is compressed
/// is in memory as a whole.
void write_vtu_array(std::size_t size, const std::function<void(std::size_t begin, std::span<char>)>& fill,
                     const ByteSink& sink);

}  // namespace tetwright
