# SPDX-License-Identifier: Apache-2.0
# Defines the target tetwright::parallel_hdf5, the build of HDF5 for MPI, or sets without_parallel_hdf5 to the reason why
# it cannot be used.
#
# It has the same interface as the build that the libraries are compiled for, beside which Debian installs it, and other
# symbol versions. Programs link it before that one, and so take all functions of HDF5 from it.
if("${MPI_C_INCLUDE_DIRS}" MATCHES mpich)
  set(hdf5_build mpich)
else()
  set(hdf5_build openmpi)
endif()
find_path(TETWRIGHT_PARALLEL_HDF5_INCLUDE hdf5.h PATHS /usr/include/hdf5/${hdf5_build} NO_DEFAULT_PATH)
find_library(TETWRIGHT_PARALLEL_HDF5_LIBRARY hdf5_${hdf5_build})
mark_as_advanced(TETWRIGHT_PARALLEL_HDF5_INCLUDE TETWRIGHT_PARALLEL_HDF5_LIBRARY)

# Sets `out` to what a line of a header defines as `name`.
function(tetwright_defined_in header name out)
  file(STRINGS "${header}" line REGEX "^#define +${name} ")
  string(REGEX REPLACE "^#define +${name} +" "" value "${line}")
  set(${out} "${value}" PARENT_SCOPE)
endfunction()

# Sets `out` to the names after `tag` in the dynamic section of a library, or to nothing if they cannot be read.
function(tetwright_dynamic_names library tag out)
  execute_process(COMMAND "${CMAKE_OBJDUMP}" -p "${library}" OUTPUT_VARIABLE headers ERROR_QUIET)
  string(REGEX MATCHALL "${tag} +[^ \n]+" lines "${headers}")
  list(TRANSFORM lines REPLACE "^${tag} +" "")
  set(${out} "${lines}" PARENT_SCOPE)
endfunction()

set(without_parallel_hdf5 "")
if(NOT TETWRIGHT_PARALLEL_HDF5_INCLUDE OR NOT TETWRIGHT_PARALLEL_HDF5_LIBRARY)
  set(without_parallel_hdf5 "it is not installed (Debian: libhdf5-${hdf5_build}-dev)")
elseif(BUILD_SHARED_LIBS)
  set(without_parallel_hdf5 "shared libraries of Tetwright take HDF5 from its build without MPI")
else()
  tetwright_defined_in("${TETWRIGHT_HDF5_INCLUDE}/H5public.h" H5_VERS_INFO serial_version)
  tetwright_defined_in("${TETWRIGHT_PARALLEL_HDF5_INCLUDE}/H5public.h" H5_VERS_INFO parallel_version)
  tetwright_defined_in("${TETWRIGHT_PARALLEL_HDF5_INCLUDE}/H5pubconf.h" H5_HAVE_PARALLEL has_mpi)
  tetwright_dynamic_names("${TETWRIGHT_PARALLEL_HDF5_LIBRARY}" NEEDED needed)
  set(with_this_mpi FALSE)
  foreach(library IN LISTS MPI_C_LIBRARIES)
    tetwright_dynamic_names("${library}" SONAME name)
    if(name AND name IN_LIST needed)
      set(with_this_mpi TRUE)
    endif()
  endforeach()
  if(NOT has_mpi)
    set(without_parallel_hdf5 "${TETWRIGHT_PARALLEL_HDF5_INCLUDE} is that of a build without MPI")
  elseif(NOT serial_version STREQUAL parallel_version)
    set(without_parallel_hdf5 "its ${parallel_version} is not the ${serial_version} of the build without MPI")
  elseif(NOT with_this_mpi)
    set(without_parallel_hdf5 "${TETWRIGHT_PARALLEL_HDF5_LIBRARY} is not built for ${MPI_C_LIBRARIES}")
  endif()
endif()

if(NOT without_parallel_hdf5 AND NOT TARGET tetwright::parallel_hdf5)
  add_library(tetwright::parallel_hdf5 UNKNOWN IMPORTED GLOBAL)
  set_target_properties(tetwright::parallel_hdf5 PROPERTIES
    IMPORTED_LOCATION "${TETWRIGHT_PARALLEL_HDF5_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${TETWRIGHT_PARALLEL_HDF5_INCLUDE}")
endif()
