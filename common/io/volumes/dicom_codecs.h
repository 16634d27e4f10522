// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/io/encodings/file_ranges.h"

namespace tetwright {

/// Pixels of one frame, for the decoders.
struct DicomFrameShape {
  int columns = 0, rows = 0;
  int bits_allocated = 0, bits_stored = 0;
  bool is_signed = false;
};

/// Decompresses a frame by GDCM: JPEG, JPEG-LS, JPEG 2000 and RLE. May be called concurrently. GDCM is run in
/// a process of its own, since Debian's has assertions that damaged data violate.
/// \param fragments of the frame
/// \param name file for messages
/// \return pixels with their allocated bits in this machine's byte order
/// \throws InputError if the transfer syntax is unknown, the fragments are damaged or have another size, or
///   Tetwright was built without GDCM
ByteBuffer decode_dicom_frame(const std::string& transfer_syntax, const DicomFrameShape& shape,
                              const std::vector<ByteBuffer>& fragments, const std::string& name);

}  // namespace tetwright
