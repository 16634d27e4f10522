// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/tiff_pages.h"

#include <tiffio.h>

#include <cstdarg>
#include <cstdio>

#include "common/io/encodings/byte_order.h"
#include "common/io/volumes/chunked_source.h"
#include "common/message_text.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

/// Receives the messages of libtiff on one file; the first one names the cause.
struct TiffMessages {
  std::string first;

  static int take(TIFF* /*file*/, void* user, const char* /*module*/, const char* format, va_list arguments) {
    auto& messages = *static_cast<TiffMessages*>(user);
    char text[256];
    if (messages.first.empty() && std::vsnprintf(text, sizeof text, format, arguments) > 0)
      messages.first = printable(text);
    return 1;
  }
  static int ignore(TIFF* /*file*/, void* /*user*/, const char* /*module*/, const char* /*format*/,
                    va_list /*arguments*/) {
    return 1;
  }
};

template <class Value>
Value field(TIFF* file, std::uint32_t tag, Value otherwise) {
  Value value{};
  return TIFFGetFieldDefaulted(file, tag, &value) == 1 ? value : otherwise;
}

std::string sample_text(std::uint16_t format, std::uint16_t bits) {
  const char* kind = format == SAMPLEFORMAT_INT      ? "signed integers"
                     : format == SAMPLEFORMAT_IEEEFP ? "floats"
                     : format == SAMPLEFORMAT_UINT   ? "integers"
                                                     : "another type";
  return "samples of " + std::to_string(bits) + " bits (" + kind + ")";
}

VoxelType sample_type(std::uint16_t format, std::uint16_t bits, const std::string& page, VoxelUse use) {
  if (format == SAMPLEFORMAT_UINT || format == SAMPLEFORMAT_VOID) {
    if (bits == 8) return VoxelType::uint8;
    if (bits == 16) return VoxelType::uint16;
    if (bits == 32) return VoxelType::uint32;
    if (bits == 64) return VoxelType::uint64;
  } else if (format == SAMPLEFORMAT_INT) {
    if (bits == 8) return VoxelType::int8;
    if (bits == 16) return VoxelType::int16;
    if (bits == 32) return VoxelType::int32;
    if (bits == 64) return VoxelType::int64;
  } else if (format == SAMPLEFORMAT_IEEEFP) {
    if (bits == 32) return VoxelType::float32;
    if (bits == 64) return VoxelType::float64;
  }
  throw InputError(page + ": " + sample_text(format, bits) + " are not supported; " +
                   numbers_to_save(use, "save the labels as integers of 8, 16 or 32 bits"));
}

}  // namespace

struct TiffFile::Impl {
  explicit Impl(std::string of_path) : path(std::move(of_path)) {
    // libtiff would report missing files and folders in words of its own.
    (void)FileRanges(path);
    const std::unique_ptr<TIFFOpenOptions, decltype(&TIFFOpenOptionsFree)> options(TIFFOpenOptionsAlloc(),
                                                                                   &TIFFOpenOptionsFree);
    if (!options) throw std::bad_alloc();
    TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), max_chunk_bytes);
    TIFFOpenOptionsSetErrorHandlerExtR(options.get(), TiffMessages::take, &messages);
    TIFFOpenOptionsSetWarningHandlerExtR(options.get(), TiffMessages::ignore, nullptr);
    // m: not mapped into memory, where a file that is truncated would end the process; O: lists of strips and
    // tiles are read when needed.
    file = TIFFOpenExt(path.c_str(), "rmO", options.get());
    if (!file) fail(path, "it is not a TIFF file, or it is damaged");
  }
  ~Impl() {
    if (file) TIFFClose(file);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  [[noreturn]] void fail(const std::string& where, const std::string& what) const {
    throw InputError(where + ": " + what + (messages.first.empty() ? "" : " (" + messages.first + ")") +
                     "; copy or export the file again");
  }

  std::string path;
  TiffMessages messages;
  TIFF* file = nullptr;
};

TiffFile::TiffFile(const std::string& path) : impl_(std::make_unique<Impl>(path)) {}
TiffFile::~TiffFile() = default;
TiffFile::TiffFile(TiffFile&&) noexcept = default;

bool TiffFile::next() {
  impl_->messages.first.clear();
  if (TIFFReadDirectory(impl_->file) == 1) return true;
  if (!impl_->messages.first.empty()) impl_->fail(impl_->path, "a page is damaged");
  return false;
}

std::uint64_t TiffFile::offset() const { return TIFFCurrentDirOffset(impl_->file); }

void TiffFile::go_to(std::uint64_t offset) {
  if (this->offset() == offset) return;
  impl_->messages.first.clear();
  if (TIFFSetSubDirectory(impl_->file, offset) != 1) impl_->fail(impl_->path, "a page is damaged");
}

TiffPage TiffFile::page(const std::string& page, VoxelUse use) const {
  TIFF* file = impl_->file;
  TiffPage shape;
  shape.width = field<std::uint32_t>(file, TIFFTAG_IMAGEWIDTH, 0);
  shape.height = field<std::uint32_t>(file, TIFFTAG_IMAGELENGTH, 0);
  if (shape.width == 0 || shape.height == 0) impl_->fail(page, "it has no pixels");
  const auto samples = field<std::uint16_t>(file, TIFFTAG_SAMPLESPERPIXEL, 1);
  const auto colours = field<std::uint16_t>(file, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  if (samples != 1 || (colours != PHOTOMETRIC_MINISBLACK && colours != PHOTOMETRIC_MINISWHITE &&
                       colours != PHOTOMETRIC_PALETTE))
    throw InputError(page + ": it has " + std::to_string(samples) +
                     " samples for each pixel, or colours; save " +
                     (use == VoxelUse::labels ? "the labels as a grey image of one channel"
                                              : "each channel as a grey image in pages of its own"));
  if (const auto turn = field<std::uint16_t>(file, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
      turn != ORIENTATION_TOPLEFT)
    throw InputError(page + ": its orientation is " + std::to_string(turn) +
                     ", and only 1 (first row on top, first column left) is supported; save it again");
  shape.type = sample_type(field<std::uint16_t>(file, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT),
                           field<std::uint16_t>(file, TIFFTAG_BITSPERSAMPLE, 1), page, use);
  shape.tiled = TIFFIsTiled(file) != 0;
  if (shape.tiled) {
    shape.piece_width = field<std::uint32_t>(file, TIFFTAG_TILEWIDTH, 0);
    shape.piece_height = field<std::uint32_t>(file, TIFFTAG_TILELENGTH, 0);
  } else {
    shape.piece_width = shape.width;
    shape.piece_height =
        std::min(field<std::uint32_t>(file, TIFFTAG_ROWSPERSTRIP, shape.height), shape.height);
  }
  const std::int64_t piece[] = {shape.piece_width, shape.piece_height};
  (void)checked_chunk_bytes(piece, voxel_bytes(shape.type), page);
  return shape;
}

TiffDescription TiffFile::description() const {
  TIFF* file = impl_->file;
  TiffDescription out;
  if (const char* text = nullptr; TIFFGetField(file, TIFFTAG_IMAGEDESCRIPTION, &text) == 1 && text)
    out.text = text;
  out.resolution_x = static_cast<double>(field<float>(file, TIFFTAG_XRESOLUTION, 0));
  out.resolution_y = static_cast<double>(field<float>(file, TIFFTAG_YRESOLUTION, 0));
  constexpr double inch_mm = 25.4, centimetre_mm = 10;
  const auto unit = field<std::uint16_t>(file, TIFFTAG_RESOLUTIONUNIT, RESUNIT_NONE);
  out.unit_mm = unit == RESUNIT_INCH ? inch_mm : unit == RESUNIT_CENTIMETER ? centimetre_mm : 0;
  out.compressed = field<std::uint16_t>(file, TIFFTAG_COMPRESSION, COMPRESSION_NONE) != COMPRESSION_NONE;
  out.big_endian = TIFFIsBigEndian(file) != 0;
  if (!TIFFIsTiled(file)) out.first_offset = TIFFGetStrileOffset(file, 0);
  return out;
}

void TiffFile::read_piece(bool tile, std::uint32_t number, char* to, std::size_t bytes,
                          const std::string& page) const {
  impl_->messages.first.clear();
  const auto wanted = static_cast<tmsize_t>(bytes);
  const tmsize_t got = tile ? TIFFReadEncodedTile(impl_->file, number, to, wanted)
                            : TIFFReadEncodedStrip(impl_->file, number, to, wanted);
  if (got != wanted)
    impl_->fail(page,
                std::string(tile ? "tile " : "strip ") + std::to_string(number) + " is damaged or truncated");
}

}  // namespace tetwright
