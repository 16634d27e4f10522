// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/data_file.h"

#include <filesystem>

#include "common/io/encodings/vtk_numbers.h"
#include "common/io/text/text_scanner.h"
#include "common/lower_case.h"
#include "tetwright/error.h"

namespace tetwright {

DataFile read_data_file(const HeaderFields& header, const std::string& field, const FileReader& read) {
  const std::string_view named = header.text(field);
  if (named.empty()) header.fail(field, field + " names no file");
  const std::vector<std::string_view> words = header.words(field);
  if (lower_case(words[0]) == "list" || (words.size() > 2 && words[0].find('%') != std::string_view::npos))
    header.fail(field, "voxels in several files (" + in_quotes(named) +
                           ") are not supported; save the volume as one file");
  // The name may contain anything, but the message must be one line of text.
  for (const char c : named)
    if (static_cast<unsigned char>(c) < ' ') header.fail(field, in_quotes(named) + " is not a file name");
  DataFile data;
  data.path = (std::filesystem::path(header.file()).parent_path() / std::string(named)).string();
  try {
    data.bytes = read(data.path);
  } catch (const InputError& error) {
    header.fail(field,
                std::string("the file with the voxels: ") + error.what() + "; put it where the header says");
  }
  return data;
}

}  // namespace tetwright
