// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace tetwright {

/// Minimum number of insertions, deletions, replacements and swaps of adjacent characters that turn one word
/// into the other (optimal string alignment, Damerau 1964). Time and memory are proportional to the product
/// of the lengths.
std::size_t typing_errors(std::string_view a, std::string_view b);

/// First of the words with the fewest typing errors; empty if there are no words.
std::string nearest_word(std::string_view typed, std::span<const std::string> words);

}  // namespace tetwright
