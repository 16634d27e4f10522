// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace tetwright {

/// The extension in lower case; .nii.gz and .inr.gz count as one extension.
std::string extension_of(const std::string& path);
/// `path` with something else in place of its extension, in upper case if that is.
std::string with_extension(const std::string& path, std::string extension);

}  // namespace tetwright
