// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/data_file.h"

#include <filesystem>

#include "common/io/encodings/file_ranges.h"
#include "common/io/encodings/vtk_numbers.h"
#include "common/io/text/text_scanner.h"
#include "common/lower_case.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

[[noreturn]] void fail_unreadable(const HeaderFields& header, const std::string& field,
                                  const InputError& error) {
  header.fail(field,
              std::string("the file with the voxels: ") + error.what() + "; put it where the header says");
}

}  // namespace

std::string data_file_path(const HeaderFields& header, const std::string& field) {
  const std::string_view named = header.text(field);
  if (named.empty()) header.fail(field, field + " names no file");
  const std::vector<std::string_view> words = header.words(field);
  if (lower_case(words[0]) == "list" || (words.size() > 2 && words[0].find('%') != std::string_view::npos))
    header.fail(field, "voxels in several files (" + in_quotes(named) +
                           ") are not supported; save the volume as one file");
  // The name may contain anything, but the message must be one line of text.
  for (const char c : named)
    if (static_cast<unsigned char>(c) < ' ') header.fail(field, in_quotes(named) + " is not a file name");
  return (std::filesystem::path(header.file()).parent_path() / std::string(named)).string();
}

std::uint64_t data_file_size(const HeaderFields& header, const std::string& field) {
  const std::string path = data_file_path(header, field);
  try {
    return FileRanges(path).size();
  } catch (const InputError& error) {
    fail_unreadable(header, field, error);
  }
}

DataFile read_data_file(const HeaderFields& header, const std::string& field, const FileReader& read) {
  DataFile data;
  data.path = data_file_path(header, field);
  try {
    data.bytes = read(data.path);
  } catch (const InputError& error) {
    fail_unreadable(header, field, error);
  }
  return data;
}

}  // namespace tetwright
