// SPDX-License-Identifier: Apache-2.0
#include "common/io/encodings/vtu_data.h"

#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <numeric>
#include <type_traits>

#include "common/io/encodings/base64.h"
#include "common/io/encodings/byte_order.h"
#include "common/io/encodings/vtu_blocks.h"
#include "common/io/names/mesh_fields.h"
#include "common/io/text/text_scanner.h"
#include "common/parallel/touched_memory.h"
#include "tetwright/error.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

/// Number of bytes of an uncompressed array that are decoded at a time.
constexpr std::size_t piece_bytes = std::size_t{1} << 20;
constexpr std::size_t point_grain =
    1 << 14;  ///< points for each task of a parallel loop: some nanoseconds each
constexpr std::int64_t max_vtu_components = 1 << 16;

/// Has the interface of Base64Reader, but for bytes that are not encoded.
class RawReader {
 public:
  explicit RawReader(std::string_view bytes) : bytes_(bytes) {}
  std::size_t read(char* to, std::size_t n) {
    n = std::min(n, bytes_.size());
    std::memcpy(to, bytes_.data(), n);
    bytes_.remove_prefix(n);
    return n;
  }
  std::size_t max_left() const { return bytes_.size(); }
  std::string_view rest() const { return bytes_; }

 private:
  std::string_view bytes_;
};

/// Bytes from `begin` on of the rest of a reader.
/// \return false if they are damaged
bool decode_range(const RawReader& source, std::size_t begin, std::span<char> to) {
  const std::string_view bytes = source.rest();
  if (begin > bytes.size() || to.size() > bytes.size() - begin) return false;
  std::copy_n(bytes.data() + begin, to.size(), to.data());
  return true;
}
bool decode_range(const Base64Reader& source, std::size_t begin, std::span<char> to) {
  return decode_base64(source.rest(), begin, to);
}

std::string cut_short() {
  return "the data of an array ends too early or is not base64; the file is truncated";
}

}  // namespace

bool holds_numbers(pugi::xml_node array) {
  const std::string_view type = array.attribute("type").as_string();
  return std::string_view(array.name()) == "DataArray" &&
         (type.starts_with("Int") || type.starts_with("UInt") || type.starts_with("Float"));
}

VtuData::VtuData(std::string_view bytes, std::string name)
    : name_(std::move(name)), file_size_(bytes.size()) {
  if (bytes.empty()) fail("the file is empty");
  // Appended data may be raw bytes, which are not XML: only the text before them is parsed.
  std::string_view xml = bytes;
  bool cut = false;
  if (const std::size_t element = bytes.find("<AppendedData"); element != std::string_view::npos) {
    const std::size_t close = bytes.find('>', element);
    const std::size_t mark = close == std::string_view::npos ? close : bytes.find('_', close);
    if (mark == std::string_view::npos)
      fail("the appended data does not begin with an underscore; the file is truncated");
    xml = bytes.substr(0, element);
    const std::string_view tag = bytes.substr(element, close - element);
    appended_raw_ =
        tag.find("\"raw\"") != std::string_view::npos || tag.find("'raw'") != std::string_view::npos;
    appended_ = bytes.substr(mark + 1);
    cut = true;
  }
  const pugi::xml_parse_result result = document_.load_buffer(
      xml.data(), xml.size(), pugi::parse_minimal | pugi::parse_escapes, pugi::encoding_utf8);
  // Without the appended data its enclosing elements are not closed, which the parser reports at the end.
  if (!result && !(cut && result.status == pugi::status_end_element_mismatch))
    fail("byte " + std::to_string(result.offset) + ": not XML: " + result.description() +
         "; the file is damaged or truncated");
  root_ = document_.child("VTKFile");
  if (!root_) fail("there is no element VTKFile in it; is this a VTK XML file?");
  const std::string_view order = root_.attribute("byte_order").as_string("LittleEndian");
  if (order != "LittleEndian" && order != "BigEndian") fail(root_, "unknown byte order " + in_quotes(order));
  swap_ = (order == "LittleEndian") != little_endian_machine;
  const std::string_view header = root_.attribute("header_type").as_string("UInt32");
  if (header != "UInt32" && header != "UInt64") fail(root_, "unknown header type " + in_quotes(header));
  wide_header_ = header == "UInt64";
  compressor_ = root_.attribute("compressor").as_string();
  if (!compressor_.empty() && !make_block_unpacker(compressor_))
    fail(root_, "compressor " + in_quotes(compressor_) +
                    " is not supported; save it with zlib, LZ4, LZMA or uncompressed");
}

std::vector<pugi::xml_node> VtuData::pieces(const char* grid) const {
  const std::string_view type = root_.attribute("type").as_string();
  const pugi::xml_node node = root_.child(grid);
  if (type == grid && !node)
    fail(root_, "there is no element " + std::string(grid) + " in it; the file is empty or damaged");
  if (type != grid)
    fail(root_, "a file of type " + std::string(grid) + " is needed, this one is " + in_quotes(type));
  std::vector<pugi::xml_node> pieces;
  for (const pugi::xml_node piece : node.children("Piece")) pieces.push_back(piece);
  if (pieces.empty()) fail(node, "there is no Piece in it");
  return pieces;
}

pugi::xml_node VtuData::only_piece(const char* grid) const {
  const std::vector<pugi::xml_node> all = pieces(grid);
  if (all.size() > 1) fail(all[1], "more than one Piece; merge them into one first");
  return all[0];
}

std::size_t VtuData::count(pugi::xml_node piece, const char* attribute) const {
  const std::string_view text = piece.attribute(attribute).as_string();
  std::int64_t n = 0;
  if (!parse_number(text, n) || n < 0)
    fail(piece, std::string(attribute) + " is " + in_quotes(text) + ", not a number");
  return static_cast<std::size_t>(n);
}

pugi::xml_node VtuData::array(pugi::xml_node parent, const char* name) const {
  const pugi::xml_node node = parent.find_child_by_attribute("DataArray", "Name", name);
  if (!node) fail(parent, std::string("there is no DataArray \"") + name + "\" in it");
  return node;
}

std::vector<Vec3> VtuData::points(pugi::xml_node piece, std::size_t n) const {
  if (n >= no_index) fail(piece, "more than " + std::to_string(no_index - 1) + " points; split the mesh");
  const pugi::xml_node node = piece.child("Points").child("DataArray");
  if (!node) fail(piece, "there are no Points in it");
  const std::vector<double> numbers = this->numbers(node, 3 * n);
  expect_size(node, numbers.size(), 3 * n);
  std::vector<Vec3> points;
  reserve_touched(points, n);
  points.resize(n);
  parallel_for(0, n, point_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      points[i] = Vec3(numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]);
  });
  const auto bad = std::find_if(points.begin(), points.end(), [](const Vec3& p) { return !p.allFinite(); });
  if (bad != points.end())
    fail(node, "a coordinate of point " + std::to_string(bad - points.begin()) +
                   " (counted from 0) is not finite; remove or repair it");
  return points;
}

void VtuData::expect_size(pugi::xml_node array, std::size_t size, std::size_t expected) const {
  if (size != expected)
    fail(array, std::to_string(size) + " values, but " + std::to_string(expected) + " were expected");
}

std::vector<MeshField> VtuData::fields(pugi::xml_node data, std::size_t n,
                                       const std::vector<std::size_t>* chosen, KindCounts* rounded) const {
  KindCounts not_asked;
  std::vector<MeshField> fields;
  for (const pugi::xml_node node : data.children("DataArray")) {
    if (!holds_numbers(node)) continue;
    const bool integer = !std::string_view(node.attribute("type").as_string()).starts_with("Float");
    MeshField field;
    field.name = field_name(node.attribute("Name").as_string());
    const std::string_view text = node.attribute("NumberOfComponents").as_string("1");
    std::int64_t components = 0;
    if (!parse_number(text, components) || components < 1 || components > max_vtu_components)
      fail(node, "NumberOfComponents is " + in_quotes(text) + ", not a number from 1 to " +
                     std::to_string(max_vtu_components));
    field.components = static_cast<int>(components);
    const auto per_item = static_cast<std::size_t>(components);
    field.values = numbers(node, per_item * n);
    expect_size(node, field.values.size(), per_item * n);
    if (chosen) {
      for (std::size_t i = 0; i < chosen->size(); ++i)
        for (std::size_t k = 0; k < per_item; ++k)
          field.values[i * per_item + k] = field.values[(*chosen)[i] * per_item + k];
      field.values.resize(chosen->size() * per_item);
    }
    if (integer) take_integers(field, rounded ? *rounded : not_asked);
    fields.push_back(std::move(field));
  }
  return fields;
}

void VtuData::fail(const std::string& message) const { throw InputError(name_ + ": " + message); }

void VtuData::fail(pugi::xml_node node, const std::string& message) const {
  const std::string_view array = node.attribute("Name").as_string();
  fail("byte " + std::to_string(std::max<std::ptrdiff_t>(0, node.offset_debug())) + ": " + node.name() +
       (array.empty() ? "" : " " + in_quotes(array)) + ": " + message);
}

/// Decodes the blocks of a compressed array in parallel.
/// \return false if that is impossible, since the encoding has gaps or something is damaged: decode the array
///   again from its beginning, block by block, which may succeed or finds the first error
template <class Source>
bool VtuData::decode_blocks(const Source& source, const Blocks& blocks, const DecodedBytes& out) const {
  std::vector<std::uint64_t> begins(blocks.packed_sizes.size());
  std::exclusive_scan(blocks.packed_sizes.begin(), blocks.packed_sizes.end(), begins.begin(),
                      std::uint64_t{0});
  struct Worker {
    std::unique_ptr<BlockUnpacker> unpacker;
    std::vector<char> packed, decoded;
  };
  std::vector<Worker> workers(thread_count());
  std::atomic<bool> damaged{false};  // relaxed: it only has to become visible eventually
  const auto decode_block = [&](std::size_t b, unsigned worker) {
    if (damaged.load(std::memory_order_relaxed)) return;
    auto& [unpacker, packed, decoded] = workers[worker];
    if (!unpacker) unpacker = make_block_unpacker(compressor_);
    const std::uint64_t begin = b * blocks.size_of_each;
    packed.resize(static_cast<std::size_t>(blocks.packed_sizes[b]));
    const bool is_last = b + 1 == blocks.packed_sizes.size();
    decoded.resize(static_cast<std::size_t>(is_last ? blocks.size - begin : blocks.size_of_each));
    if (decode_range(source, static_cast<std::size_t>(begins[b]), packed) &&
        unpacker->unpack({packed.data(), packed.size()}, decoded))
      out.block(static_cast<std::size_t>(begin), {decoded.data(), decoded.size()});
    else
      damaged.store(true, std::memory_order_relaxed);
  };
  try {
    parallel_chunks(begins.size(), decode_block);
  } catch (const InputError&) {
    return false;
  }
  return !damaged.load();
}

template <class Source>
void VtuData::decode_from(Source source, pugi::xml_node array, std::size_t max_bytes,
                          const DecodedBytes& out) const {
  const auto read_size = [&] {
    char bytes[8];
    const std::size_t n = wide_header_ ? 8 : 4;
    if (source.read(bytes, n) != n) fail(array, cut_short());
    return wide_header_ ? load<std::uint64_t>(bytes, swap_) : load<std::uint32_t>(bytes, swap_);
  };
  const auto check_size = [&](std::uint64_t size, std::uint64_t available) {
    if (size > available)
      fail(array, "its header gives " + std::to_string(size) + " bytes, but the file holds " +
                      std::to_string(available) + " at most; it is truncated or damaged");
    if (size > max_bytes)
      fail(array, std::to_string(size) + " bytes, but " + std::to_string(max_bytes) + " were expected");
  };
  std::string decoded;
  if (compressor_.empty()) {
    const std::uint64_t size = read_size();
    check_size(size, source.max_left());
    out.begin(static_cast<std::size_t>(size));
    for (std::uint64_t left = size; left > 0; left -= decoded.size()) {
      decoded.resize(static_cast<std::size_t>(std::min<std::uint64_t>(left, piece_bytes)));
      if (source.read(decoded.data(), decoded.size()) != decoded.size()) fail(array, cut_short());
      out.piece(decoded);
    }
    return;
  }
  const std::uint64_t blocks = read_size();
  if (blocks == 0) return;
  const std::uint64_t block_size = read_size(), last = read_size(), left = source.max_left();
  if (blocks > left / 4) fail(array, cut_short());
  std::vector<std::uint64_t> packed_sizes(static_cast<std::size_t>(blocks));
  std::uint64_t packed_total = 0;
  for (std::uint64_t& packed : packed_sizes) {
    packed = read_size();
    if (packed > left) fail(array, cut_short());
    packed_total += packed;
  }
  if (packed_total > left) fail(array, cut_short());
  const std::unique_ptr<BlockUnpacker> unpacker = make_block_unpacker(compressor_);
  // Compare before multiplying, to avoid overflow.
  const std::uint64_t possible = packed_total * unpacker->max_ratio();
  check_size(last, possible);
  // A single block may be smaller than the block size.
  if (blocks > 1 || last == 0) check_size(block_size, possible);
  if (block_size > 0 && blocks - 1 > possible / block_size) check_size(UINT64_MAX, possible);
  const std::uint64_t size = last > 0 ? (blocks - 1) * block_size + last : blocks * block_size;
  check_size(size, possible);
  std::string packed;
  const auto decode_next = [&](Source& from, std::size_t b) {
    if (packed_sizes[b] > from.max_left()) fail(array, cut_short());
    packed.resize(static_cast<std::size_t>(packed_sizes[b]));
    if (from.read(packed.data(), packed.size()) != packed.size()) fail(array, cut_short());
    decoded.resize(static_cast<std::size_t>(b + 1 == blocks && last > 0 ? last : block_size));
    if (!unpacker->unpack(packed, decoded))
      fail(array, "block " + std::to_string(b) + " of its compressed data is damaged");
  };
  // Memory for what the header promises is taken only if it is true of the first block.
  Source beginning = source;
  decode_next(beginning, 0);
  out.begin(static_cast<std::size_t>(size));
  if (out.block && block_size % out.unit == 0 && decode_blocks(source, {packed_sizes, block_size, size}, out))
    return;
  for (std::size_t b = 0; b < blocks; ++b) {
    decode_next(source, b);
    out.piece(decoded);
  }
}

void VtuData::decode(pugi::xml_node array, std::size_t max_bytes, const DecodedBytes& out) const {
  const std::string_view format = array.attribute("format").as_string();
  if (format == "binary") return decode_from(Base64Reader(array.child_value()), array, max_bytes, out);
  if (format != "appended") fail(array, "unknown format " + in_quotes(format));
  const std::string_view text = array.attribute("offset").as_string();
  std::int64_t offset = 0;
  if (!parse_number(text, offset) || offset < 0 || static_cast<std::uint64_t>(offset) > appended_.size())
    fail(array, "its offset " + in_quotes(text) + " is outside the appended data (" +
                    std::to_string(appended_.size()) + " bytes); the file is truncated");
  const std::string_view data = appended_.substr(static_cast<std::size_t>(offset));
  appended_raw_ ? decode_from(RawReader(data), array, max_bytes, out)
                : decode_from(Base64Reader(data), array, max_bytes, out);
}

/// Converts the number at index `place` of an array to the requested type.
template <class Value, class Stored>
Value VtuData::checked(Stored stored, pugi::xml_node array, std::size_t place) const {
  if constexpr (std::is_integral_v<Value> && std::is_floating_point_v<Stored>) {
    if (!(stored == std::floor(stored) && std::fabs(stored) < 0x1p53))
      fail(array, "expected whole numbers, found " + std::to_string(stored));
  } else if constexpr (std::is_integral_v<Value> && std::is_same_v<Stored, std::uint64_t>) {
    if (stored > static_cast<std::uint64_t>(INT64_MAX)) fail(array, "a value beyond 2^63");
  }
  if constexpr (std::is_same_v<Value, std::uint32_t>) {
    // NOLINTNEXTLINE(bugprone-signed-char-misuse): an Int8 is a number here, not a character.
    const auto value = static_cast<std::int64_t>(stored);
    if (value < 0 || value > UINT32_MAX)
      fail(array, "number " + std::to_string(place) + " (counted from 0) is " + std::to_string(value) +
                      "; 0 to 4294967295 are supported");
  }
  // NOLINTNEXTLINE(bugprone-signed-char-misuse): an Int8 is a number here, not a character.
  return static_cast<Value>(stored);
}

template <class Value>
std::vector<Value> VtuData::values(pugi::xml_node array, std::size_t max_count) const {
  std::vector<Value> out;
  if (std::string_view(array.attribute("format").as_string("ascii")) == "ascii") {
    TextScanner in(array.child_value(), name_);
    for (std::string_view word; !(word = in.word()).empty();) {
      if (out.size() == max_count)
        fail(array, "more than the " + std::to_string(max_count) + " values expected");
      std::int64_t whole = 0;
      double number = 0;
      if (std::is_integral_v<Value> && parse_number(word, whole))
        out.push_back(checked<Value>(whole, array, out.size()));
      else if (parse_number(word, number))
        out.push_back(checked<Value>(number, array, out.size()));
      else
        fail(array, "expected a number, found " + in_quotes(word));
    }
    return out;
  }
  const auto convert = [&]<class Stored>(Stored) {
    std::size_t filled = 0;
    std::string rest;  // part of a number that continues in the next piece
    const auto add = [&](const char* stored) {
      out[filled] = checked<Value>(load<Stored>(stored, swap_), array, filled);
      ++filled;
    };
    decode(array, max_count > SIZE_MAX / 8 ? SIZE_MAX : max_count * sizeof(Stored),
           {[&](std::size_t size) {
              if (size % sizeof(Stored) != 0)
                fail(array, "its size is not a multiple of the size of its numbers");
              reserve_touched(out, size / sizeof(Stored));
              out.resize(size / sizeof(Stored));
            },
            [&](std::string_view bytes) {
              while (!rest.empty() && !bytes.empty()) {
                rest += bytes.front();
                bytes.remove_prefix(1);
                if (rest.size() < sizeof(Stored)) continue;
                add(rest.data());
                rest.clear();
              }
              for (; bytes.size() >= sizeof(Stored); bytes.remove_prefix(sizeof(Stored))) add(bytes.data());
              if (rest.empty()) rest = bytes;
            },
            [&](std::size_t begin, std::string_view bytes) {
              for (std::size_t at = 0; at < bytes.size(); at += sizeof(Stored)) {
                const std::size_t i = (begin + at) / sizeof(Stored);
                out[i] = checked<Value>(load<Stored>(bytes.data() + at, swap_), array, i);
              }
            },
            sizeof(Stored)});
  };
  const std::string_view type = array.attribute("type").as_string();
  if (type == "Float64")
    convert(double{});
  else if (type == "Float32")
    convert(float{});
  else if (type == "Int8")
    convert(std::int8_t{});
  else if (type == "UInt8")
    convert(std::uint8_t{});
  else if (type == "Int16")
    convert(std::int16_t{});
  else if (type == "UInt16")
    convert(std::uint16_t{});
  else if (type == "Int32")
    convert(std::int32_t{});
  else if (type == "UInt32")
    convert(std::uint32_t{});
  else if (type == "Int64")
    convert(std::int64_t{});
  else if (type == "UInt64")
    convert(std::uint64_t{});
  else
    fail(array, "unknown type " + in_quotes(type));
  return out;
}

std::vector<double> VtuData::numbers(pugi::xml_node array, std::size_t max_count) const {
  return values<double>(array, max_count);
}

std::vector<std::int64_t> VtuData::integers(pugi::xml_node array, std::size_t max_count) const {
  return values<std::int64_t>(array, max_count);
}

std::vector<std::uint32_t> VtuData::counts(pugi::xml_node array, std::size_t max_count) const {
  return values<std::uint32_t>(array, max_count);
}

void VtuData::texts(pugi::xml_node array, std::size_t count,
                    const std::function<void(std::string_view text)>& take) const {
  std::string text;
  std::size_t taken = 0;
  const auto add = [&](std::string_view bytes) {
    while (!bytes.empty()) {
      const std::size_t size = std::min(bytes.find('\0'), bytes.size());
      if (text.size() + size > max_vtu_text)
        fail(array, "string " + std::to_string(taken) + " (counted from 0) has more than " +
                        std::to_string(max_vtu_text) + " bytes; shorten it");
      text += bytes.substr(0, size);
      if (size == bytes.size()) return;
      if (taken++ == count) fail(array, "more than the " + std::to_string(count) + " strings expected");
      take(text);
      text.clear();
      bytes.remove_prefix(size + 1);
    }
  };
  if (std::string_view(array.attribute("format").as_string("ascii")) == "ascii") {
    TextScanner in(array.child_value(), name_);
    for (std::string_view word; !(word = in.word()).empty();) {
      std::int64_t byte = 0;
      if (!parse_number(word, byte) || byte < INT8_MIN || byte > UINT8_MAX)
        fail(array, "expected a character code, found " + in_quotes(word));
      const char character = static_cast<char>(byte);
      add({&character, 1});
    }
  } else {
    decode(array, count > SIZE_MAX / (max_vtu_text + 1) ? SIZE_MAX : count * (max_vtu_text + 1),
           {[](std::size_t) {}, add, nullptr, 1});
  }
  if (!text.empty()) fail(array, "its last string does not end with a zero; the file is truncated");
  expect_size(array, taken, count);
}

}  // namespace tetwright
