# SPDX-License-Identifier: Apache-2.0
# Defines the target tetwright::libzip, for the build and for users of the installed library: the CMake
# configuration in Debian's package requires libzip's programs, which are in other packages.
if(NOT TARGET tetwright::libzip)
  find_path(TETWRIGHT_LIBZIP_INCLUDE zip.h REQUIRED)
  find_library(TETWRIGHT_LIBZIP_LIBRARY zip REQUIRED)
  mark_as_advanced(TETWRIGHT_LIBZIP_INCLUDE TETWRIGHT_LIBZIP_LIBRARY)
  add_library(tetwright::libzip UNKNOWN IMPORTED GLOBAL)
  set_target_properties(tetwright::libzip PROPERTIES
    IMPORTED_LOCATION "${TETWRIGHT_LIBZIP_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${TETWRIGHT_LIBZIP_INCLUDE}")
endif()
