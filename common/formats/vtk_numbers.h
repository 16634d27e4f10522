#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/formats/text_scanner.h"

namespace tetwright {

/// `word` in lower case: keywords of legacy VTK files are written either way.
std::string lower_case(std::string_view word);

/// Is `type` (lower case) a whole number, of those read_vtk_numbers() knows?
bool is_integer_type(const std::string& type);

/// Reads `n` numbers of a legacy VTK file: words, or big-endian bytes from the next line on. `type` is the
/// word of the file in lower case ("float", "vtktypeint64"). Throws InputError if it is unknown or the file
/// is too short for `n`, before memory is reserved. Value: double or std::int64_t, which takes no fractions.
template <class Value>
std::vector<Value> read_vtk_numbers(TextScanner& in, bool binary, const std::string& type, std::size_t n,
                                    const std::string& what);

/// Drops `n` strings: lines, or bytes with their length before them.
void skip_vtk_strings(TextScanner& in, bool binary, std::size_t n);

}  // namespace tetwright
