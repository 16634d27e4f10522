// SPDX-License-Identifier: Apache-2.0
// Files that GDCM writes, compressed and not.
#include <gdcmAttribute.h>
#include <gdcmImageChangeTransferSyntax.h>
#include <gdcmImageWriter.h>
#include <gdcmTrace.h>

#include <filesystem>

#include "common/io/volumes/dicom.h"
#include "tests/common/io/file_test.h"
#include "tests/common/io/volume_boxes.h"
#include "tetwright/io.h"

namespace tetwright::dicom_codecs_test {
namespace {

using gdcm::TransferSyntax;

constexpr std::size_t cache_bytes = 1 << 20;
constexpr std::array syntaxes{TransferSyntax::ImplicitVRLittleEndian,
                              TransferSyntax::ExplicitVRLittleEndian,
                              TransferSyntax::RLELossless,
                              TransferSyntax::JPEGLosslessProcess14_1,
                              TransferSyntax::JPEGLSLossless,
                              TransferSyntax::JPEG2000Lossless};

class DicomCodecs : public FileTest {
 protected:
  DicomCodecs() { gdcm::Trace::WarningOff(); }

  template <class Number>
  void write_slice(const std::string& file, const LabelVolume& volume, int z, gdcm::PixelFormat format,
                   TransferSyntax::TSType syntax) const {
    const std::vector<MaterialTag> labels =
        box_of(volume, {0, 0, z}, {volume.size[0], volume.size[1], z + 1});
    const std::vector<Number> numbers(labels.begin(), labels.end());
    gdcm::ImageWriter writer;
    gdcm::Image& image = writer.GetImage();
    image.SetNumberOfDimensions(2);
    image.SetDimension(0, static_cast<unsigned>(volume.size[0]));
    image.SetDimension(1, static_cast<unsigned>(volume.size[1]));
    image.SetPixelFormat(format);
    image.SetPhotometricInterpretation(gdcm::PhotometricInterpretation::MONOCHROME2);
    image.SetTransferSyntax(TransferSyntax::ExplicitVRLittleEndian);
    image.SetSpacing(0, 0.25);
    image.SetSpacing(1, 0.5);
    image.SetOrigin(2, 2 * z);
    const double cosines[] = {1, 0, 0, 0, 1, 0};
    image.SetDirectionCosines(cosines);
    gdcm::DataElement pixels(gdcm::Tag(0x7fe0, 0x0010));
    pixels.SetByteValue(reinterpret_cast<const char*>(numbers.data()),
                        static_cast<std::uint32_t>(numbers.size() * sizeof(Number)));
    image.SetDataElement(pixels);
    gdcm::ImageChangeTransferSyntax change;
    change.SetTransferSyntax(syntax);
    change.SetInput(image);
    ASSERT_TRUE(change.Change());
    writer.SetImage(change.GetOutput());
    gdcm::DataSet& set = writer.GetFile().GetDataSet();
    gdcm::Attribute<0x0008, 0x0016> ct;
    ct.SetValue("1.2.840.10008.5.1.4.1.1.2");
    set.Replace(ct.GetAsDataElement());
    gdcm::Attribute<0x0020, 0x000e> series;
    series.SetValue("1.2.3");
    set.Replace(series.GetAsDataElement());
    writer.SetFileName(file.c_str());
    ASSERT_TRUE(writer.Write());
  }

  template <class Number>
  void write(const LabelVolume& volume, gdcm::PixelFormat format, TransferSyntax::TSType syntax) const {
    std::filesystem::create_directories(path("series"));
    for (int z = 0; z < volume.size[2]; ++z)
      write_slice<Number>(path("series/" + std::to_string(z)), volume, z, format, syntax);
  }
};

TEST_F(DicomCodecs, FilesOfGdcm) {
  const LabelVolume volume = numbered_volume({38, 29, 3});
  LabelVolume negative = volume;
  for (MaterialTag& label : negative.labels) label = 13 * label - 800;
  for (const TransferSyntax::TSType syntax : syntaxes) {
    SCOPED_TRACE(TransferSyntax::GetTSString(syntax));
    write<std::uint8_t>(volume, gdcm::PixelFormat(1, 8, 8, 7, 0), syntax);
    const auto source = open_dicom(path("series"), cache_bytes);
    expect_labels(*source, volume);
    EXPECT_NEAR((source->grid().directions.diagonal() - Vec3(0.25, 0.5, 2)).norm(), 0, 1e-9);
    write<std::uint16_t>(volume, gdcm::PixelFormat(1, 16, 12, 11, 0), syntax);
    expect_labels(*open_dicom(path("series"), cache_bytes), volume);
    // GDCM's writer of lossless JPEG loses the signs.
    write<std::int16_t>(negative, gdcm::PixelFormat(1, 16, 16, 15, 1), syntax);
    expect_labels(*open_dicom(path("series"), cache_bytes), negative);
  }
}

TEST_F(DicomCodecs, DamagedFilesAreRefusedOrRead) {
  const LabelVolume volume = numbered_volume({38, 29, 2});
  for (const TransferSyntax::TSType syntax : syntaxes) {
    SCOPED_TRACE(TransferSyntax::GetTSString(syntax));
    write<std::uint16_t>(volume, gdcm::PixelFormat(1, 16, 12, 11, 0), syntax);
    const std::string bytes = get(path("series/1"));
    const auto read = [&] {
      try {
        (void)read_label_volume(path("series"));
        return true;
      } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("series"), std::string::npos) << error.what();
        return false;
      }
    };
    for (const std::size_t left :
         {bytes.size() - 9, bytes.size() - 100, bytes.size() / 2, bytes.size() / 3}) {
      put(path("series/1"), bytes.substr(0, left));
      EXPECT_FALSE(read()) << left;
    }
    Random random(5);
    for (int i = 0; i < 60; ++i) {
      std::string damaged = bytes;
      for (std::uint32_t n = 0; n <= random.below(3); ++n)
        damaged[200 + random.below(static_cast<std::uint32_t>(damaged.size() - 200))] =
            static_cast<char>(random.below(256));
      put(path("series/1"), damaged);
      (void)read();
    }
  }
}

}  // namespace
}  // namespace tetwright::dicom_codecs_test
