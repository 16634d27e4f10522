# SPDX-License-Identifier: Apache-2.0
# Compiler options of the project's targets.

# Options of all targets.
add_library(tetwright_options INTERFACE)
# Internal and public headers, for programs that compile sources of the libraries.
target_include_directories(tetwright_options INTERFACE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/common/include
  ${PROJECT_SOURCE_DIR}/simplify/include ${PROJECT_SOURCE_DIR}/mesher/include)
target_compile_options(tetwright_options INTERFACE
  -Wall -Wextra -Wnon-virtual-dtor -Wconversion -Wno-sign-conversion
  # g++ 12 wrongly reports overlapping and overlong copies in std::string (GCC bug 105651).
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict$<SEMICOLON>-Wno-stringop-overflow$<SEMICOLON>-Wno-stringop-overread$<SEMICOLON>-Wno-array-bounds>
  # No implicit fused multiply-add, so that results have the same bytes on every machine.
  -ffp-contract=off)
if(NOT TETWRIGHT_UNITY)
  target_compile_options(tetwright_options INTERFACE -Wshadow)  # in a unity build it would warn about names in other files
else()
  # g++ treats the source files as headers, in which anonymous namespaces would be an error.
  target_compile_options(tetwright_options INTERFACE
    $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess$<SEMICOLON>-Wno-subobject-linkage> "$<$<CXX_COMPILER_ID:Clang>:SHELL:-Xclang -fno-pch-timestamp>")
endif()
if(TETWRIGHT_WARNINGS_AS_ERRORS)
  target_compile_options(tetwright_options INTERFACE -Werror)
endif()
if(TETWRIGHT_SANITIZE)
  target_compile_options(tetwright_options INTERFACE
    -fsanitize=${TETWRIGHT_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all
    # g++ reports possibly uninitialised values in instrumented code of its own library, and has no ignore list.
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized$<SEMICOLON>-fno-sanitize=alignment>
    $<$<CXX_COMPILER_ID:Clang>:-fsanitize-ignorelist=${PROJECT_SOURCE_DIR}/tests/sanitize_ignorelist.txt>)
  target_link_options(tetwright_options INTERFACE -fsanitize=${TETWRIGHT_SANITIZE})
endif()

# tetwright_compile_together(TARGET BATCH [GROUP [HEADER...]]): compiles BATCH files of the target at a time (0: all),
# with a precompiled header shared by the targets of a GROUP. All targets of a group must be compiled with the same
# options; the first one creates the header. Most of the compile time is spent on headers and templates that the files of
# a folder share. Names in anonymous namespaces must therefore be unique within a target. Does nothing without
# TETWRIGHT_UNITY.
function(tetwright_compile_together target batch)
  if(NOT TETWRIGHT_UNITY)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${batch}
    # Otherwise each shared library defines a different macro, which makes the header invalid for the others.
    DEFINE_SYMBOL "")
  if(ARGC EQUAL 2)
    return()
  endif()
  set(headers ${ARGN})
  list(POP_FRONT headers group)
  set(group tetwright_precompiled_${group})
  get_property(maker GLOBAL PROPERTY ${group})
  if(maker)
    target_precompile_headers(${target} REUSE_FROM ${maker})
  else()
    target_precompile_headers(${target} PRIVATE
      <Eigen/Core> <Eigen/Geometry> <algorithm> <functional> <map> <optional> <span> <string> <vector> ${headers})
    set_property(GLOBAL PROPERTY ${group} ${target})
  endif()
endfunction()

# tetwright_library(TARGET [FUZZED] [FOLDER...]): a library that is installed, as tetwright::NAME. Its public headers are
# in include/ of its folder, or of the given subfolders. FUZZED: with TETWRIGHT_FUZZ it is instrumented, so that the
# fuzzer sees its coverage.
function(tetwright_library target)
  string(REPLACE tetwright_ "" name ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  add_library(tetwright::${name} ALIAS ${target})
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:tetwright_options>)
  target_compile_features(${target} PUBLIC cxx_std_20)
  set(folders ${ARGN})
  list(REMOVE_ITEM folders FUZZED)
  if(folders)
    list(TRANSFORM folders REPLACE "(.+)" "${CMAKE_CURRENT_SOURCE_DIR}/\\1/include")
  else()
    set(folders ${CMAKE_CURRENT_SOURCE_DIR}/include)
  endif()
  set_target_properties(${target} PROPERTIES tetwright_public_folders "${folders}")
  target_include_directories(${target} PUBLIC
    "$<BUILD_INTERFACE:${folders}>" $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  set_property(GLOBAL APPEND PROPERTY tetwright_libraries ${target})
  if(TETWRIGHT_FUZZ AND "FUZZED" IN_LIST ARGN)
    target_compile_options(${target} PRIVATE -fsanitize=fuzzer-no-link)
    tetwright_compile_together(${target} 8 fuzzed_libraries)
  else()
    tetwright_compile_together(${target} 8 libraries)
  endif()
endfunction()
