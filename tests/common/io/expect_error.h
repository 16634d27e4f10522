// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <type_traits>

#include "tetwright/error.h"

namespace tetwright {

/// Expects that `call` throws an error of type E and returns its message, which must be one line of ASCII.
template <class E, class Call>
std::string error_of(const Call& call) {
  try {
    call();
  } catch (const E& error) {
    std::string message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    for (char c : message) EXPECT_TRUE(c >= ' ' && c <= '~') << message;
    return message;
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

/// Expects that reading `text` as file "f" throws an InputError whose message contains both texts.
template <class Read>
void expect_input_error(const Read& read, std::string_view text, const std::string& first,
                        const std::string& second = "") {
  const std::string message = error_of<InputError>([&] {
    if constexpr (std::is_invocable_v<const Read&, std::string_view, const char*>)
      (void)read(text, "f");
    else
      (void)read(text, "f", {});
  });
  EXPECT_EQ(message.substr(0, 3), "f: ") << message;
  EXPECT_NE(message.find(first), std::string::npos) << message;
  EXPECT_NE(message.find(second), std::string::npos) << message;
}

}  // namespace tetwright
