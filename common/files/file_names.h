// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace tetwright {

/// Extension in lower case; .nii.gz and .inr.gz count as one extension.
std::string extension_of(const std::string& path);
/// Replaces the extension of `path`, in upper case if the old one is.
std::string with_extension(const std::string& path, std::string extension);

}  // namespace tetwright
