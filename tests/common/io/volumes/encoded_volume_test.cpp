// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/encoded_volume.h"

#include <limits>

#include "tests/common/io/file_test.h"
#include "tests/common/io/image_values.h"
#include "tests/common/io/volume_bytes.h"
#include "tetwright/io.h"
#include "tetwright/resources.h"

namespace tetwright::encoded_volume_test {
namespace {

constexpr VoxelIndex size{5, 4, 3};

/// Images in files, whose bytes are also read as a stream.
class Images : public FileTest {
 protected:
  /// Expects the values of image_value(), read by ranges if the file allows it, and from its bytes.
  void expect(const std::string& name, const std::string& bytes, int channels) {
    put(path(name), bytes);
    SCOPED_TRACE(name);
    expect_image(read_image(path(name)), size, channels);
    const std::string extension = name.substr(name.find('.'));
    expect_image(read_image_bytes(bytes, "f", extension), size, channels);
  }
  std::string message(const std::string& name, const std::string& bytes) {
    put(path(name), bytes);
    const std::string of_stream =
        error_of<InputError>([&] { (void)read_image_bytes(bytes, path(name), name.substr(name.find('.'))); });
    const std::string of_file = error_of<InputError>([&] { (void)read_image(path(name)); });
    EXPECT_EQ(of_file, of_stream);
    EXPECT_TRUE(of_file.starts_with(path(name) + ": ")) << of_file;
    return of_file.substr(path(name).size() + 2);
  }
};

std::string nrrd(const std::string& type, const std::string& sizes, const std::string& more,
                 const std::string& body) {
  const bool four = sizes.find(' ', sizes.find(' ', sizes.find(' ') + 1) + 1) != std::string::npos;
  return "NRRD0004\ntype: " + type + "\ndimension: " + (four ? "4" : "3") + "\nsizes: " + sizes +
         "\nendian: little\n" + more + "\n\n" + body;
}

TEST_F(Images, OfNrrdWithChannelsOnEveryAxis) {
  expect("a.nrrd", nrrd("float", "5 4 3", "encoding: raw", bytes_of(image_numbers<float>(size, 1, 3))), 1);
  for (std::size_t position = 0; position <= 3; ++position) {
    std::vector<std::string> sizes{"5", "4", "3"}, kinds(3, "domain"),
        directions{"(2,0,0)", "(0,2,0)", "(0,0,2)"};
    const auto at = static_cast<std::ptrdiff_t>(position);
    sizes.insert(sizes.begin() + at, "2");
    kinds.insert(kinds.begin() + at, position % 2 ? "list" : "vector");
    directions.insert(directions.begin() + at, "none");
    const auto joined = [](const std::vector<std::string>& words) {
      return words[0] + " " + words[1] + " " + words[2] + " " + words[3];
    };
    const std::string body = bytes_of(image_numbers<double>(size, 2, position));
    const std::string with_kinds = "kinds: " + joined(kinds) + "\nencoding: ";
    const std::string with_directions =
        "space: left-posterior-superior\nspace directions: " + joined(directions) + "\nencoding: ";
    for (const std::string& fields : {with_kinds, with_directions}) {
      expect("b.nrrd", nrrd("double", joined(sizes), fields + "raw", body), 2);
      expect("c.nrrd", nrrd("double", joined(sizes), fields + "gzip", deflated(body)), 2);
      std::string text;
      for (const double value : image_numbers<double>(size, 2, position)) text += std::to_string(value) + " ";
      expect("d.nrrd", nrrd("double", joined(sizes), fields + "text", text), 2);
      expect("e.nrrd", nrrd("double", joined(sizes), fields + "raw\nbyte skip: -1", "x" + body), 2);
    }
    EXPECT_EQ(read_image(path("c.nrrd")).directions(2, 2), 2);
  }
}

TEST_F(Images, OfNrrdThatAreNone) {
  const std::string two = bytes_of(std::vector<float>{1, 2});
  EXPECT_EQ(
      message("a.seg.nrrd", nrrd("float", "2 1 1 1",
                                 "kinds: list domain domain domain\nencoding: raw\nSegment0_Layer:=1", two)),
      "line 4: its segments overlap, in 2 layers: it is a segmentation, not an image");
  EXPECT_EQ(
      message("b.nrrd", nrrd("float", "2 2 2 2", "encoding: raw", two)),
      "line 4: 4 axes of more than one item; an image has 3, and one of another kind (list, vector) for "
      "channels");
  EXPECT_EQ(
      message("c.nrrd", nrrd("float", "2 2 2 2", "kinds: list domain vector domain\nencoding: raw", two)),
      "line 4: axis 2 (2 items of kind \"vector\") is not a spatial axis; an image has three and one of "
      "channels");
  EXPECT_NE(message("d.nrrd", nrrd("block", "2 1 1", "encoding: raw", two)).find("floats of 32 bits"),
            std::string::npos);
  EXPECT_NE(
      message("e.nrrd", nrrd("float", "2 1 1 1", "kinds: list domain domain domain\nencoding: raw", "1234"))
          .find("its 1 x 1 x 1 voxels of 2 x 4 bytes need 8 bytes, but only 4 "),
      std::string::npos);
}

TEST_F(Images, ValuesThatAreNotFiniteAreNamed) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  for (const auto& [value, text] :
       {std::pair{std::numeric_limits<double>::quiet_NaN(), "nan, not a finite number"},
        std::pair{-inf, "-inf, not a finite number"},
        std::pair{1e39, "1e+39, beyond the range of 32-bit floats"}}) {
    std::vector<double> one(60, 0.5);
    one[38] = one[39] = value;
    const std::string expected = "voxel (3, 3, 1) has the value " + std::string(text);
    EXPECT_TRUE(
        message("a.nrrd", nrrd("double", "5 4 3", "encoding: raw", bytes_of(one))).starts_with(expected));
    EXPECT_TRUE(message("b.nrrd", nrrd("double", "5 4 3", "encoding: gzip", deflated(bytes_of(one))))
                    .starts_with(expected));
    std::vector<double> several(120, 0.5);
    several[77] = value;
    const std::string of_channel = "voxel (3, 3, 1) of channel 1 has the value " + std::string(text);
    const std::string kinds = "kinds: list domain domain domain\nencoding: ";
    EXPECT_TRUE(message("c.nrrd", nrrd("double", "2 5 4 3", kinds + "raw", bytes_of(several)))
                    .starts_with(of_channel));
    EXPECT_TRUE(message("d.nrrd", nrrd("double", "2 5 4 3", kinds + "gzip", deflated(bytes_of(several))))
                    .starts_with(of_channel));
  }
}

TEST_F(Images, OfMetaImageWithChannels) {
  const auto meta = [](const std::string& type, int channels, const std::string& more,
                       const std::string& body) {
    return "ObjectType = Image\nNDims = 3\nBinaryData = True\nDimSize = 5 4 3\nElementSpacing = 1 2 3\n" +
           more + "ElementNumberOfChannels = " + std::to_string(channels) + "\nElementType = " + type +
           "\nElementDataFile = LOCAL\n" + body;
  };
  for (const int channels : {1, 3}) {
    expect("a.mha", meta("MET_FLOAT", channels, "", bytes_of(image_numbers<float>(size, channels, 0))),
           channels);
    expect("b.mha",
           meta("MET_DOUBLE", channels, "CompressedData = True\n",
                deflated(bytes_of(image_numbers<double>(size, channels, 0)), 15)),
           channels);
  }
  EXPECT_EQ(read_image(path("a.mha")).directions(1, 1), 2);
  EXPECT_NE(message("c.mha", meta("MET_FLOAT", 0, "", "")).find("0 channels; an image has 1 to "),
            std::string::npos);
  EXPECT_NE(message("d.mha", meta("MET_FLOAT", 2000000000, "", "")).find("2000000000 channels"),
            std::string::npos);
}

TEST_F(Images, OfNiftiWithTimesOrVectorsAndSlope) {
  const auto nifti = [](int type, const std::vector<std::int16_t>& dim, float slope, float intercept,
                        const std::string& body) {
    std::string bytes(352, '\0');
    const auto set = [&]<class Number>(std::size_t offset, Number value) {
      bytes.replace(offset, sizeof(Number), bytes_of<Number>({value}));
    };
    set(0, std::int32_t{348});
    for (std::size_t k = 0; k < dim.size(); ++k) set(40 + 2 * k, dim[k]);
    set(70, static_cast<std::int16_t>(type));
    for (std::size_t k = 0; k < 8; ++k) set(76 + 4 * k, 1.0f);
    set(108, 352.0f);
    set(112, slope);
    set(116, intercept);
    bytes.replace(344, 4, std::string("n+1\0", 4));
    return bytes + body;
  };
  for (const int channels : {1, 3}) {
    const auto n = static_cast<std::int16_t>(channels);
    const std::string floats = bytes_of(image_numbers<float>(size, channels, 3));
    for (const std::vector<std::int16_t>& dim :
         {std::vector<std::int16_t>{4, 5, 4, 3, n}, std::vector<std::int16_t>{5, 5, 4, 3, 1, n}}) {
      expect("a.nii", nifti(16, dim, 0, 0, floats), channels);
      expect("b.nii.gz", deflated(nifti(16, dim, 0, 0, floats)), channels);
    }
    // A quarter is the smallest step of the values.
    std::vector<std::int16_t> scaled;
    for (const float value : image_numbers<float>(size, channels, 3))
      scaled.push_back(static_cast<std::int16_t>(4 * (value - 7)));
    expect("c.nii", nifti(4, {4, 5, 4, 3, n}, 0.25f, 7, bytes_of(scaled)), channels);
  }
  EXPECT_NE(
      message("d.nii", nifti(16, {5, 5, 4, 3, 2, 3}, 0, 0, "")).find("dim[5] is 3, and an axis before it"),
      std::string::npos);
  EXPECT_NE(message("e.nii", nifti(128, {3, 5, 4, 3}, 0, 0, ""))
                .find("RGB colours) of the voxels is not supported; save the values"),
            std::string::npos);
}

TEST_F(Images, OfInrWithNumbersOfAVoxel) {
  for (const int channels : {1, 2}) {
    std::string header = "#INRIMAGE-4#{\nXDIM=5\nYDIM=4\nZDIM=3\nVDIM=" + std::to_string(channels) +
                         "\nTYPE=float\nPIXSIZE=32 bits\nCPU=decm\n";
    header.resize(252, '\n');
    const std::string bytes = header + "##}\n" + bytes_of(image_numbers<float>(size, channels, 0));
    expect("a.inr", bytes, channels);
    expect("b.inr.gz", deflated(bytes), channels);
  }
}

TEST_F(Images, MemoryIsCheckedBeforeItIsTaken) {
  const std::string bytes =
      nrrd("float", "5 4 3", "encoding: gzip", deflated(bytes_of(image_numbers<float>(size, 1, 3))));
  const MemoryLimit limit(200);
  const std::string message = error_of<OutputError>([&] { (void)read_image_bytes(bytes, "f", ".nrrd"); });
  EXPECT_TRUE(message.starts_with("the values of f would take about ")) << message;
}

TEST_F(Images, LabelsRefuseFractionsAndPointToIso) {
  const std::string bytes =
      nrrd("float", "5 4 3", "encoding: raw", bytes_of(image_numbers<float>(size, 1, 3)));
  const std::string message =
      error_of<InputError>([&] { (void)read_label_volume_bytes(bytes, "f", ".nrrd"); });
  EXPECT_EQ(
      message,
      "f: voxel (0, 1, 0) has the value 0.25, not a whole number; a volume of labels is needed; mesh an "
      "image with --iso");
}

}  // namespace
}  // namespace tetwright::encoded_volume_test
