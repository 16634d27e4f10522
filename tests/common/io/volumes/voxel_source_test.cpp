// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/voxel_source.h"

#include <tiffio.h>

#include <filesystem>

#include "common/io/encodings/hdf5_handle.h"
#include "common/io/volumes/hdf5_volume.h"
#include "common/io/volumes/tiff_stack.h"
#include "common/io/volumes/zarr.h"
#include "tests/common/io/file_test.h"
#include "tests/common/io/image_values.h"
#include "tests/common/io/memory_files.h"
#include "tests/common/io/volume_bytes.h"
#include "tetwright/io.h"

namespace tetwright::voxel_source_test {
namespace {

constexpr VoxelIndex size{5, 4, 3};
constexpr std::size_t cache_bytes = 1 << 12;

using ImageSources = FileTest;

/// Chunks of an array c, z, y, x of floats: {c, z, y, x} items each, 77 outside of the array.
MemoryFiles zarr_chunks(int channels, const std::array<int, 4>& chunk) {
  MemoryFiles files;
  const std::array<int, 4> shape{channels, size[2], size[1], size[0]};
  std::array<int, 4> n{};
  for (std::size_t k = 0; k < 4; ++k) n[k] = (shape[k] - 1) / chunk[k] + 1;
  for (int number = 0; number < n[0] * n[1] * n[2] * n[3]; ++number) {
    const std::array<int, 4> at{number / (n[1] * n[2] * n[3]), number / (n[2] * n[3]) % n[1],
                                number / n[3] % n[2], number % n[3]};
    std::vector<float> values;
    for (int c = at[0] * chunk[0]; c < (at[0] + 1) * chunk[0]; ++c)
      for (int z = at[1] * chunk[1]; z < (at[1] + 1) * chunk[1]; ++z)
        for (int y = at[2] * chunk[2]; y < (at[2] + 1) * chunk[2]; ++y)
          for (int x = at[3] * chunk[3]; x < (at[3] + 1) * chunk[3]; ++x)
            values.push_back(
                c < shape[0] && z < shape[1] && y < shape[2] && x < shape[3] ? image_value(x, y, z, c) : 77);
    files["a/" + std::to_string(at[0]) + "." + std::to_string(at[1]) + "." + std::to_string(at[2]) + "." +
          std::to_string(at[3])] = bytes_of(values);
  }
  return files;
}

std::string zarr_metadata(int channels, const std::array<int, 4>& chunk, const std::string& fill = "0") {
  const auto list = [](const std::array<int, 4>& n) {
    return "[" + std::to_string(n[0]) + "," + std::to_string(n[1]) + "," + std::to_string(n[2]) + "," +
           std::to_string(n[3]) + "]";
  };
  return R"({"zarr_format":2,"shape":)" + list({channels, size[2], size[1], size[0]}) + R"(,"chunks":)" +
         list(chunk) + R"(,"dtype":"<f4","order":"C","filters":null,"compressor":null,"fill_value":)" + fill +
         "}";
}

std::unique_ptr<VoxelSource> open_image(const MemoryFiles& files) {
  return open_zarr("a", cache_bytes, opener_of(files), VoxelUse::image);
}

TEST(ZarrImages, ChannelsInOneChunkOrSeveral) {
  for (const int channels : {1, 3})
    for (const std::array<int, 4>& chunk : {std::array<int, 4>{1, 2, 3, 4}, {2, 3, 4, 5}, {3, 1, 4, 2}}) {
      MemoryFiles files = zarr_chunks(channels, chunk);
      files["a/.zarray"] = zarr_metadata(channels, chunk);
      expect_image(read_all_values(*open_image(files), "a"), size, channels);
      std::vector<float> box(2);
      open_image(files)->read_values({1, 2, 1}, {3, 3, 2}, channels - 1, box);
      EXPECT_EQ(box,
                (std::vector<float>{image_value(1, 2, 1, channels - 1), image_value(2, 2, 1, channels - 1)}));
    }
}

TEST(ZarrImages, MissingChunksHaveTheFillValue) {
  const std::array<int, 4> chunk{1, 3, 4, 5};
  MemoryFiles files = zarr_chunks(2, chunk);
  files.erase("a/1.0.0.0");
  files["a/.zarray"] = zarr_metadata(2, chunk, "-0.5");
  EXPECT_EQ(read_all_values(*open_image(files), "a").channels[1], std::vector<float>(60, -0.5f));
  files["a/.zarray"] = zarr_metadata(2, chunk, R"("NaN")");
  const std::string message = error_of<InputError>([&] { (void)read_all_values(*open_image(files), "a"); });
  EXPECT_TRUE(message.starts_with("a/1.0.0.0 is missing, and the fill value ")) << message;
  EXPECT_NE(message.find("NaN\"\" is not a finite number"), std::string::npos) << message;
}

TEST(ZarrImages, AxesAreChosenByTheirNames) {
  const auto message = [](const std::string& names) {
    const std::array<int, 4> chunk{1, 3, 4, 5};
    MemoryFiles files;
    files["g/.zattrs"] = R"({"multiscales":[{"axes":)" + names + R"(,"datasets":[{"path":"a"}]}]})";
    files["g/a/.zarray"] = zarr_metadata(2, chunk);
    return error_of<InputError>(
        [&] { (void)open_zarr("g", cache_bytes, opener_of(files), VoxelUse::image); });
  };
  EXPECT_EQ(
      message(R"(["t","z","y","x"])"),
      "g/a: axis \"t\" has 2 items beside three spatial axes, and only one of channels (\"c\") is read; "
      "save one of its items");
}

/// Pages of floats, for each slice or channel in the order of the file.
void write_pages(const std::string& path, const std::vector<std::array<int, 2>>& slices_and_channels,
                 const std::string& description, int samples = 1) {
  TIFF* file = TIFFOpen(path.c_str(), "w");
  ASSERT_NE(file, nullptr);
  for (const auto& [z, channel] : slices_and_channels) {
    TIFFSetField(file, TIFFTAG_IMAGEWIDTH, size[0]);
    TIFFSetField(file, TIFFTAG_IMAGELENGTH, size[1]);
    TIFFSetField(file, TIFFTAG_SAMPLESPERPIXEL, samples);
    TIFFSetField(file, TIFFTAG_BITSPERSAMPLE, 32);
    TIFFSetField(file, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP);
    TIFFSetField(file, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    TIFFSetField(file, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    TIFFSetField(file, TIFFTAG_ROWSPERSTRIP, 2);
    TIFFSetField(file, TIFFTAG_IMAGEDESCRIPTION, description.c_str());
    for (int y = 0; y < size[1]; ++y) {
      std::vector<float> row;
      for (int x = 0; x < size[0] * samples; ++x) row.push_back(image_value(x, y, z, channel));
      TIFFWriteScanline(file, row.data(), static_cast<std::uint32_t>(y), 0);
    }
    TIFFWriteDirectory(file);
  }
  TIFFClose(file);
}

TEST_F(ImageSources, TiffChannelsOfImageJAndOme) {
  using Pages = std::vector<std::array<int, 2>>;
  const Pages slices{{0, 0}, {1, 0}, {2, 0}}, channels_first{{0, 0}, {0, 1}, {1, 0}, {1, 1}, {2, 0}, {2, 1}},
      slices_first{{0, 0}, {1, 0}, {2, 0}, {0, 1}, {1, 1}, {2, 1}};
  const auto ome = [](const std::string& order) {
    return R"(<OME><Image><Pixels DimensionOrder=")" + order +
           R"(" SizeC="2" SizeZ="3" SizeT="1"/></Image></OME>)";
  };
  write_pages(path("plain.tif"), slices, "");
  expect_image(read_image(path("plain.tif")), size, 1);
  write_pages(path("imagej.tif"), channels_first, "ImageJ=1.53\nimages=6\nchannels=2\nslices=3\nspacing=2\n");
  expect_image(read_image(path("imagej.tif")), size, 2);
  write_pages(path("xyczt.tif"), channels_first, ome("XYCZT"));
  expect_image(read_image(path("xyczt.tif")), size, 2);
  write_pages(path("xyzct.tif"), slices_first, ome("XYZCT"));
  expect_image(read_image(path("xyzct.tif")), size, 2);
  const auto message = [&](const std::string& name) {
    return error_of<InputError>([&] { (void)read_image(path(name)); });
  };
  write_pages(path("cut.tif"), slices, "ImageJ=1.53\nimages=3\nchannels=2\nspacing=2\n");
  EXPECT_EQ(message("cut.tif"), path("cut.tif") + ": its 3 pages are not those of 2 channels; save it again");
  write_pages(path("times.tif"), channels_first, "ImageJ=1.53\nimages=6\nframes=2\nspacing=2\n");
  EXPECT_EQ(message("times.tif"),
            path("times.tif") + ": it has 2 times, and an image has one; save one of them as a stack");
  write_pages(path("samples.tif"), slices, "", 2);
  EXPECT_NE(message("samples.tif").find("2 samples for each pixel, or colours; save each channel"),
            std::string::npos);
}

class Hdf5Images : public FileTest {
 protected:
  Hdf5Images() { quiet_hdf5(); }

  void write(const std::string& name, const std::vector<hsize_t>& shape, const std::vector<float>& values,
             const std::string& tags = {}, const std::vector<hsize_t>& chunk = {}) {
    const Hdf5Handle file(std::filesystem::exists(path("a.h5"))
                              ? H5Fopen(path("a.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT)
                              : H5Fcreate(path("a.h5").c_str(), H5F_ACC_EXCL, H5P_DEFAULT, H5P_DEFAULT),
                          H5Fclose);
    const Hdf5Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose);
    const Hdf5Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    if (!chunk.empty()) H5Pset_chunk(creation.id(), static_cast<int>(chunk.size()), chunk.data());
    const Hdf5Handle dataset(H5Dcreate2(file.id(), name.c_str(), H5T_IEEE_F32LE, space.id(), H5P_DEFAULT,
                                        creation.id(), H5P_DEFAULT),
                             H5Dclose);
    EXPECT_GE(H5Dwrite(dataset.id(), H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
    if (tags.empty()) return;
    const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose), scalar(H5Screate(H5S_SCALAR), H5Sclose);
    H5Tset_size(type.id(), tags.size());
    const Hdf5Handle attribute(
        H5Acreate2(dataset.id(), "axistags", type.id(), scalar.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    H5Awrite(attribute.id(), type.id(), tags.data());
  }
};

TEST_F(Hdf5Images, DatasetsOfFloatsWithChannels) {
  write("/only", {3, 4, 5}, image_numbers<float>(size, 1, 3));
  expect_image(read_image(path("a.h5")), size, 1);
  EXPECT_EQ(error_of<InputError>([&] { (void)read_label_volume(path("a.h5")); }),
            path("a.h5") + ": it has no dataset of three axes and whole numbers");
  // Probabilities of ilastik have the channels last.
  const std::string tags = R"({"axes":[{"key":"z"},{"key":"y"},{"key":"x"},{"key":"c"}]})";
  for (const std::vector<hsize_t>& chunk : {std::vector<hsize_t>{}, {2, 3, 4, 2}, {3, 4, 5, 1}}) {
    const std::string name = "/last" + std::to_string(chunk.empty() ? 0 : chunk[0]);
    write(name, {3, 4, 5, 3}, image_numbers<float>(size, 3, 0), tags, chunk);
    expect_image(read_image(path("a.h5:" + name)), size, 3);
  }
  write("/first", {2, 3, 4, 5}, image_numbers<float>(size, 2, 3), {}, {1, 2, 2, 2});
  expect_image(read_image(path("a.h5:/first")), size, 2);
  EXPECT_NE(error_of<InputError>([&] {
              (void)read_image(path("a.h5"));
            }).find("it has 5 datasets of three axes (\"/first\", \"/last0\","),
            std::string::npos);
}

}  // namespace
}  // namespace tetwright::voxel_source_test
