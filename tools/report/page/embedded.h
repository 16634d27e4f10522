// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace tetwright::embedded {

// The sources of the page, which the build puts into the program (see embed.cmake).
extern const std::string_view page_html, page_css, mesh_js, view_js, page_js;
/// Debian's libjs-three, a script that defines THREE.
extern const std::string_view three_js;

}  // namespace tetwright::embedded
