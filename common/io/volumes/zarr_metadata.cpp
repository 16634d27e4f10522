// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/zarr_metadata.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/io/encodings/byte_order.h"
#include "common/io/volumes/chunked_source.h"
#include "common/io/volumes/volume_axes.h"
#include "common/lower_case.h"
#include "common/message_text.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

using nlohmann::json;

/// More axes than any array has.
constexpr std::size_t max_zarr_axes = 32;

/// Deeper than any metadata, and few enough levels for functions that call themselves for each.
constexpr int max_zarr_levels = 64;

/// A value for messages.
std::string value_text(const json& value) {
  return value.is_array() ? "[...]" : value.is_object() ? "{...}" : value.dump(-1, ' ', true);
}

/// Reads the members of a JSON object.
class ZarrJson {
 public:
  ZarrJson(const json& object, const std::string& file) : object_(object), file_(file) {
    if (!object_.is_object()) fail("a list or value where an object is needed; the metadata are damaged");
  }

  [[noreturn]] void fail(const std::string& message) const { throw InputError(file_, 0, message); }

  /// The member, or null.
  const json& member(const char* key) const {
    static const json none;
    const auto found = object_.find(key);
    return found == object_.end() ? none : *found;
  }
  std::string text(const char* key) const {
    const json& value = member(key);
    return value.is_string() ? value.get<std::string>() : std::string();
  }
  /// A list of whole numbers of 1 or more, one for each axis.
  std::vector<std::int64_t> sizes(const char* key) const {
    const json& list = member(key);
    if (!list.is_array() || list.size() > max_zarr_axes)
      fail(in_quotes(key) + " is not a list of sizes; the metadata are damaged");
    std::vector<std::int64_t> out;
    for (const json& item : list) {
      if (!item.is_number_integer() || item < 0 || item > std::numeric_limits<std::int64_t>::max())
        fail(in_quotes(key) + " has " + in_quotes(value_text(item)) +
             ", which is not a size; the metadata are damaged");
      out.push_back(item.get<std::int64_t>());
    }
    return out;
  }
  const std::string& file() const { return file_; }

 private:
  const json& object_;
  const std::string& file_;
};

json parsed(std::string_view text, const std::string& file) {
  const auto check_level = [&](int level, json::parse_event_t event, const json& /*parsed*/) {
    if (level >= max_zarr_levels &&
        (event == json::parse_event_t::object_start || event == json::parse_event_t::array_start))
      throw InputError(file, 0,
                       "its lists and objects are nested deeper than " + std::to_string(max_zarr_levels) +
                           " levels; the metadata are damaged");
    return true;
  };
  json value = json::parse(text, check_level, false);
  if (value.is_discarded()) throw InputError(file, 0, "it is not valid JSON; the file is damaged");
  if (!value.is_object()) throw InputError(file, 0, "it is not a JSON object; the file is damaged");
  return value;
}

std::vector<std::size_t> column_major_order(std::size_t axes) {
  std::vector<std::size_t> order = row_major_order(axes);
  std::reverse(order.begin(), order.end());
  return order;
}

/// Sets the label and value of missing chunks.
void take_fill(const json& value, ZarrArray& array) {
  array.fill_text = value_text(value);
  if (value.is_null()) {
    array.fill = 0;  // undefined by the specification
  } else if (value.is_boolean()) {
    array.fill = value.get<bool>() ? 1 : 0;
  } else if (value.is_number()) {
    const auto number = value.get<double>();
    if (number == std::floor(number) && std::fabs(number) <= std::numeric_limits<MaterialTag>::max())
      array.fill = static_cast<MaterialTag>(number);
    if (std::fabs(number) <= static_cast<double>(std::numeric_limits<float>::max()))
      array.fill_value = static_cast<float>(number);
  }
  if (array.fill && !array.fill_value) array.fill_value = static_cast<float>(*array.fill);
}

/// Type of items "<u2" (NumPy's typestr).
VoxelFormat typestr_format(const ZarrJson& array) {
  if (const std::optional<VoxelFormat> format = format_of_typestr(array.text("dtype"))) return *format;
  array.fail("items of type " + in_quotes(value_text(array.member("dtype"))) +
             " are not supported; store the labels as integers");
}

/// Type of items "uint16".
VoxelType named_type(const ZarrJson& array) {
  const std::string type = array.text("data_type");
  if (type == "bool") return VoxelType::uint8;
  if (const std::optional<VoxelType> known = voxel_type_called(type)) return *known;
  array.fail("items of type " + in_quotes(value_text(array.member("data_type"))) +
             " are not supported; store the labels as integers");
}

void check_shape(const ZarrJson& metadata, const ZarrArray& array) {
  const std::size_t axes = array.shape.size();
  const std::vector<std::int64_t>& outer = array.shard.empty() ? array.chunk.size : array.shard;
  if (outer.size() != axes || array.chunk.size.size() != axes)
    metadata.fail("its chunks have " + std::to_string(outer.size()) + " axes, and the array has " +
                  std::to_string(axes) + "; the metadata are damaged");
  (void)checked_chunk_bytes(array.chunk.size, voxel_bytes(array.format.type), metadata.file());
}

[[noreturn]] void fail_codec(const ZarrJson& metadata, const std::string& name) {
  metadata.fail("the codec " + in_quotes(name) +
                " is not supported; store the array with blosc, zstd, gzip or without compression");
}

/// Reads the list of codecs of zarr 3.
class CodecReader {
 public:
  CodecReader(const ZarrJson& metadata, ZarrArray& array) : metadata_(metadata), array_(array) {}

  /// Reads the codecs of a chunk, or of a shard and the chunks in it.
  void read(const json& codecs, ZarrChunk& chunk, bool in_shard) {
    chunk.order = row_major_order(chunk.size.size());
    bool bytes = false;  // whether the items have become bytes
    for (const json& item : list(codecs)) {
      const ZarrJson codec(item, metadata_.file());
      const std::string name = codec.text("name");
      const json& options = codec.member("configuration");
      if (name == "sharding_indexed") {
        if (bytes || in_shard || chunk.order != row_major_order(chunk.size.size()))
          metadata_.fail(
              "the codec \"sharding_indexed\" after others is not supported; store the array again");
        read_shard(ZarrJson(options, metadata_.file()), chunk);
        if (codecs.size() > 1)
          metadata_.fail("codecs beside \"sharding_indexed\" are not supported; store the array again");
        return;
      }
      if (!bytes && name == "transpose") {
        transpose(ZarrJson(options, metadata_.file()).member("order"), chunk.order);
      } else if (!bytes && name == "bytes") {
        bytes = true;
        array_.format.swap = is_swapped(options) && voxel_bytes(array_.format.type) > 1;
      } else {
        chunk.codecs.push_back(byte_codec(name, bytes));
      }
    }
    if (!bytes) metadata_.fail("its codecs lack \"bytes\"; the metadata are damaged");
  }

 private:
  const json& list(const json& codecs) const {
    if (!codecs.is_array()) metadata_.fail("its codecs are not a list; the metadata are damaged");
    return codecs;
  }

  ChunkCodec byte_codec(const std::string& name, bool bytes) const {
    const std::optional<ChunkCodec> codec = chunk_codec(name);
    if (!codec || *codec == ChunkCodec::zlib) fail_codec(metadata_, name);
    if (!bytes)
      metadata_.fail("the codec " + in_quotes(name) + " is before \"bytes\"; the metadata are damaged");
    return *codec;
  }

  bool is_swapped(const json& options) const {
    if (options.is_null()) return false;  // items of one byte
    const std::string endian = ZarrJson(options, metadata_.file()).text("endian");
    if (endian != "little" && endian != "big" && !endian.empty())
      metadata_.fail("the byte order " + in_quotes(endian) + " is neither little nor big");
    return (endian != "big") != little_endian_machine;
  }

  void transpose(const json& wanted, std::vector<std::size_t>& order) const {
    if (wanted == "C") return;
    if (wanted == "F") {
      std::reverse(order.begin(), order.end());
      return;
    }
    std::vector<std::size_t> turned;
    for (const json& item : list(wanted)) {
      if (!item.is_number_integer() || item < 0 || item >= order.size() || turned.size() >= order.size())
        break;
      turned.push_back(order[item.get<std::size_t>()]);
    }
    std::vector<std::size_t> sorted = turned;
    std::sort(sorted.begin(), sorted.end());
    if (sorted != row_major_order(order.size()))
      metadata_.fail("the order of the codec \"transpose\" is not one of the axes; the metadata are damaged");
    order = std::move(turned);
  }

  void read_shard(const ZarrJson& options, ZarrChunk& chunk) {
    array_.shard = std::exchange(chunk.size, options.sizes("chunk_shape"));
    const std::string location = options.text("index_location");
    if (location != "" && location != "end" && location != "start")
      metadata_.fail("the location " + in_quotes(location) + " of the index of shards is unknown");
    array_.index_at_end = location != "start";
    bool bytes = false;
    for (const json& item : list(options.member("index_codecs"))) {
      const ZarrJson codec(item, metadata_.file());
      const std::string name = codec.text("name");
      if (!bytes && name == "bytes") {
        bytes = true;
        array_.index_swap = is_swapped(codec.member("configuration"));
      } else if (bytes && name == "crc32c") {
        array_.index_codecs.push_back(ChunkCodec::crc32c);
      } else {
        metadata_.fail("the codec " + in_quotes(name) + " of the index of shards is not supported");
      }
    }
    if (!bytes) metadata_.fail("the codecs of the index of shards lack \"bytes\"; the metadata are damaged");
    if (array_.shard.size() != chunk.size.size())
      metadata_.fail("the chunks of its shards have " + std::to_string(chunk.size.size()) +
                     " axes, and the shards " + std::to_string(array_.shard.size()));
    for (std::size_t k = 0; k < chunk.size.size(); ++k)
      if (chunk.size[k] < 1 || array_.shard[k] < 1 || array_.shard[k] % chunk.size[k] != 0)
        metadata_.fail("chunks of " + std::to_string(chunk.size[k]) + " do not divide its shards of " +
                       std::to_string(array_.shard[k]) + " items; the metadata are damaged");
    read(options.member("codecs"), chunk, true);
  }

  const ZarrJson& metadata_;
  ZarrArray& array_;
};

std::vector<double> numbers_of(const json& list, const std::string& kind, const std::string& file) {
  std::vector<double> out;
  if (list.is_array() && list.size() <= max_zarr_axes)
    for (const json& item : list)
      if (item.is_number()) out.push_back(item.get<double>());
  if (out.empty() || out.size() != list.size())
    throw InputError(file, 0, "a " + kind + " of a multiscales image is not a list of numbers");
  return out;
}

/// Applies transformations "scale" and "translation" after those of the dataset.
void transform(const json& steps, ZarrDataset& dataset, const std::string& file) {
  if (!steps.is_array()) return;
  for (const json& item : steps) {
    const ZarrJson step(item, file);
    const std::string type = step.text("type");
    if (type == "identity") continue;
    if (type != "scale" && type != "translation")
      throw InputError(file, 0,
                       "the transformation " + in_quotes(type) +
                           " of a multiscales image is not supported; store it with scale and translation");
    const std::vector<double> values = numbers_of(step.member(type.c_str()), type, file);
    for (std::vector<double>* of : {&dataset.scale, &dataset.translation})
      if (of->empty()) of->assign(values.size(), of == &dataset.scale ? 1 : 0);
    if (dataset.scale.size() != values.size() || dataset.translation.size() != values.size())
      throw InputError(file, 0, "transformations of a multiscales image have different numbers of axes");
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (type == "scale") {
        dataset.scale[k] *= values[k];
        dataset.translation[k] *= values[k];
      } else {
        dataset.translation[k] += values[k];
      }
    }
  }
}

void take_axes(const json& axes, ZarrImage& image, const std::string& file) {
  if (!axes.is_array() || axes.size() > max_zarr_axes) return;
  std::string unit, axis_of_unit;
  for (const json& item : axes) {
    if (item.is_string()) {  // OME-Zarr 0.3
      image.axis_names.push_back(lower_case(item.get<std::string>()));
      continue;
    }
    const ZarrJson axis(item, file);
    image.axis_names.push_back(lower_case(axis.text("name")));
    if (axis.text("type") != "space") continue;
    const std::string its = axis.text("unit");
    if (!axis_of_unit.empty() && its != unit)
      throw InputError(file, 0,
                       "its axes " + in_quotes(axis_of_unit) + " and " + in_quotes(axis.text("name")) +
                           " have different units, " + in_quotes(unit) + " and " + in_quotes(its) +
                           "; store their scales in one unit");
    unit = its;
    axis_of_unit = axis.text("name");
  }
}

}  // namespace

ZarrArray parse_zarr2_array(std::string_view text, const std::string& file) {
  const json value = parsed(text, file);
  const ZarrJson metadata(value, file);
  if (metadata.member("zarr_format") != 2)
    metadata.fail("its zarr_format is " + in_quotes(value_text(metadata.member("zarr_format"))) + ", not 2");
  ZarrArray array;
  array.shape = metadata.sizes("shape");
  array.chunk.size = metadata.sizes("chunks");
  array.format = typestr_format(metadata);
  check_shape(metadata, array);
  const std::string order = metadata.text("order");
  if (order != "C" && order != "F") metadata.fail("the order " + in_quotes(order) + " is neither C nor F");
  array.chunk.order =
      order == "C" ? row_major_order(array.shape.size()) : column_major_order(array.shape.size());
  take_fill(metadata.member("fill_value"), array);
  const json& filters = metadata.member("filters");
  if (!filters.is_null() && !filters.empty())
    metadata.fail("its filters are not supported; store the array without filters");
  if (const json& compressor = metadata.member("compressor"); !compressor.is_null()) {
    const std::string name = ZarrJson(compressor, file).text("id");
    const std::optional<ChunkCodec> codec = chunk_codec(name);
    if (!codec || *codec == ChunkCodec::crc32c)
      metadata.fail("the compressor " + in_quotes(name) +
                    " is not supported; store the array with blosc, zstd, gzip, zlib or without compression");
    array.chunk.codecs.push_back(*codec);
  }
  const std::string separator = metadata.text("dimension_separator");
  if (separator != "" && separator != "." && separator != "/")
    metadata.fail("the separator " + in_quotes(separator) + " is neither \".\" nor \"/\"");
  if (!separator.empty()) array.separator = separator[0];
  return array;
}

std::optional<ZarrArray> parse_zarr3_array(std::string_view text, const std::string& file) {
  const json value = parsed(text, file);
  const ZarrJson metadata(value, file);
  if (metadata.member("zarr_format") != 3)
    metadata.fail("its zarr_format is " + in_quotes(value_text(metadata.member("zarr_format"))) + ", not 3");
  const std::string node = metadata.text("node_type");
  if (node == "group") return std::nullopt;
  if (node != "array") metadata.fail("its node_type is " + in_quotes(node) + ", neither array nor group");
  ZarrArray array;
  array.shape = metadata.sizes("shape");
  array.format.type = named_type(metadata);
  const ZarrJson grid(metadata.member("chunk_grid"), file);
  if (grid.text("name") != "regular")
    metadata.fail("chunks in a grid of kind " + in_quotes(grid.text("name")) +
                  " are not supported; store the array in a regular grid");
  array.chunk.size = ZarrJson(grid.member("configuration"), file).sizes("chunk_shape");
  CodecReader(metadata, array).read(metadata.member("codecs"), array.chunk, false);
  check_shape(metadata, array);
  const ZarrJson keys(metadata.member("chunk_key_encoding"), file);
  const bool second = keys.text("name") == "v2";
  if (!second && keys.text("name") != "default")
    metadata.fail("keys of chunks of kind " + in_quotes(keys.text("name")) + " are not supported");
  const json& options = keys.member("configuration");
  const std::string separator = options.is_null() ? "" : ZarrJson(options, file).text("separator");
  if (separator != "" && separator != "." && separator != "/")
    metadata.fail("the separator " + in_quotes(separator) + " is neither \".\" nor \"/\"");
  array.separator = !separator.empty() ? separator[0] : second ? '.' : '/';
  if (!second) array.key_prefix = std::string("c") + array.separator;
  take_fill(metadata.member("fill_value"), array);
  if (const json& names = metadata.member("dimension_names"); names.is_array())
    for (const json& name : names)
      array.axis_names.push_back(name.is_string() ? lower_case(name.get<std::string>()) : std::string());
  if (const json& steps = metadata.member("storage_transformers"); !steps.is_null() && !steps.empty())
    metadata.fail("storage transformers are not supported; store the array without them");
  return array;
}

std::optional<ZarrImage> parse_zarr_image(std::string_view text, const std::string& file) {
  const json value = parsed(text, file);
  const json* attributes = &value;
  for (const char* inner : {"attributes", "ome"})
    if (const auto found = attributes->find(inner); found != attributes->end() && found->is_object())
      attributes = &*found;
  const json& images = ZarrJson(*attributes, file).member("multiscales");
  if (!images.is_array() || images.empty()) return std::nullopt;
  const ZarrJson first(images[0], file);
  ZarrImage image;
  take_axes(first.member("axes"), image, file);
  const json& datasets = first.member("datasets");
  if (!datasets.is_array() || datasets.empty())
    throw InputError(file, 0, "its multiscales image has no datasets; the metadata are damaged");
  for (const json& item : datasets) {
    const ZarrJson of(item, file);
    ZarrDataset dataset{of.text("path"), {}, {}};
    if (dataset.path.empty() || dataset.path.starts_with('/') || dataset.path.find("..") != std::string::npos)
      throw InputError(file, 0, in_quotes(dataset.path) + " is not the path of a dataset in the group");
    transform(of.member("coordinateTransformations"), dataset, file);
    transform(first.member("coordinateTransformations"), dataset, file);
    image.datasets.push_back(std::move(dataset));
  }
  return image;
}

}  // namespace tetwright
