# SPDX-License-Identifier: Apache-2.0
# The build's one set of flags. A stream's words must not depend on the compiler: no contraction of a*b+c, no fast-math, no -march.
get_property(multi_config GLOBAL PROPERTY GENERATOR_IS_MULTI_CONFIG)
if(PROJECT_IS_TOP_LEVEL AND NOT multi_config AND NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Release, Debug, Sanitize, Threads or Fuzz" FORCE)
endif()

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

if(PROJECT_IS_TOP_LEVEL)
  set(CMAKE_CXX_FLAGS_RELEASE "-O2 -g1 -DNDEBUG")
  set(CMAKE_CXX_FLAGS_DEBUG "-Og -g1 -D_GLIBCXX_ASSERTIONS")
  set(CMAKE_CXX_FLAGS_SANITIZE
      "-O1 -g1 -D_GLIBCXX_ASSERTIONS -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer")
  # Threads (tools/test --threads). The file names headers of libraries that are built without the sanitizer; g++ has no such option.
  set(CMAKE_CXX_FLAGS_THREADS "-O1 -g1 -D_GLIBCXX_ASSERTIONS -fsanitize=thread -fno-omit-frame-pointer")
  if(CMAKE_CXX_COMPILER_ID MATCHES Clang)
    string(APPEND CMAKE_CXX_FLAGS_THREADS " -fsanitize-ignorelist=${PROJECT_SOURCE_DIR}/verif/test/sanitize/not_ours.txt")
  endif()
  # Under a fuzzer (tools/fuzz), by clang.
  set(CMAKE_CXX_FLAGS_FUZZ "-O1 -g1 -D_GLIBCXX_ASSERTIONS -fsanitize=address,undefined,fuzzer-no-link -fno-sanitize-recover=all")
endif()

# kage_flags: what every target of this project compiles with; never exported.
add_library(kage_flags INTERFACE)
target_compile_options(kage_flags INTERFACE -ffp-contract=off -Wall -Wextra -Wpedantic -Wconversion -Wshadow)
if(CMAKE_CXX_COMPILER_ID MATCHES Clang)
  target_compile_options(kage_flags INTERFACE -Wno-sign-conversion)
else() # g++ takes what its sanitizers put between for ways round a constructor, as in <regex>
  target_compile_options(kage_flags INTERFACE $<$<CONFIG:Sanitize>:-Wno-maybe-uninitialized>)
endif()
if(KAGE_WERROR)
  target_compile_options(kage_flags INTERFACE -Werror)
endif()

# Compiling files together spares their headers, which are most of the work. A file's own includes are then checked by
# tools/lint tidy alone, and one changed file compiles seven others, so it is for builds that are made once (tools/demo,
# tools/test, packages). Tests are a program per file.
option(KAGE_UNITY "Compile the files of a library together" OFF)

# kage_unity(TARGET...): those of the targets that are made of many files.
function(kage_unity)
  if(KAGE_UNITY)
    set_target_properties(${ARGN} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 16)
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU") # a class whose members are of a file's own types is of that file alone
      foreach(target ${ARGN})
        target_compile_options(${target} PRIVATE -Wno-subobject-linkage)
      endforeach()
    endif()
  endif()
endfunction()

# kage_cold(TARGET...): those of the targets in which no loop runs long. They are compiled in four fifths of the time.
function(kage_cold)
  foreach(target ${ARGN})
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  endforeach()
endfunction()

# kage_executable(NAME SOURCES... [LIBS...]): an executable with the project's flags.
function(kage_executable name)
  cmake_parse_arguments(arg "" "" "SOURCES;LIBS" ${ARGN})
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE kage_flags ${arg_LIBS})
endfunction()
