# SPDX-License-Identifier: Apache-2.0
# Defines the target tetwright::hdf5, for the build and for users of the installed library: the C library of HDF5 without
# MPI, which Debian installs in a separate folder.
if(NOT TARGET tetwright::hdf5)
  find_path(TETWRIGHT_HDF5_INCLUDE hdf5.h PATH_SUFFIXES hdf5/serial REQUIRED)
  find_library(TETWRIGHT_HDF5_LIBRARY NAMES hdf5_serial hdf5 REQUIRED)
  mark_as_advanced(TETWRIGHT_HDF5_INCLUDE TETWRIGHT_HDF5_LIBRARY)
  add_library(tetwright::hdf5 UNKNOWN IMPORTED GLOBAL)
  set_target_properties(tetwright::hdf5 PROPERTIES
    IMPORTED_LOCATION "${TETWRIGHT_HDF5_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${TETWRIGHT_HDF5_INCLUDE}")
endif()
