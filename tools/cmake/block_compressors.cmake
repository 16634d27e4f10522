# SPDX-License-Identifier: Apache-2.0
# Defines the target tetwright::block_compressors, liblz4, liblzma, libzstd and libblosc, for the build and for users of the installed
# library: Debian's packages have no CMake configuration.
if(NOT TARGET tetwright::block_compressors)
  add_library(tetwright::block_compressors INTERFACE IMPORTED GLOBAL)
  foreach(name lz4 lzma zstd blosc)
    string(TOUPPER ${name} upper)
    find_path(TETWRIGHT_${upper}_INCLUDE ${name}.h REQUIRED)
    find_library(TETWRIGHT_${upper}_LIBRARY ${name} REQUIRED)
    mark_as_advanced(TETWRIGHT_${upper}_INCLUDE TETWRIGHT_${upper}_LIBRARY)
    target_include_directories(tetwright::block_compressors INTERFACE "${TETWRIGHT_${upper}_INCLUDE}")
    target_link_libraries(tetwright::block_compressors INTERFACE "${TETWRIGHT_${upper}_LIBRARY}")
  endforeach()
endif()
