# SPDX-License-Identifier: Apache-2.0
# Defines the target tetwright::netcdf if the C library of netCDF is there, for the build and for users of the installed
# library. Its own package file asks for libraries that are linked only statically.
if(NOT TARGET tetwright::netcdf)
  find_path(TETWRIGHT_NETCDF_INCLUDE netcdf_mem.h)
  find_library(TETWRIGHT_NETCDF_LIBRARY netcdf)
  mark_as_advanced(TETWRIGHT_NETCDF_INCLUDE TETWRIGHT_NETCDF_LIBRARY)
  if(TETWRIGHT_NETCDF_INCLUDE AND TETWRIGHT_NETCDF_LIBRARY)
    add_library(tetwright::netcdf UNKNOWN IMPORTED GLOBAL)
    set_target_properties(tetwright::netcdf PROPERTIES
      IMPORTED_LOCATION "${TETWRIGHT_NETCDF_LIBRARY}"
      INTERFACE_INCLUDE_DIRECTORIES "${TETWRIGHT_NETCDF_INCLUDE}")
  endif()
endif()
