# SPDX-License-Identifier: Apache-2.0
# Defines the target tetwright::scotch, for the build and for users of the installed library: the serial library of
# Scotch, which is under CeCILL-C and therefore always linked as a shared library. Debian's package has no CMake configuration.
if(NOT TARGET tetwright::scotch)
  find_path(TETWRIGHT_SCOTCH_INCLUDE scotch.h PATH_SUFFIXES scotch scotch-int32 REQUIRED)
  find_library(TETWRIGHT_SCOTCH_LIBRARY NAMES libscotch.so libscotch.dylib REQUIRED)
  find_library(TETWRIGHT_SCOTCHERR_LIBRARY NAMES libscotcherr.so libscotcherr.dylib REQUIRED)
  mark_as_advanced(TETWRIGHT_SCOTCH_INCLUDE TETWRIGHT_SCOTCH_LIBRARY TETWRIGHT_SCOTCHERR_LIBRARY)
  add_library(tetwright::scotch UNKNOWN IMPORTED GLOBAL)
  set_target_properties(tetwright::scotch PROPERTIES
    IMPORTED_LOCATION "${TETWRIGHT_SCOTCH_LIBRARY}"
    INTERFACE_LINK_LIBRARIES "${TETWRIGHT_SCOTCHERR_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${TETWRIGHT_SCOTCH_INCLUDE}")
endif()
