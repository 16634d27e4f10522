// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/zarr.h"

#include <blosc.h>
#include <zstd.h>

#include <functional>

#include "common/io/encodings/chunk_codecs.h"
#include "tests/common/io/volume_boxes.h"

namespace tetwright::zarr_test {
namespace {

constexpr std::size_t cache_bytes = 1 << 12;

/// How an array is stored. Sizes and orders are those of the file: z, y, x.
struct Stored {
  std::array<int, 3> chunk{4, 5, 6};
  bool column_major = false;
  bool big = false;
  std::string separator = ".", prefix = {};
  std::function<std::string(const std::string&)> encode = [](const std::string& bytes) { return bytes; };
};

/// Items of a chunk, those outside of the volume 77.
template <class Number>
std::string chunk_bytes(const LabelVolume& volume, const Stored& stored, const std::array<int, 3>& at,
                        const std::array<int, 3>& chunk) {
  std::vector<Number> numbers;
  const auto item = [&](int z, int y, int x) {
    const int k = at[0] * chunk[0] + z, j = at[1] * chunk[1] + y, i = at[2] * chunk[2] + x;
    const bool inside = k < volume.size[2] && j < volume.size[1] && i < volume.size[0];
    numbers.push_back(static_cast<Number>(
        inside ? volume.labels[static_cast<std::size_t>((k * volume.size[1] + j) * volume.size[0] + i)]
               : 77));
  };
  if (stored.column_major) {
    for (int x = 0; x < chunk[2]; ++x)
      for (int y = 0; y < chunk[1]; ++y)
        for (int z = 0; z < chunk[0]; ++z) item(z, y, x);
  } else {
    for (int z = 0; z < chunk[0]; ++z)
      for (int y = 0; y < chunk[1]; ++y)
        for (int x = 0; x < chunk[2]; ++x) item(z, y, x);
  }
  return bytes_of(numbers, stored.big);
}

std::array<int, 3> chunks_of(const LabelVolume& volume, const std::array<int, 3>& chunk) {
  return {(volume.size[2] - 1) / chunk[0] + 1, (volume.size[1] - 1) / chunk[1] + 1,
          (volume.size[0] - 1) / chunk[2] + 1};
}

template <class Call>
void for_each_chunk(const std::array<int, 3>& n, const Call& call) {
  for (int z = 0; z < n[0]; ++z)
    for (int y = 0; y < n[1]; ++y)
      for (int x = 0; x < n[2]; ++x) call(std::array<int, 3>{z, y, x});
}

template <class Number>
MemoryFiles files_of(const LabelVolume& volume, const Stored& stored) {
  MemoryFiles files;
  for_each_chunk(chunks_of(volume, stored.chunk), [&](const std::array<int, 3>& at) {
    const std::string key = stored.prefix + std::to_string(at[0]) + stored.separator + std::to_string(at[1]) +
                            stored.separator + std::to_string(at[2]);
    files["a/" + key] = stored.encode(chunk_bytes<Number>(volume, stored, at, stored.chunk));
  });
  return files;
}

std::string second(const std::string& dtype, const std::string& rest = R"("compressor":null)") {
  return R"({"zarr_format":2,"shape":[11,13,19],"chunks":[4,5,6],"dtype":")" + dtype +
         R"(","order":"C","fill_value":0,"filters":null,)" + rest + "}";
}

std::string third(const std::string& type, const std::string& codecs, const std::string& rest = "",
                  const std::string& chunk = "[4,5,6]") {
  return R"({"zarr_format":3,"node_type":"array","shape":[11,13,19],"data_type":")" + type +
         R"(","chunk_grid":{"name":"regular","configuration":{"chunk_shape":)" + chunk +
         R"(}},"chunk_key_encoding":{"name":"default"},"fill_value":0,"codecs":)" + codecs + rest + "}";
}

const std::string little_bytes = R"({"name":"bytes","configuration":{"endian":"little"}})";

LabelVolume volume() { return numbered_volume({19, 13, 11}); }

std::unique_ptr<LabelSource> open(const MemoryFiles& files, const std::string& path = "a") {
  return open_zarr(path, cache_bytes, opener_of(files));
}

std::string zstd_of(const std::string& bytes) {
  std::string out(ZSTD_compressBound(bytes.size()), '\0');
  out.resize(ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 3));
  return out;
}

std::string blosc_of(const std::string& bytes) {
  std::string out(bytes.size() + BLOSC_MAX_OVERHEAD, '\0');
  out.resize(static_cast<std::size_t>(blosc_compress_ctx(5, BLOSC_SHUFFLE, 2, bytes.size(), bytes.data(),
                                                         out.data(), out.size(), "lz4", 0, 1)));
  return out;
}

std::string with_crc(const std::string& bytes) {
  std::string out = bytes;
  append_bytes(out, crc32c(bytes));
  return out;
}

template <class Number>
void expect_type(const std::string& dtype, const std::string& type, bool big) {
  Stored stored{.big = big};
  MemoryFiles files = files_of<Number>(volume(), stored);
  files["a/.zarray"] = second(dtype);
  expect_labels(*open(files), volume());
  stored.prefix = "c/";
  stored.separator = "/";
  files = files_of<Number>(volume(), stored);
  files["a/zarr.json"] = third(type, std::string(R"([{"name":"bytes","configuration":{"endian":")") +
                                         (big ? "big" : "little") + "\"}}]");
  expect_labels(*open(files), volume());
}

TEST(Zarr, AllTypesInBothByteOrders) {
  for (const bool big : {false, true}) {
    const std::string order = big ? ">" : "<";
    expect_type<std::int8_t>("|i1", "int8", big);
    expect_type<std::uint8_t>("|u1", "uint8", big);
    expect_type<std::int16_t>(order + "i2", "int16", big);
    expect_type<std::uint16_t>(order + "u2", "uint16", big);
    expect_type<std::int32_t>(order + "i4", "int32", big);
    expect_type<std::uint32_t>(order + "u4", "uint32", big);
    expect_type<std::int64_t>(order + "i8", "int64", big);
    expect_type<std::uint64_t>(order + "u8", "uint64", big);
    expect_type<float>(order + "f4", "float32", big);
    expect_type<double>(order + "f8", "float64", big);
  }
}

TEST(Zarr, CompressorsOrdersAndSeparatorsOfVersion2) {
  Stored stored;
  const auto check = [&](const std::string& rest) {
    MemoryFiles files = files_of<std::uint16_t>(volume(), stored);
    files["a/.zarray"] = second("<u2", rest);
    expect_labels(*open(files), volume());
  };
  stored.encode = [](const std::string& bytes) { return deflated(bytes, 15); };
  check(R"("compressor":{"id":"zlib","level":1})");
  stored.encode = [](const std::string& bytes) { return deflated(bytes, 31); };
  check(R"("compressor":{"id":"gzip","level":5})");
  stored.encode = zstd_of;
  check(R"("compressor":{"id":"zstd","level":3},"dimension_separator":".")");
  stored.encode = blosc_of;
  stored.separator = "/";
  check(R"("compressor":{"id":"blosc","cname":"lz4"},"dimension_separator":"/")");
  stored.column_major = true;
  MemoryFiles files = files_of<std::uint16_t>(volume(), stored);
  files["a/.zarray"] = replaced(second("<u2", R"("compressor":{"id":"blosc"},"dimension_separator":"/")"),
                                R"("order":"C")", R"("order":"F")");
  expect_labels(*open(files), volume());
}

TEST(Zarr, CodecsOfVersion3) {
  Stored stored{.separator = "/", .prefix = "c/"};
  const auto check = [&](const std::string& codecs) {
    MemoryFiles files = files_of<std::uint16_t>(volume(), stored);
    files["a/zarr.json"] = third("uint16", codecs);
    expect_labels(*open(files), volume());
  };
  stored.encode = blosc_of;
  check("[" + little_bytes + R"(,{"name":"blosc","configuration":{"cname":"lz4"}}])");
  stored.encode = [](const std::string& bytes) { return with_crc(zstd_of(bytes)); };
  check("[" + little_bytes + R"(,{"name":"zstd","configuration":{"level":3}},{"name":"crc32c"}])");
  stored.encode = [](const std::string& bytes) { return deflated(bytes, 31); };
  check("[" + little_bytes + R"(,{"name":"gzip","configuration":{"level":3}}])");
  stored.encode = [](const std::string& bytes) { return bytes; };
  stored.column_major = true;
  check(R"([{"name":"transpose","configuration":{"order":[2,1,0]}},)" + little_bytes + "]");
  check(
      R"([{"name":"transpose","configuration":{"order":[1,2,0]}},{"name":"transpose","configuration":{"order":[1,0,2]}},)" +
      little_bytes + "]");
}

TEST(Zarr, ThreadsDecodeAChunkAtATime) {
  EXPECT_EQ(open({{"a/.zarray", second("<u2")}})->decoding_bytes(), 4u * 5 * 6 * 2);
}

TEST(Zarr, KeysOfVersion2InVersion3) {
  MemoryFiles files = files_of<std::uint8_t>(volume(), {});
  files["a/zarr.json"] =
      replaced(third("uint8", R"([{"name":"bytes"}])"), R"({"name":"default"})", R"({"name":"v2"})");
  expect_labels(*open(files), volume());
}

/// Shards of 8 x 10 x 12 items with chunks of 4 x 5 x 6. Every fifth chunk is missing, with zeros in
/// `volume`.
MemoryFiles sharded(LabelVolume& volume, bool at_end) {
  const std::array<int, 3> chunk{4, 5, 6}, shard{8, 10, 12};
  MemoryFiles files;
  int count = 0;
  for_each_chunk(chunks_of(volume, shard), [&](const std::array<int, 3>& at) {
    std::string index, body;
    const std::size_t index_bytes = 8 * 16 + 4;
    for_each_chunk({2, 2, 2}, [&](const std::array<int, 3>& inner) {
      const std::array<int, 3> number{2 * at[0] + inner[0], 2 * at[1] + inner[1], 2 * at[2] + inner[2]};
      if (++count % 5 == 0) {
        append_bytes(index, ~std::uint64_t{0});
        append_bytes(index, ~std::uint64_t{0});
        for_each_chunk(chunk, [&](const std::array<int, 3>& in) {
          const int z = number[0] * 4 + in[0], y = number[1] * 5 + in[1], x = number[2] * 6 + in[2];
          if (z < volume.size[2] && y < volume.size[1] && x < volume.size[0])
            volume.labels[static_cast<std::size_t>((z * volume.size[1] + y) * volume.size[0] + x)] = 0;
        });
        return;
      }
      const std::string stored = zstd_of(chunk_bytes<std::uint16_t>(volume, {}, number, chunk));
      append_bytes(index, static_cast<std::uint64_t>(body.size() + (at_end ? 0 : index_bytes)));
      append_bytes(index, static_cast<std::uint64_t>(stored.size()));
      body += stored;
    });
    files["a/c/" + std::to_string(at[0]) + "/" + std::to_string(at[1]) + "/" + std::to_string(at[2])] =
        at_end ? body + with_crc(index) : with_crc(index) + body;
  });
  files["a/zarr.json"] =
      third("uint16",
            R"([{"name":"sharding_indexed","configuration":{"chunk_shape":[4,5,6],"codecs":[)" +
                little_bytes + R"(,{"name":"zstd"}],"index_codecs":[)" + little_bytes +
                R"(,{"name":"crc32c"}],"index_location":")" + (at_end ? "end" : "start") + R"("}}])",
            "", "[8,10,12]");
  return files;
}

TEST(Zarr, ShardsOfChunks) {
  for (const bool at_end : {true, false}) {
    LabelVolume expected = volume();
    const MemoryFiles files = sharded(expected, at_end);
    expect_labels(*open(files), expected);
    EXPECT_EQ(open(files)->block(), (VoxelIndex{6, 5, 4}));
    EXPECT_TRUE(open(files)->grid().spacing_assumed);
  }
}

TEST(Zarr, DamagedShardsAreRefused) {
  LabelVolume expected = volume();
  const MemoryFiles files = sharded(expected, true);
  const std::string key = "a/c/0/0/0";
  const auto message_of = [&](const std::string& bytes) {
    MemoryFiles damaged = files;
    damaged[key] = bytes;
    const std::string message = error_of<InputError>([&] { (void)read_all(*open(damaged), "a"); });
    EXPECT_EQ(message.find(key), 0u) << message;
    return message;
  };
  const std::string& shard = files.at(key);
  EXPECT_NE(message_of("short").find("the index of a shard"), std::string::npos);
  EXPECT_NE(message_of(shard.substr(1)).find("its zstd data are damaged"), std::string::npos);
  EXPECT_NE(message_of(shard.substr(0, shard.size() - 1)).find("checksum"), std::string::npos);
  std::string index(8 * 16, '\0');
  for (const char huge : {'\x7f', '\xff'}) {
    index[7] = huge;
    EXPECT_NE(message_of(with_crc(index)).find("its shard says"), std::string::npos);
  }
}

TEST(Zarr, MissingChunksHaveTheFillValue) {
  LabelVolume expected = volume();
  MemoryFiles files = files_of<std::uint8_t>(expected, {});
  files.erase("a/1.1.1");
  for (int z = 4; z < 8; ++z)
    for (int y = 5; y < 10; ++y)
      for (int x = 6; x < 12; ++x) expected.labels[static_cast<std::size_t>((z * 13 + y) * 19 + x)] = 9;
  files["a/.zarray"] = replaced(second("|u1"), R"("fill_value":0)", R"("fill_value":9)");
  expect_labels(*open(files), expected);
  for (const char* none : {"\"NaN\"", "0.5", "5000000000"}) {
    files["a/.zarray"] = replaced(second("|u1"), R"("fill_value":0)", std::string(R"("fill_value":)") + none);
    const std::string message = error_of<InputError>([&] { (void)read_all(*open(files), "a"); });
    EXPECT_EQ(message.find("a/1.1.1 is missing"), 0u) << message;
  }
}

const std::string image_attributes =
    R"("multiscales":[{"axes":[{"name":"t","type":"time"},{"name":"c","type":"channel"},)"
    R"({"name":"z","type":"space","unit":"micrometer"},{"name":"y","type":"space","unit":"micrometer"},)"
    R"({"name":"x","type":"space","unit":"micrometer"}],"datasets":[{"path":"s0","coordinateTransformations":)"
    R"([{"type":"scale","scale":[1,1,2,0.5,0.25]},{"type":"translation","translation":[0,0,10,20,30]}]},)"
    R"({"path":"s1","coordinateTransformations":[{"type":"scale","scale":[1,1,4,1,0.5]}]}],)"
    R"("coordinateTransformations":[{"type":"scale","scale":[1,1,1,1,2]}]}])";

/// Arrays with the axes t, c, z, y, x in an image.
MemoryFiles image_files(const std::string& array) {
  MemoryFiles files;
  for (const auto& [path, bytes] : files_of<std::uint8_t>(volume(), {}))
    files["i.zarr/" + array + "/0.0." + path.substr(2)] = bytes;
  files["i.zarr/" + array + "/.zarray"] =
      replaced(replaced(second("|u1"), "[11,13,19]", "[1,1,11,13,19]"), "[4,5,6]", "[1,1,4,5,6]");
  return files;
}

TEST(Zarr, ImagesOpenTheFullResolutionWithSpacingAndOrigin) {
  MemoryFiles files = image_files("s0");
  files["i.zarr/.zattrs"] = "{" + image_attributes + "}";
  for (const char* path : {"i.zarr", "i.zarr/", "i.zarr/s0", "i.zarr/s0/"}) {
    const auto source = open(files, path);
    expect_labels(*source, volume());
    EXPECT_EQ(source->grid().directions, Eigen::Matrix3d(Vec3(0.5, 0.5, 2).asDiagonal())) << path;
    EXPECT_EQ(source->grid().origin, Vec3(60, 20, 10));
    EXPECT_FALSE(source->grid().spacing_assumed);
  }
  MemoryFiles other = image_files("s1");
  other["i.zarr/.zattrs"] = files["i.zarr/.zattrs"];
  EXPECT_EQ(open(other, "i.zarr/s1")->grid().directions(2, 2), 4);
  const std::string missing = error_of<InputError>([&] { (void)open(other, "i.zarr"); });
  EXPECT_EQ(missing.find("i.zarr/s0: the image names this array"), 0u) << missing;
}

TEST(Zarr, ImagesOfOmeZarr05) {
  MemoryFiles files = image_files("labels/cells/s0");
  files["i.zarr/labels/cells/zarr.json"] =
      R"({"zarr_format":3,"node_type":"group","attributes":{"ome":{"version":"0.5",)" + image_attributes +
      "}}}";
  for (const char* path : {"i.zarr/labels/cells", "i.zarr/labels/cells/s0"})
    EXPECT_EQ(open(files, path)->grid().directions(2, 2), 2) << path;
}

TEST(Zarr, ImagesThatAreNoVolumeOfLabels) {
  MemoryFiles files = image_files("s0");
  files["i.zarr/.zattrs"] = "{" + image_attributes + "}";
  std::string& array = files["i.zarr/s0/.zarray"];
  array = replaced(array, "[1,1,11", "[1,3,11");
  std::string message = error_of<InputError>([&] { (void)open(files, "i.zarr"); });
  EXPECT_EQ(message.find("i.zarr/s0: axis \"c\" has 3 items"), 0u) << message;
  files["i.zarr/.zattrs"] = replaced(files["i.zarr/.zattrs"], "micrometer", "nanometer");
  message = error_of<InputError>([&] { (void)open(files, "i.zarr"); });
  EXPECT_NE(message.find("different units"), std::string::npos) << message;
  const MemoryFiles group{{"g/.zgroup", "{\"zarr_format\":2}"}};
  message = error_of<InputError>([&] { (void)open(group, "g"); });
  EXPECT_EQ(message.find("g: it is a group of zarr arrays, and no image"), 0u) << message;
  message = error_of<InputError>([&] { (void)open(group, "h"); });
  EXPECT_EQ(message.find("h: there is no zarr array"), 0u) << message;
}

TEST(Zarr, WrongMetadataAreRefused) {
  const auto refused = [](const std::string& file, const std::string& json, const std::string& expected) {
    const MemoryFiles files{{"a/" + file, json}};
    const std::string message = error_of<InputError>([&] { (void)open(files); });
    EXPECT_EQ(message.find("a"), 0u) << message;
    EXPECT_NE(message.find(expected), std::string::npos) << message << "\n" << json;
  };
  const auto in_second = [&](const std::string& from, const std::string& to, const std::string& expected) {
    refused(".zarray", replaced(second("<u2"), from, to), expected);
  };
  refused(".zarray", "{", "JSON");
  refused(".zarray", "[]", "JSON object");
  in_second("<u2", "|u2", "items of type");
  in_second("<u2", "<c8", "items of type");
  in_second("\"<u2\"", "[[\"r\",\"|u1\"]]", "items of type");
  in_second("[11,13,19]", "[11,13]", "axes");
  in_second("[11,13,19]", "[11,13,-19]", "not a size");
  in_second("[11,13,19]", "[11,13,1e3]", "not a size");
  in_second("[11,13,19]", "[11,13,18446744073709551615]", "not a size");
  in_second("[11,13,19]", "[11,13,9223372036854775807]", "voxels");
  in_second("[11,13,19]", "[2147483647,2147483647,2147483647]", "voxels");
  in_second("[11,13,19]", "[0,13,19]", "not 1 or more");
  in_second("[4,5,6]", "[0,5,6]", "chunks have the size");
  in_second("[4,5,6]", "[4096,4096,4096]", "store it in smaller chunks");
  in_second("[4,5,6]", "[9223372036854775807,2,2]", "store it in smaller chunks");
  in_second("[4,5,6]", "7", "not a list of sizes");
  in_second("\"C\"", "\"G\"", "neither C nor F");
  in_second("\"zarr_format\":2", "\"zarr_format\":4", "zarr_format");
  in_second("\"filters\":null", R"("filters":[{"id":"delta"}])", "filters");
  in_second("\"compressor\":null", R"("compressor":{"id":"lzma"})", "compressor \"lzma\"");
  in_second("\"compressor\":null", R"("compressor":3)", "object");
  in_second("\"compressor\":null", R"("compressor":null,"dimension_separator":"-")", "separator");
  const auto in_third = [&](const std::string& codecs, const std::string& expected) {
    refused("zarr.json", third("uint16", codecs), expected);
  };
  in_third("3", "not a list");
  in_third("[]", "lack \"bytes\"");
  in_third("[3]", "object");
  in_third(R"([{"name":"zstd"},)" + little_bytes + "]", "before \"bytes\"");
  in_third("[" + little_bytes + R"(,{"name":"lz4"}])", "codec \"lz4\"");
  in_third(R"([{"name":"bytes","configuration":{"endian":"middle"}}])", "neither little nor big");
  in_third(R"([{"name":"transpose","configuration":{"order":[0,0,1]}},)" + little_bytes + "]", "transpose");
  in_third(R"([{"name":"transpose","configuration":{"order":[0,1]}},)" + little_bytes + "]", "transpose");
  const std::string sharding =
      R"([{"name":"sharding_indexed","configuration":{"chunk_shape":[2,5,6],"codecs":[)" + little_bytes +
      R"(],"index_codecs":[)" + little_bytes + "]}}]";
  in_third(replaced(sharding, "[2,5,6]", "[3,5,6]"), "do not divide");
  in_third(replaced(sharding, "[2,5,6]", "[2,5]"), "axes");
  in_third(replaced(sharding, "[2,5,6]", "[0,5,6]"), "do not divide");
  in_third(replaced(sharding, "\"index_codecs\"", "\"index\""), "not a list");
  in_third(replaced(sharding, "\"chunk_shape\"", R"("index_location":"middle","chunk_shape")"), "location");
  refused("zarr.json", third("complex64", "[" + little_bytes + "]"), "items of type");
  refused("zarr.json", third("uint16", "[" + little_bytes + "]", R"(,"storage_transformers":[{}])"),
          "transformers");
  refused("zarr.json", replaced(third("uint16", "[" + little_bytes + "]"), "regular", "rectilinear"),
          "rectilinear");
  refused("zarr.json", R"({"zarr_format":3,"node_type":"tree"})", "node_type");
  refused("zarr.json", R"({"zarr_format":3,"node_type":"group"})", "group");
  refused(".zattrs", R"({"multiscales":[3]})", "object");
  refused(".zattrs", R"({"multiscales":[{"datasets":[]}]})", "no datasets");
  refused(".zattrs", R"({"multiscales":[{"datasets":[{"path":"../b"}]}]})", "not the path");
}

TEST(Zarr, MetadataThatAreNestedDeeplyAreRefused) {
  const auto lists = [](std::size_t levels) { return std::string(levels, '[') + std::string(levels, ']'); };
  const auto message = [](const std::string& file, const std::string& json) {
    const MemoryFiles files{{"a/" + file, json}};
    return error_of<InputError>([&] { (void)read_all(*open(files), "a"); });
  };
  const auto with_fill = [&](const std::string& metadata, std::size_t levels) {
    return replaced(metadata, "\"fill_value\":0", "\"fill_value\":" + lists(levels));
  };
  const std::string third_version = third("uint16", "[" + little_bytes + "]");
  for (const std::size_t levels : {std::size_t{64}, std::size_t{400000}})
    for (const std::string& text : {message(".zarray", with_fill(second("<u2"), levels)),
                                    message(".zarray", replaced(second("<u2"), "\"<u2\"", lists(levels))),
                                    message("zarr.json", with_fill(third_version, levels)),
                                    message(".zattrs", "{\"multiscales\":" + lists(levels) + "}")})
      EXPECT_NE(text.find("nested deeper than 64 levels"), std::string::npos) << text;
  // The deepest ones that are read.
  const std::string text = message(".zarray", with_fill(second("<u2"), 63));
  EXPECT_NE(text.find("the fill value \"[...]\" is not a label"), std::string::npos) << text;
}

TEST(Zarr, DamagedChunksAreRefused) {
  Stored stored{.encode = [](const std::string& bytes) { return zstd_of(bytes); }};
  const MemoryFiles files = [&] {
    MemoryFiles all = files_of<std::uint16_t>(volume(), stored);
    all["a/.zarray"] = second("<u2", R"("compressor":{"id":"zstd"})");
    return all;
  }();
  const std::string key = "a/1.0.2";
  for (const std::string& bytes :
       {std::string(), std::string("x"), files.at(key).substr(0, files.at(key).size() - 1),
        zstd_of(std::string(239, 'x')), zstd_of(std::string(100000000, 'x')), std::string(100000, 'x')}) {
    MemoryFiles damaged = files;
    damaged[key] = bytes;
    const std::string message = error_of<InputError>([&] { (void)read_all(*open(damaged), "a"); });
    EXPECT_EQ(message.find(key), 0u) << message;
  }
}

TEST(Zarr, ValuesThatAreNoLabelsAreNamedWithTheirChunk) {
  LabelVolume wrong = volume();
  MemoryFiles files = files_of<float>(wrong, {});
  std::string& chunk = files["a/1.1.1"];
  chunk.replace(4 * ((1 * 5 + 2) * 6 + 3), 4, bytes_of<float>({0.5F}));
  files["a/.zarray"] = second("<f4");
  for (int i = 0; i < 3; ++i) {
    const std::string message = error_of<InputError>([&] { (void)read_all(*open(files), "a"); });
    EXPECT_EQ(message.find("a/1.1.1: voxel (9, 7, 5) has the value 0.5"), 0u) << message;
  }
}

}  // namespace
}  // namespace tetwright::zarr_test
