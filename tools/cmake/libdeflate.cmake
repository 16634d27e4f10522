# SPDX-License-Identifier: Apache-2.0
# Defines the target tetwright::libdeflate, for the build and for users of the installed library: Debian's
# package has no CMake configuration.
if(NOT TARGET tetwright::libdeflate)
  find_path(TETWRIGHT_LIBDEFLATE_INCLUDE libdeflate.h REQUIRED)
  find_library(TETWRIGHT_LIBDEFLATE_LIBRARY deflate REQUIRED)
  mark_as_advanced(TETWRIGHT_LIBDEFLATE_INCLUDE TETWRIGHT_LIBDEFLATE_LIBRARY)
  add_library(tetwright::libdeflate UNKNOWN IMPORTED GLOBAL)
  set_target_properties(tetwright::libdeflate PROPERTIES
    IMPORTED_LOCATION "${TETWRIGHT_LIBDEFLATE_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${TETWRIGHT_LIBDEFLATE_INCLUDE}")
endif()
