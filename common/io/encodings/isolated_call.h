// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <string>

#include "common/io/encodings/file_ranges.h"

namespace tetwright {

/// Result of a call in a process of its own.
struct IsolatedResult {
  bool done = false;  ///< the call returned true
  ByteBuffer bytes;   ///< that it wrote
  std::string text;   ///< first line that it printed on standard error
};

/// Calls a decoder in a child process, so that its assertions and crashes on damaged data end that process
/// alone, its messages are not printed, and a call that takes minutes is ended. May be called concurrently.
/// \param bytes size of the buffer that `call` fills
/// \param call must not use threads, nor locks that other threads may hold at the time of the call
/// \throws OutputError if there is no memory for another process
IsolatedResult call_isolated(std::size_t bytes, const std::function<bool(std::span<char>)>& call);

}  // namespace tetwright
