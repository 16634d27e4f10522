// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace tetwright {

/// The number of typing errors that turn one word into the other: characters inserted, removed or replaced,
/// and neighbours swapped (optimal string alignment, Damerau 1964). Takes time and memory in proportion to
/// the product of the lengths.
std::size_t typing_errors(std::string_view a, std::string_view b);

/// The word with the fewest typing errors, the first of several; empty if there are no words.
std::string nearest_word(std::string_view typed, std::span<const std::string> words);

}  // namespace tetwright
