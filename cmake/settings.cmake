# Compiler settings.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
if(PROJECT_IS_TOP_LEVEL)  # else the parent project decides
  if(NOT CMAKE_BUILD_TYPE)
    set(CMAKE_BUILD_TYPE Release)
  endif()
  if(CMAKE_CXX_FLAGS_RELEASE STREQUAL "-O3 -DNDEBUG")  # CMake's own; another choice stays
    set(CMAKE_CXX_FLAGS_RELEASE "-O2")
  endif()
  set(CMAKE_EXPORT_COMPILE_COMMANDS ON)  # build/compile_commands.json, for clang-tidy and editors
endif()

find_program(CCACHE ccache)
if(CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER AND PROJECT_IS_TOP_LEVEL)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE})
endif()

# The files of a folder are compiled as one, which parses each header and instantiates each template once: a build from
# nothing takes two thirds of the time. Developers who change one file often set it OFF and recompile that file alone.
option(CRESCENT_UNITY "compile the files of a folder together" ON)

add_library(crescent_compile_options INTERFACE)
# No contraction into fused multiply-add anywhere: films are the same bits from every compiler and instruction set.
target_compile_options(crescent_compile_options INTERFACE -ffp-contract=off)
if(PROJECT_IS_TOP_LEVEL)
  target_compile_options(crescent_compile_options INTERFACE -Wall -Wextra -Wpedantic
    $<$<NOT:$<BOOL:${CRESCENT_UNITY}>>:-Wshadow>)  # names of other files of the folder would count as shadowed
else()
  # Part of another project, which sets the warnings. Unoptimised code of a check takes several times as long to run,
  # and more than -O1 takes longer to compile than it saves.
  target_compile_options(crescent_compile_options INTERFACE -O1)
endif()
target_compile_options(crescent_compile_options INTERFACE -fno-math-errno
  # g++ 12 reports overlaps and overflows in std::string's operator+ that do not exist (GCC bug 105651).
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict -Wno-stringop-overflow>
  # Masks of one lane are plain bool, and & on them is intended.
  $<$<CXX_COMPILER_ID:Clang>:-Wno-bitwise-instead-of-logical>)
if(CRESCENT_SANITIZE)
  # AddressSanitizer itself detects null and accesses beyond an object; checking these twice, and the type behind each
  # pointer, takes a fifth of the build and of the tests.
  target_compile_options(crescent_compile_options INTERFACE -fsanitize=${CRESCENT_SANITIZE}
    -fno-sanitize=null,object-size,vptr -fno-sanitize-recover=all -fno-omit-frame-pointer -g1)
  target_link_options(crescent_compile_options INTERFACE -fsanitize=${CRESCENT_SANITIZE})
endif()
if(CRESCENT_FUZZ)
  if(NOT CRESCENT_SANITIZE OR NOT CMAKE_CXX_COMPILER_ID MATCHES Clang)
    message(FATAL_ERROR "CRESCENT_FUZZ needs clang and CRESCENT_SANITIZE: cmake --preset sanitize has both")
  endif()
  set(crescent_fuzzed base images scene experiment compare report run)  # counts what it covers; where no fuzzer listens, ASan's runtime ignores it
endif()

# Headers used by nearly every file: parsing them takes two thirds of the compile time. Libraries with equal lists and
# options share the precompiled file of the first of them; programs, whose code is position-independent in another way,
# have their own.
option(CRESCENT_PCH "precompile the standard library's headers" ON)
function(crescent_use_pch target)
  if(NOT CRESCENT_PCH)
    return()
  endif()
  get_target_property(type ${target} TYPE)
  get_target_property(options ${target} COMPILE_OPTIONS)
  string(MD5 headers "${ARGN}")
  string(MD5 like "${ARGN} ${options}")
  get_property(first GLOBAL PROPERTY crescent_pch_${like})
  if(first AND type MATCHES "^(STATIC|OBJECT)_LIBRARY$")
    target_precompile_headers(${target} REUSE_FROM ${first})
  else()
    target_precompile_headers(${target} PRIVATE <algorithm> <array> <cmath> <cstdint> <filesystem> <fstream>
      <functional> <map> <memory>
      <optional> <span> <sstream> <string> <string_view> <variant> <vector> <fmt/format.h> ${ARGN})
    if(type MATCHES "^(STATIC|OBJECT)_LIBRARY$")
      set_property(GLOBAL PROPERTY crescent_pch_${like} ${target})
    endif()
  endif()
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:Clang>:SHELL:-Xclang -fno-pch-timestamp>)
  # CMake gives its list of headers the time of older files: their hash shows ninja that they changed.
  target_compile_definitions(${target} PRIVATE CRESCENT_HEADERS=0x${headers})
endfunction()

# crescent_unity(TARGET source...): compiles the files of each folder as one.
function(crescent_unity target)
  if(NOT CRESCENT_UNITY)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  foreach(source IN LISTS ARGN)
    get_filename_component(folder ${source} DIRECTORY)
    file(RELATIVE_PATH folder ${PROJECT_SOURCE_DIR} ${folder})
    string(MAKE_C_IDENTIFIER ${folder} group)
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${group})
  endforeach()
endfunction()

# Files that run once and take long to optimise, mostly JSON. Without optimisation they cannot use the precompiled
# headers.
function(crescent_low_optimization)
  set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS -O0 SKIP_PRECOMPILE_HEADERS ON)
endfunction()
