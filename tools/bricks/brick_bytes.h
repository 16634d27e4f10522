// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "tools/bricks/brick_part.h"
#include "tools/bricks/regrouped_bricks.h"

namespace tetwright {

/// Number of the layout of these bytes, and of what they mean: a higher one with each change.
inline constexpr int brick_format = 2;

/// The bytes of a part, for files and messages of the same version of the program on machines of the same
/// byte order: compressed by zstd, with its checksum.
/// \throws OutputError if the memory does not suffice
std::string to_bytes(const BrickPart& part);

/// Restores a part.
/// \param name where the bytes come from, for messages
/// \throws InputError if they are damaged or incomplete
BrickPart brick_part(std::string_view bytes, const std::string& name);

/// Everything that another process with the same input and options needs to make a brick.
struct BrickRequest {
  BrickTask task;
  BrickPieces pieces;  ///< none in the first round
};

/// Likewise, for messages alone.
std::string to_bytes(const BrickRequest& request);
BrickRequest brick_request(std::string_view bytes, const std::string& name);

}  // namespace tetwright
