// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <type_traits>

#include "common/number_text.h"
#include "tetwright/files.h"

namespace tetwright {

/// Buffers text for a file and passes it to a sink in pieces of about a megabyte.
class TextWriter {
 public:
  /// `sink` must outlive this object.
  explicit TextWriter(const ByteSink& sink) : sink_(sink) {}
  TextWriter(const TextWriter&) = delete;
  TextWriter& operator=(const TextWriter&) = delete;

  /// Appends text, or a number as append_number() formats it.
  template <class Value>
  TextWriter& operator<<(const Value& value) {
    if constexpr (std::is_same_v<Value, char>)
      text_ += value;
    else if constexpr (std::is_arithmetic_v<Value>)
      append_number(text_, value);
    else
      text_ += std::string_view(value);
    if (text_.size() >= piece_size) flush();
    return *this;
  }

  /// Passes the rest to the sink; call it at the end.
  void flush() {
    sink_(text_);
    text_.clear();
  }

 private:
  static constexpr std::size_t piece_size = std::size_t{1} << 20;

  const ByteSink& sink_;
  std::string text_;
};

}  // namespace tetwright
