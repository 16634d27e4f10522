// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/hdf5_volume.h"

#include <filesystem>

#include "common/io/encodings/hdf5_handle.h"
#include "tests/common/io/file_test.h"
#include "tests/common/io/volume_boxes.h"
#include "tetwright/io.h"

namespace tetwright::hdf5_volume_test {
namespace {

constexpr std::size_t cache_bytes = 1 << 12;
const VoxelIndex size{19, 13, 11};

class Hdf5Volumes : public FileTest {
 protected:
  Hdf5Volumes() { quiet_hdf5(); }

  /// Creates the file with the labels as datasets.
  void create() {
    file_.emplace(H5Fcreate(path("a.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
  }

  /// Adds a dataset with these sizes in the order of the file.
  Hdf5Handle add(const std::string& name, hid_t type, const std::vector<hsize_t>& shape,
                 const std::vector<hsize_t>& chunk, bool packed = true) {
    const Hdf5Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose);
    const Hdf5Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    if (!chunk.empty()) H5Pset_chunk(creation.id(), static_cast<int>(chunk.size()), chunk.data());
    if (!chunk.empty() && packed) H5Pset_deflate(creation.id(), 4);
    const Hdf5Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    H5Pset_create_intermediate_group(links.id(), 1);
    Hdf5Handle dataset(
        H5Dcreate2(file_->id(), name.c_str(), type, space.id(), links.id(), creation.id(), H5P_DEFAULT),
        H5Dclose);
    EXPECT_TRUE(dataset.good()) << name;
    const LabelVolume volume = numbered_volume(size);
    hsize_t n = 1;
    for (const hsize_t k : shape) n *= k;
    if (n == volume.labels.size() && H5Tget_class(type) != H5T_STRING)
      H5Dwrite(dataset.id(), H5T_NATIVE_INT32, H5S_ALL, H5S_ALL, H5P_DEFAULT, volume.labels.data());
    return dataset;
  }

  static void set_text(const Hdf5Handle& dataset, const char* name, const std::string& text) {
    const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose), space(H5Screate(H5S_SCALAR), H5Sclose);
    H5Tset_size(type.id(), text.size());
    const Hdf5Handle attribute(
        H5Acreate2(dataset.id(), name, type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    H5Awrite(attribute.id(), type.id(), text.data());
  }

  /// Sets an attribute of several texts, of variable or fixed length.
  static void set_texts(const Hdf5Handle& dataset, const char* name, const std::string& text, hsize_t n,
                        bool variable) {
    const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose), space(H5Screate_simple(1, &n, nullptr), H5Sclose);
    H5Tset_size(type.id(), variable ? H5T_VARIABLE : text.size());
    const Hdf5Handle attribute(
        H5Acreate2(dataset.id(), name, type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    if (n == 0) return;
    const std::vector<const char*> pointers(n, text.c_str());
    std::string bytes;
    for (hsize_t i = 0; i < n && !variable; ++i) bytes += text;
    EXPECT_GE(H5Awrite(attribute.id(), type.id(),
                       variable ? static_cast<const void*>(pointers.data()) : bytes.data()),
              0);
  }

  static void set_numbers(const Hdf5Handle& dataset, const char* name, const std::vector<double>& numbers) {
    const hsize_t n = numbers.size();
    const Hdf5Handle space(H5Screate_simple(1, &n, nullptr), H5Sclose);
    const Hdf5Handle attribute(
        H5Acreate2(dataset.id(), name, H5T_IEEE_F32LE, space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    H5Awrite(attribute.id(), H5T_NATIVE_DOUBLE, numbers.data());
  }

  void close() { file_.reset(); }

  std::unique_ptr<LabelSource> open(const std::string& dataset = {}) {
    return open_hdf5_volume(path("a.h5"), dataset, cache_bytes);
  }

  std::string message(const std::string& dataset = {}) {
    return error_of<InputError>([&] { (void)read_all(*open(dataset), "a.h5"); });
  }

  std::optional<Hdf5Handle> file_;
};

TEST_F(Hdf5Volumes, AllTypesWithAndWithoutChunks) {
  for (const std::vector<hsize_t>& chunk : {std::vector<hsize_t>{}, {4, 5, 6}, {11, 13, 19}, {1, 13, 19}}) {
    create();
    int number = 0;
    for (const hid_t type : {H5T_STD_I8LE, H5T_STD_U8LE, H5T_STD_I16BE, H5T_STD_U16LE, H5T_STD_I32LE,
                             H5T_STD_U32BE, H5T_STD_I64LE, H5T_STD_U64BE, H5T_IEEE_F32LE, H5T_IEEE_F64BE}) {
      (void)add("/d" + std::to_string(number), type, {11, 13, 19}, chunk, number % 2 == 0);
      ++number;
    }
    close();
    for (int i = 0; i < number; ++i) {
      const auto source = open("/d" + std::to_string(i));
      EXPECT_FALSE(source->in_memory());
      expect_labels(*source, numbered_volume(size));
    }
  }
}

TEST_F(Hdf5Volumes, TheOnlyDatasetOfThreeAxesIsFound) {
  create();
  (void)add("/volume/labels", H5T_STD_U16LE, {11, 13, 19}, {4, 5, 6});
  (void)add("/table", H5T_STD_U16LE, {11, 13}, {});
  (void)add("/image", H5T_IEEE_F32LE, {11, 13, 19}, {});
  close();
  expect_labels(*open(), numbered_volume(size));
  expect_labels(*open_label_source(path("a.h5:/volume/labels")), numbered_volume(size));
  EXPECT_EQ(read_label_volume(path("a.h5")).labels, numbered_volume(size).labels);
  EXPECT_EQ(file_kind("x/a.H5:/volume/labels"), FileKind::volume);
  EXPECT_EQ(files_of_input("a.h5:/b"), (std::vector<std::string>{"a.h5:/b", "a.h5"}));
  file_.emplace(H5Fopen(path("a.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
  (void)add("/other", H5T_STD_U16LE, {11, 13, 19, 1}, {});
  close();
  EXPECT_NE(message().find("it has 2 datasets of three axes (\"/other\", \"/volume/labels\")"),
            std::string::npos)
      << message();
}

TEST_F(Hdf5Volumes, SpacingAndAxesOfIlastik) {
  create();
  const Hdf5Handle plain = add("/a", H5T_STD_U8LE, {11, 13, 19}, {});
  set_numbers(plain, "element_size_um", {4, 2, 1});
  const Hdf5Handle tagged = add("/b", H5T_STD_U8LE, {11, 13, 19, 1}, {4, 5, 6, 1});
  set_text(tagged, "axistags", R"({"axes":[{"key":"z"},{"key":"y"},{"key":"x"},{"key":"c"}]})");
  const Hdf5Handle turned = add("/c", H5T_STD_U8LE, {11, 13, 19}, {4, 5, 6});
  set_text(turned, "axistags", R"({"axes":[{"key":"x"},{"key":"y"},{"key":"z"}]})");
  const Hdf5Handle channels = add("/d", H5T_STD_U8LE, {11, 13, 19, 2}, {});
  set_text(channels, "axistags", R"({"axes":[{"key":"z"},{"key":"y"},{"key":"x"},{"key":"c"}]})");
  close();
  EXPECT_EQ(Vec3(open("/a")->grid().directions.diagonal()), Vec3(1, 2, 4));
  EXPECT_FALSE(open("/a")->grid().spacing_assumed);
  EXPECT_TRUE(open("/b")->grid().spacing_assumed);
  expect_labels(*open("/b"), numbered_volume(size));
  const auto source = open("/c");
  ASSERT_EQ(source->grid().size, (VoxelIndex{11, 13, 19}));
  std::vector<MaterialTag> label(1);
  source->read({2, 3, 4}, {3, 4, 5}, label);
  EXPECT_EQ(label, box_of(numbered_volume(size), {4, 3, 2}, {5, 4, 3}));
  EXPECT_NE(message("/d").find("axis \"c\" has 2 items"), std::string::npos) << message("/d");
}

TEST_F(Hdf5Volumes, AttributesOfAnotherSizeAreIgnored) {
  const std::string tags = R"({"axes":[{"key":"x"},{"key":"y"},{"key":"z"}]})";
  // Attributes of more than 64 KB need the newest format of files.
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_libver_bounds(access.id(), H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
  file_.emplace(H5Fcreate(path("a.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.id()), H5Fclose);
  std::vector<std::string> ignored, taken;
  for (const bool variable : {true, false}) {
    const std::string kind = variable ? "/variable" : "/fixed";
    const auto with_tags = [&](const std::string& name, const std::string& text, hsize_t n) {
      const Hdf5Handle dataset = add(name, H5T_STD_U8LE, {11, 13, 19}, {});
      set_texts(dataset, "axistags", text, n, variable);
      set_numbers(dataset, "element_size_um", std::vector<double>(n == 1 ? 3 : 1000, 2));
      return name;
    };
    taken.push_back(with_tags(kind + "_one", tags, 1));
    ignored.push_back(with_tags(kind + "_many", tags, 2000));
    ignored.push_back(with_tags(kind + "_none", tags, 0));
    ignored.push_back(with_tags(kind + "_long", tags + std::string(1 << 16, ' '), 1));
  }
  close();
  for (const std::string& name : taken) EXPECT_EQ(open(name)->grid().size, (VoxelIndex{11, 13, 19})) << name;
  for (const std::string& name : ignored) {
    const auto source = open(name);
    EXPECT_EQ(source->grid().spacing_assumed, !name.ends_with("_long")) << name;
    expect_labels(*source, numbered_volume(size));
  }
}

TEST_F(Hdf5Volumes, EnumerationsThatDoNotFillTheirBytesAreRefused) {
  create();
  for (const bool whole : {true, false}) {
    const Hdf5Handle number(H5Tcopy(H5T_STD_I32LE), H5Tclose);
    if (!whole) H5Tset_precision(number.id(), 8);
    const Hdf5Handle type(H5Tenum_create(number.id()), H5Tclose);
    for (int value = 0; value < 127; ++value) {
      const std::int32_t stored = value;
      H5Tenum_insert(type.id(), ("label" + std::to_string(value)).c_str(), &stored);
    }
    const hsize_t shape[] = {2, 1, 2};
    const Hdf5Handle space(H5Screate_simple(3, shape, nullptr), H5Sclose);
    const Hdf5Handle dataset(H5Dcreate2(file_->id(), whole ? "/whole" : "/part", type.id(), space.id(),
                                        H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                             H5Dclose);
    const std::int32_t values[] = {1, 0, 126, 1};
    EXPECT_GE(H5Dwrite(dataset.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values), 0);
  }
  close();
  EXPECT_EQ(read_all(*open("/whole"), "f").labels, (std::vector<MaterialTag>{1, 0, 126, 1}));
  EXPECT_NE(message("/part").find("do not fill their bytes"), std::string::npos) << message("/part");
}

TEST_F(Hdf5Volumes, MissingChunksAndBooleans) {
  create();
  const hsize_t unwritten[] = {8, 8, 8};
  (void)add("/empty", H5T_STD_U8LE, {unwritten[0], unwritten[1], unwritten[2]}, {4, 4, 4});
  const Hdf5Handle boolean(H5Tenum_create(H5T_NATIVE_INT8), H5Tclose);
  for (const signed char value : {'\0', '\1'}) H5Tenum_insert(boolean.id(), value ? "TRUE" : "FALSE", &value);
  const hsize_t shape[] = {2, 1, 2};
  const Hdf5Handle space(H5Screate_simple(3, shape, nullptr), H5Sclose);
  const Hdf5Handle flags(
      H5Dcreate2(file_->id(), "/flags", boolean.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
      H5Dclose);
  const signed char values[] = {1, 0, 0, 1};
  H5Dwrite(flags.id(), boolean.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
  close();
  EXPECT_EQ(read_all(*open("/empty"), "f").labels, std::vector<MaterialTag>(512, 0));
  EXPECT_EQ(read_all(*open("/flags"), "f").labels, (std::vector<MaterialTag>{1, 0, 0, 1}));
}

TEST_F(Hdf5Volumes, WrongFilesAndDatasetsAreNamed) {
  put(path("a.h5"), "not HDF5");
  EXPECT_NE(message().find("a.h5: this is not an HDF5 file"), std::string::npos) << message();
  std::filesystem::remove(path("a.h5"));
  EXPECT_NE(message().find("cannot read"), std::string::npos) << message();
  create();
  (void)add("/g/flat", H5T_STD_U8LE, {11, 13}, {});
  const Hdf5Handle text(H5Tcopy(H5T_C_S1), H5Tclose);
  (void)add("/text", text.id(), {2, 2, 2}, {});
  (void)add("/times", H5T_STD_U8LE, {2, 11, 13, 19}, {});
  (void)add("/huge", H5T_STD_U8LE, {2147483647, 2147483647, 2147483647}, {1, 1, 1});
  (void)add("/long", H5T_STD_U8LE, {4294967296, 1, 1}, {1, 1, 1});
  (void)add("/chunk", H5T_STD_U8LE, {4096, 4096, 4096}, {2000, 2000, 1000});
  close();
  EXPECT_NE(message().find("datasets of three axes"), std::string::npos) << message();
  EXPECT_NE(message("/none").find("dataset \"/none\": it is missing"), std::string::npos) << message("/none");
  EXPECT_NE(message("/g").find("is a group"), std::string::npos) << message("/g");
  EXPECT_NE(message("/g/flat").find("2 axes; a volume of labels has 3"), std::string::npos)
      << message("/g/flat");
  EXPECT_NE(message("/text").find("not whole numbers"), std::string::npos) << message("/text");
  EXPECT_NE(message("/times").find("axis 0 has 2 items"), std::string::npos) << message("/times");
  EXPECT_NE(message("/huge").find("voxels"), std::string::npos) << message("/huge");
  EXPECT_NE(message("/long").find("voxels"), std::string::npos) << message("/long");
  EXPECT_NE(message("/chunk").find("smaller chunks"), std::string::npos) << message("/chunk");
}

TEST_F(Hdf5Volumes, DamagedChunksAreNamed) {
  create();
  (void)add("/a", H5T_STD_U16LE, {11, 13, 19}, {4, 5, 6});
  close();
  std::string bytes = get(path("a.h5"));
  // Streams of zlib begin with 78 and a level.
  int damaged = 0;
  for (std::size_t at = bytes.size() / 2; at + 20 < bytes.size(); ++at)
    if (bytes[at] == 0x78 && bytes[at + 1] == 0x5e) {
      bytes.replace(at + 2, 8, "damaged!");
      ++damaged;
      at += 10;
    }
  ASSERT_GT(damaged, 0);
  put(path("a.h5"), bytes);
  EXPECT_NE(message().find("a.h5: dataset \"/a\": chunk ("), std::string::npos) << message();
  put(path("a.h5"), bytes.substr(0, bytes.size() - 1));
  EXPECT_NE(message().find("a.h5: "), std::string::npos) << message();
}

}  // namespace
}  // namespace tetwright::hdf5_volume_test
