# SPDX-License-Identifier: Apache-2.0
# How targets of ours are compiled.

# The options of all of them.
add_library(tetwright_options INTERFACE)
target_compile_options(tetwright_options INTERFACE
  -Wall -Wextra -Wnon-virtual-dtor -Wconversion -Wno-sign-conversion
  # g++ 12 sees overlapping and overlong copies in std::string that are not there (GCC bug 105651).
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict$<SEMICOLON>-Wno-stringop-overflow$<SEMICOLON>-Wno-stringop-overread$<SEMICOLON>-Wno-array-bounds>
  # The same bytes on every machine: no fused multiply-add behind our back.
  -ffp-contract=off)
if(NOT TETWRIGHT_UNITY)
  target_compile_options(tetwright_options INTERFACE -Wshadow)  # in a unity build it would warn of names in other files
else()
  # g++ takes the source files for headers, in which anonymous namespaces would be a mistake.
  target_compile_options(tetwright_options INTERFACE
    $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess$<SEMICOLON>-Wno-subobject-linkage> "$<$<CXX_COMPILER_ID:Clang>:SHELL:-Xclang -fno-pch-timestamp>")
endif()
if(TETWRIGHT_WARNINGS_AS_ERRORS)
  target_compile_options(tetwright_options INTERFACE -Werror)
endif()
if(TETWRIGHT_SANITIZE)
  target_compile_options(tetwright_options INTERFACE
    -fsanitize=${TETWRIGHT_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all
    # g++ sees values that might be uninitialised in instrumented code of its own library, and has no ignore list.
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized$<SEMICOLON>-fno-sanitize=alignment>
    $<$<CXX_COMPILER_ID:Clang>:-fsanitize-ignorelist=${PROJECT_SOURCE_DIR}/tests/sanitize_ignorelist.txt>)
  target_link_options(tetwright_options INTERFACE -fsanitize=${TETWRIGHT_SANITIZE})
endif()

# tetwright_compile_together(TARGET BATCH [GROUP [HEADER...]]): compiles BATCH files of the target at a time (0: all),
# with a precompiled header that the targets of a GROUP share. All of a group must be compiled with the same options; the
# first one makes the header. Most of a compiler's time goes into headers and templates that the files of a folder
# share; names in anonymous namespaces are unique within a target for this. Does nothing without TETWRIGHT_UNITY.
function(tetwright_compile_together target batch)
  if(NOT TETWRIGHT_UNITY)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${batch}
    # Else each shared library defines a macro of its own, and the header is not valid for another.
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

# tetwright_library(TARGET [FUZZED]): a library that is installed, as tetwright::NAME. FUZZED: with TETWRIGHT_FUZZ it tells
# the fuzzer which way it went.
function(tetwright_library target)
  string(REPLACE tetwright_ "" name ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  add_library(tetwright::${name} ALIAS ${target})
  target_link_libraries(${target} PRIVATE tetwright_options)
  set_property(GLOBAL APPEND PROPERTY tetwright_libraries ${target})
  if(TETWRIGHT_FUZZ AND "FUZZED" IN_LIST ARGN)
    target_compile_options(${target} PRIVATE -fsanitize=fuzzer-no-link)
    tetwright_compile_together(${target} 8 fuzzed_libraries)
  else()
    tetwright_compile_together(${target} 8 libraries)
  endif()
endfunction()
