# Compiler settings and the shape of a target.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
if(PROJECT_IS_TOP_LEVEL)  # as a part of another project, its choice
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

find_package(fmt REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(TBB REQUIRED)
find_package(Boost REQUIRED)
find_package(OpenEXR REQUIRED)
find_package(hwy REQUIRED)
find_package(PkgConfig REQUIRED)
if(CRESCENT_PLATES)
  find_package(PNG REQUIRED)
  pkg_check_modules(pango REQUIRED IMPORTED_TARGET pangocairo cairo)
elseif(CRESCENT_TESTS OR CRESCENT_CLI OR CRESCENT_GL OR CRESCENT_FILM)
  message(FATAL_ERROR "CRESCENT_PLATES=OFF: the program, the tests, the GL instrument and the film need plates")
endif()
pkg_check_modules(xxhash REQUIRED IMPORTED_TARGET libxxhash)
add_library(xxHash::xxhash ALIAS PkgConfig::xxhash)

add_library(crescent_settings INTERFACE)
# No contraction into fused multiply-add anywhere: films are the same bits from every compiler and instruction set.
target_compile_options(crescent_settings INTERFACE -ffp-contract=off -Wall -Wextra -Wpedantic -Wshadow -fno-math-errno
  # g++ 12 sees overlaps in std::string's operator+ that are not there (GCC bug 105651).
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
  # Masks of one lane are plain bool, and & on them is meant.
  $<$<CXX_COMPILER_ID:Clang>:-Wno-bitwise-instead-of-logical>)
if(CRESCENT_SANITIZE)
  # AddressSanitizer itself stops at null and behind an object's end; looking for these twice, and for the type behind
  # each pointer, takes a fifth of the build and of the tests.
  target_compile_options(crescent_settings INTERFACE -fsanitize=${CRESCENT_SANITIZE}
    -fno-sanitize=null,object-size,vptr -fno-sanitize-recover=all -fno-omit-frame-pointer -g1)
  target_link_options(crescent_settings INTERFACE -fsanitize=${CRESCENT_SANITIZE})
endif()
if(CRESCENT_FUZZ)
  if(NOT CRESCENT_SANITIZE OR NOT CMAKE_CXX_COMPILER_ID MATCHES Clang)
    message(FATAL_ERROR "CRESCENT_FUZZ needs clang and CRESCENT_SANITIZE: cmake --preset sanitize has both")
  endif()
  set(crescent_fuzzed base experiment)  # counts what it covers; where no fuzzer listens, ASan's runtime ignores it
endif()

# What nearly every file reads, read once a target: two thirds of the time to compile is spent in these.
option(CRESCENT_PRECOMPILED "precompile the standard library's headers" ON)
function(crescent_precompiled target)
  if(CRESCENT_PRECOMPILED)
    target_precompile_headers(${target} PRIVATE <algorithm> <array> <cmath> <cstdint> <filesystem> <fstream>
      <functional> <map> <memory>
      <optional> <span> <sstream> <string> <string_view> <variant> <vector> <fmt/format.h> ${ARGN})
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:Clang>:SHELL:-Xclang -fno-pch-timestamp>)
    # CMake gives its list of headers the time of older files: by their hash ninja sees that they are others.
    string(MD5 headers "${ARGN}")
    target_compile_definitions(${target} PRIVATE CRESCENT_HEADERS=0x${headers})
  endif()
endfunction()

# Files with names of their own in an unnamed namespace that another file of their target has too: where files are
# compiled several at once (CMAKE_UNITY_BUILD), each of these is compiled alone.
function(crescent_apart)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

# Files that run once and take long to optimise, JSON above all. Without it they cannot use the precompiled headers.
function(crescent_unoptimised)
  set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS -O0 SKIP_PRECOMPILE_HEADERS ON)
endfunction()

# crescent_folder(NAME LIBS...): src/NAME/*.cpp is the target crescent_NAME; it may use every folder named before it.
# Headers in crescent_read_in_NAME are precompiled for it.
# *_test.cpp stand beside their sources and are collected for laws/CMakeLists.txt.
set(crescent_folders "")
set(crescent_draws plates compare)
set(crescent_test_sources "")
macro(crescent_folder name)
  file(GLOB folder_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${name}/*.cpp)
  set(folder_tests ${folder_sources})
  list(FILTER folder_sources EXCLUDE REGEX "_test\\.cpp$")
  list(FILTER folder_tests INCLUDE REGEX "_test\\.cpp$")
  list(APPEND crescent_test_sources ${folder_tests})
  if(NOT CRESCENT_PLATES AND ${name} IN_LIST crescent_draws)
    set(folder_sources "")
  endif()
  if(folder_sources)
    add_library(crescent_${name} STATIC ${folder_sources})
    target_include_directories(crescent_${name} PUBLIC
      $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src> $<INSTALL_INTERFACE:include/crescent>)
    add_library(crescent::${name} ALIAS crescent_${name})
    target_compile_features(crescent_${name} PUBLIC cxx_std_20)
    target_link_libraries(crescent_${name} PUBLIC ${crescent_folders} ${ARGN} PRIVATE
      $<BUILD_INTERFACE:crescent_settings>)
    if(${name} IN_LIST crescent_fuzzed)
      target_compile_options(crescent_${name} PRIVATE -fsanitize=fuzzer-no-link)
    endif()
    list(LENGTH folder_sources size)
    if(size GREATER 5)
      crescent_precompiled(crescent_${name} ${crescent_read_in_${name}})
    endif()
    list(PREPEND crescent_folders crescent_${name})
    if(EXISTS ${PROJECT_SOURCE_DIR}/src/${name}/settings.cmake)
      include(${PROJECT_SOURCE_DIR}/src/${name}/settings.cmake)
    endif()
  endif()
endmacro()

# The public face: crescent.h and every folder behind one name.
macro(crescent_public_library)
  file(GLOB face_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/*.cpp)
  add_library(crescent_face STATIC ${face_sources})
  target_include_directories(crescent_face PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src> $<INSTALL_INTERFACE:include/crescent>)
  target_link_libraries(crescent_face PUBLIC ${crescent_folders} PRIVATE $<BUILD_INTERFACE:crescent_settings>)
  add_library(crescent INTERFACE)
  target_link_libraries(crescent INTERFACE crescent_face)
  add_library(crescent::crescent ALIAS crescent)
endmacro()
