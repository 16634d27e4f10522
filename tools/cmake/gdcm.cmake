# SPDX-License-Identifier: Apache-2.0
# Defines the target tetwright::gdcm if GDCM is there, for the build and for users of the installed library. GDCM's own
# package file asks for parts that are not needed.
if(NOT TARGET tetwright::gdcm)
  find_path(TETWRIGHT_GDCM_INCLUDE gdcmJPEGCodec.h PATH_SUFFIXES gdcm-3.0)
  set(tetwright_gdcm_libraries)
  foreach(part MSFF DSED DICT Common)
    find_library(TETWRIGHT_GDCM_${part} gdcm${part})
    mark_as_advanced(TETWRIGHT_GDCM_${part})
    list(APPEND tetwright_gdcm_libraries ${TETWRIGHT_GDCM_${part}})
  endforeach()
  mark_as_advanced(TETWRIGHT_GDCM_INCLUDE)
  if(TETWRIGHT_GDCM_INCLUDE AND TETWRIGHT_GDCM_MSFF AND TETWRIGHT_GDCM_DSED AND TETWRIGHT_GDCM_DICT AND TETWRIGHT_GDCM_Common)
    add_library(tetwright::gdcm INTERFACE IMPORTED GLOBAL)
    set_target_properties(tetwright::gdcm PROPERTIES
      INTERFACE_LINK_LIBRARIES "${tetwright_gdcm_libraries}"
      INTERFACE_INCLUDE_DIRECTORIES "${TETWRIGHT_GDCM_INCLUDE}")
  endif()
endif()
