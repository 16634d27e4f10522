// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/dicom_codecs.h"

#include <cstring>
#include <memory>

#include "common/message_text.h"
#include "tetwright/error.h"

#ifdef TETWRIGHT_WITH_GDCM
#include <gdcmByteValue.h>
#include <gdcmDataElement.h>
#include <gdcmFragment.h>
#include <gdcmJPEG2000Codec.h>
#include <gdcmJPEGCodec.h>
#include <gdcmJPEGLSCodec.h>
#include <gdcmRLECodec.h>
#include <gdcmSequenceOfFragments.h>
#include <gdcmTrace.h>
#include <gdcmTransferSyntax.h>

#include <span>
#include <sstream>
#include <utility>

#include "common/io/encodings/isolated_call.h"
#endif

namespace tetwright {

#ifdef TETWRIGHT_WITH_GDCM

namespace {

std::unique_ptr<gdcm::ImageCodec> codec_of(const gdcm::TransferSyntax& syntax, std::size_t bytes) {
  std::unique_ptr<gdcm::ImageCodec> codec;
  if (auto rle = std::make_unique<gdcm::RLECodec>(); rle->CanDecode(syntax)) {
    rle->SetLength(static_cast<unsigned long>(bytes));
    rle->SetBufferLength(static_cast<unsigned long>(bytes));
    return rle;
  }
  if (auto jpeg_ls = std::make_unique<gdcm::JPEGLSCodec>(); jpeg_ls->CanDecode(syntax)) {
    jpeg_ls->SetBufferLength(static_cast<unsigned long>(bytes));
    return jpeg_ls;
  }
  if (codec = std::make_unique<gdcm::JPEGCodec>(); codec->CanDecode(syntax)) return codec;
  if (codec = std::make_unique<gdcm::JPEG2000Codec>(); codec->CanDecode(syntax)) return codec;
  return nullptr;
}

/// Decodes a frame.
/// \return false if it is damaged, or has another size
bool decode(const gdcm::TransferSyntax& syntax, const DicomFrameShape& shape,
            const std::vector<ByteBuffer>& fragments, std::span<char> out) {
  gdcm::Trace::WarningOff();
  gdcm::Trace::ErrorOff();
  const unsigned int size[] = {static_cast<unsigned int>(shape.columns),
                               static_cast<unsigned int>(shape.rows), 1};
  const gdcm::PixelFormat format(1, static_cast<unsigned short>(shape.bits_allocated),
                                 static_cast<unsigned short>(shape.bits_stored),
                                 static_cast<unsigned short>(shape.bits_stored - 1), shape.is_signed ? 1 : 0);
  const gdcm::SmartPointer<gdcm::SequenceOfFragments> sequence = gdcm::SequenceOfFragments::New();
  for (const ByteBuffer& bytes : fragments) {
    gdcm::Fragment fragment;
    fragment.SetByteValue(bytes.data.get(), static_cast<std::uint32_t>(bytes.size));
    sequence->AddFragment(fragment);
  }
  gdcm::DataElement from(gdcm::Tag(0x7fe0, 0x0010), 0, gdcm::VR::OB), to;
  from.SetValue(*sequence);
  // Decoders trust the size in the header of the compressed pixels.
  const std::unique_ptr<gdcm::ImageCodec> header = codec_of(syntax, out.size());
  if (fragments.size() == 1 && !dynamic_cast<gdcm::RLECodec*>(header.get())) {
    header->SetPixelFormat(format);
    std::istringstream stream(std::string(fragments.front().view()));
    gdcm::TransferSyntax found;
    if (!header->GetHeaderInfo(stream, found)) return false;
    const unsigned int* n = header->GetDimensions();
    if (n[0] != size[0] || n[1] != size[1] || header->GetPixelFormat().GetSamplesPerPixel() != 1)
      return false;
  }
  const std::unique_ptr<gdcm::ImageCodec> codec = codec_of(syntax, out.size());
  codec->SetNumberOfDimensions(2);
  codec->SetDimensions(size);
  codec->SetPlanarConfiguration(0);
  codec->SetPhotometricInterpretation(gdcm::PhotometricInterpretation::MONOCHROME2);
  codec->SetPixelFormat(format);  // last: that of JPEG makes a decoder with what was set before
  if (!codec->Decode(from, to)) return false;
  const gdcm::ByteValue* value = to.GetByteValue();
  // Values may be padded to an even number of bytes.
  if (!value || (value->GetLength() != out.size() && value->GetLength() != out.size() + out.size() % 2))
    return false;
  std::memcpy(out.data(), value->GetPointer(), out.size());
  return true;
}

}  // namespace

ByteBuffer decode_dicom_frame(const std::string& transfer_syntax, const DicomFrameShape& shape,
                              const std::vector<ByteBuffer>& fragments, const std::string& name) {
  const std::size_t bytes = static_cast<std::size_t>(shape.columns) * static_cast<std::size_t>(shape.rows) *
                            static_cast<std::size_t>(shape.bits_allocated / 8);
  const gdcm::TransferSyntax syntax(gdcm::TransferSyntax::GetTSType(transfer_syntax.c_str()));
  if (!codec_of(syntax, bytes))
    throw InputError(name, 0,
                     "its pixels have the transfer syntax " + in_quotes(transfer_syntax) +
                         ", which is not supported; convert it, for example by gdcmconv --raw");
  IsolatedResult result =
      call_isolated(bytes, [&](std::span<char> out) { return decode(syntax, shape, fragments, out); });
  // Decoders of JPEG fill up what is missing, and only print that.
  if (!result.done || !result.text.empty())
    throw InputError(name, 0,
                     "its compressed pixels are damaged" +
                         (result.text.empty() || !result.done ? "" : " (" + printable(result.text) + ")") +
                         "; copy or export it again");
  return std::move(result.bytes);
}

#else

ByteBuffer decode_dicom_frame(const std::string& transfer_syntax, const DicomFrameShape& /*shape*/,
                              const std::vector<ByteBuffer>& /*fragments*/, const std::string& name) {
  throw InputError(name, 0,
                   "its pixels are compressed (transfer syntax " + in_quotes(transfer_syntax) +
                       "), and Tetwright was built without GDCM, which decompresses them; convert it, for "
                       "example by gdcmconv --raw");
}

#endif

}  // namespace tetwright
