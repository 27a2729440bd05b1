# crescent_library: one folder of src/ is one static library, and includes only itself and the folders it depends on.

set(crescent_targets "")        # all libraries, those that depend on others first
set(crescent_test_folders "")   # those with *_test.cpp next to their sources: crescent_tests_of_FOLDER, for tests/
set(crescent_sources "")        # of crescent::check built alone, where all folders are one target
set(crescent_libraries "")

include(cmake/public_headers.cmake)
set(crescent_include ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/include)  # of programs that link our libraries
if(NOT PROJECT_IS_TOP_LEVEL)
  set(crescent_include ${PROJECT_BINARY_DIR}/include)
  crescent_public_headers(${PROJECT_SOURCE_DIR} ${crescent_include})
endif()

function(crescent_add_static_library target)
  add_library(${target} STATIC ${ARGN})
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/include
    INTERFACE "$<BUILD_INTERFACE:${crescent_include}>" $<INSTALL_INTERFACE:include>)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:crescent_compile_options>)
  if(NOT PROJECT_IS_TOP_LEVEL)  # another project builds only what it links
    set_target_properties(${target} PROPERTIES EXCLUDE_FROM_ALL ON)
  endif()
endfunction()

# A file of src/NAME that includes a folder which NAME does not depend on makes the build fail.
function(crescent_check_includes name)
  file(GLOB_RECURSE files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${name}/*.h ${PROJECT_SOURCE_DIR}/src/${name}/*.cpp)
  set(stamp ${PROJECT_BINARY_DIR}/includes/${name}.stamp)
  list(JOIN ARGN "|" allowed)
  add_custom_command(OUTPUT ${stamp} DEPENDS ${files} ${PROJECT_SOURCE_DIR}/cmake/check_includes.cmake VERBATIM
    COMMAND ${CMAKE_COMMAND} -DROOT=${PROJECT_SOURCE_DIR}/src -DNAME=${name} "-DALLOWED=${name}|${allowed}"
      -DSTAMP=${stamp} -P ${PROJECT_SOURCE_DIR}/cmake/check_includes.cmake
    COMMENT "includes of src/${name}")
  add_custom_target(crescent_${name}_includes DEPENDS ${stamp})
  add_dependencies(crescent_${name} crescent_${name}_includes)
endfunction()

# crescent_library(NAME [DEPENDS folder...] [LIBS target...] [PCH header...] [EXCLUDE regex]): src/NAME/**.cpp is the
# target crescent_NAME, also called crescent::NAME.
function(crescent_library name)
  cmake_parse_arguments(PARSE_ARGV 1 of "" "EXCLUDE" "DEPENDS;LIBS;PCH")
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${name}/*.cpp)
  set(tests ${sources})
  list(FILTER sources EXCLUDE REGEX "_test\\.cpp$")
  list(FILTER tests INCLUDE REGEX "_test\\.cpp$")
  if(of_EXCLUDE)
    list(FILTER sources EXCLUDE REGEX "${of_EXCLUDE}")
    list(FILTER tests EXCLUDE REGEX "${of_EXCLUDE}")
  endif()
  if(tests)
    set(crescent_tests_of_${name} ${tests} PARENT_SCOPE)
    set(crescent_test_folders ${crescent_test_folders} ${name} PARENT_SCOPE)
  endif()
  if(NOT CRESCENT_RUN)
    set(crescent_sources ${crescent_sources} ${sources} PARENT_SCOPE)
    set(crescent_libraries ${crescent_libraries} ${of_LIBS} PARENT_SCOPE)
    return()
  endif()
  crescent_add_static_library(crescent_${name} ${sources})
  add_library(crescent::${name} ALIAS crescent_${name})
  list(TRANSFORM of_DEPENDS PREPEND crescent_ OUTPUT_VARIABLE depends)
  target_link_libraries(crescent_${name} PUBLIC ${depends} ${of_LIBS})
  if(${name} IN_LIST crescent_fuzzed)
    target_compile_options(crescent_${name} PRIVATE -fsanitize=fuzzer-no-link)
  endif()
  crescent_use_pch(crescent_${name} ${of_PCH})
  crescent_unity(crescent_${name} ${sources})
  crescent_check_includes(${name} ${of_DEPENDS})
  crescent_templates(${name})
  set(crescent_targets crescent_${name} ${crescent_targets} PARENT_SCOPE)
  if(EXISTS ${PROJECT_SOURCE_DIR}/src/${name}/settings.cmake)
    include(${PROJECT_SOURCE_DIR}/src/${name}/settings.cmake)
  endif()
endfunction()

# crescent::check alone: what crescent/check.h and crescent/gtest.h need, as one target. Sources that match `exclude` serve the program only.
function(crescent_check_alone exclude)
  list(FILTER crescent_sources EXCLUDE REGEX "${exclude}")
  crescent_add_static_library(crescent_check ${crescent_sources})
  add_library(crescent::check ALIAS crescent_check)
  target_link_libraries(crescent_check PUBLIC ${crescent_libraries})
  crescent_unity(crescent_check ${crescent_sources})
  crescent_use_pch(crescent_check <nlohmann/json.hpp>)
  # The compiler's own garbage collection takes 10 % of the time with the default of 128 MB.
  # Sources that are included by another one have unnamed namespaces, which g++ warns of.
  target_compile_options(crescent_check PRIVATE
    $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=1048576 -Wno-subobject-linkage>)
  set(crescent_targets crescent_check PARENT_SCOPE)
endfunction()
