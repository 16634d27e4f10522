// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/io/text/text_scanner.h"

namespace tetwright {

/// Whether `type` is an integer type.
/// \param type in lower case, known to read_vtk_numbers()
bool is_integer_type(const std::string& type);

/// Reads `n` numbers of a legacy VTK file: words, or big-endian bytes that begin on the next line. `Value` is
/// double or std::int64_t.
/// \param type type name in the file, in lower case ("float", "vtktypeint64")
/// \throws InputError if the type is unknown, if a number is not whole although std::int64_t is requested, or
///   if the file is too short for `n` numbers (checked before memory is allocated)
template <class Value>
std::vector<Value> read_vtk_numbers(TextScanner& in, bool binary, const std::string& type, std::size_t n,
                                    const std::string& what);

/// Skips `n` strings: lines in a text file, in a binary file bytes preceded by their count.
void skip_vtk_strings(TextScanner& in, bool binary, std::size_t n);

}  // namespace tetwright
