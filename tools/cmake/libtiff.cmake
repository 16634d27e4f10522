# SPDX-License-Identifier: Apache-2.0
# Defines the target tetwright::libtiff, for the build and for users of the installed library. Options of single files
# (TIFFOpenOptions) came with libtiff 4.5.
if(NOT TARGET tetwright::libtiff)
  find_path(TETWRIGHT_LIBTIFF_INCLUDE tiffio.h REQUIRED)
  find_library(TETWRIGHT_LIBTIFF_LIBRARY tiff REQUIRED)
  mark_as_advanced(TETWRIGHT_LIBTIFF_INCLUDE TETWRIGHT_LIBTIFF_LIBRARY)
  add_library(tetwright::libtiff UNKNOWN IMPORTED GLOBAL)
  set_target_properties(tetwright::libtiff PROPERTIES
    IMPORTED_LOCATION "${TETWRIGHT_LIBTIFF_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${TETWRIGHT_LIBTIFF_INCLUDE}")
endif()
