// SPDX-License-Identifier: Apache-2.0
#include "common/files/file_names.h"

#include <cctype>
#include <filesystem>

#include "common/lower_case.h"

namespace tetwright {

std::string extension_of(const std::string& path) {
  const std::string name = lower_case(std::filesystem::path(path).filename().string());
  for (const char* compound : {".nii.gz", ".inr.gz"})
    if (name.ends_with(compound) && name != compound) return compound;
  return std::filesystem::path(name).extension().string();
}

std::string with_extension(const std::string& path, std::string extension) {
  const std::string own = std::filesystem::path(path).extension().string();
  if (own.size() > 1 && std::isupper(static_cast<unsigned char>(own[1])))
    for (char& c : extension) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return std::filesystem::path(path).replace_extension().string() + extension;
}

}  // namespace tetwright
