# The shape of a target: a folder of src/, the check, the whole.

# crescent_library(TARGET SOURCE...): a static library with the settings and the folders of headers that all have.
function(crescent_library target)
  add_library(${target} STATIC ${ARGN})
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src> $<INSTALL_INTERFACE:include/crescent>)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:crescent_settings>)
  if(NOT PROJECT_IS_TOP_LEVEL)  # another project builds what it links
    set_target_properties(${target} PROPERTIES EXCLUDE_FROM_ALL ON)
  endif()
endfunction()

# crescent_folder(NAME LIBS...): src/NAME/*.cpp and src/NAME/*/*.cpp are the target crescent_NAME; it may use every
# folder named before it. Headers in crescent_read_in_NAME are precompiled for it. *_test.cpp stand beside their
# sources and are collected for laws/CMakeLists.txt. Of crescent::check alone all folders are one target, which is
# compiled in a few files: who builds it builds it once and edits none of it.
set(crescent_folders "")
set(crescent_sources "")
set(crescent_libraries "")
set(crescent_draws plates compare)
set(crescent_test_sources "")
macro(crescent_folder name)
  file(GLOB folder_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${name}/*.cpp
    ${PROJECT_SOURCE_DIR}/src/${name}/*/*.cpp)
  set(folder_tests ${folder_sources})
  list(FILTER folder_sources EXCLUDE REGEX "_test\\.cpp$")
  list(FILTER folder_tests INCLUDE REGEX "_test\\.cpp$")
  list(APPEND crescent_test_sources ${folder_tests})
  if(NOT CRESCENT_PLATES AND ${name} IN_LIST crescent_draws)
    set(folder_sources "")
  endif()
  if(folder_sources AND NOT CRESCENT_RUN)
    list(APPEND crescent_sources ${folder_sources})
    list(APPEND crescent_libraries ${ARGN})
    set_source_files_properties(${folder_sources} PROPERTIES UNITY_GROUP ${crescent_in_one_file_with_${name}})
  elseif(folder_sources)
    crescent_library(crescent_${name} ${folder_sources})
    add_library(crescent::${name} ALIAS crescent_${name})
    target_link_libraries(crescent_${name} PUBLIC ${crescent_folders} ${ARGN})
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

# What judges samplers, crescent::check: the target of its folder or, alone, of all folders that it needs.
macro(crescent_check_library)
  if(NOT CRESCENT_RUN)
    crescent_library(crescent_check ${crescent_sources})
    add_library(crescent::check ALIAS crescent_check)
    target_link_libraries(crescent_check PUBLIC ${crescent_libraries})
    if(NOT DEFINED CMAKE_UNITY_BUILD)
      set_target_properties(crescent_check PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
    endif()
    crescent_precompiled(crescent_check <nlohmann/json.hpp>)
    set(crescent_folders crescent_check)
  endif()
  target_include_directories(crescent_check PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:include>)
  set(crescent_of_check ${crescent_folders})
endmacro()

# The public face: crescent.h and every folder behind one name.
macro(crescent_public_library)
  file(GLOB face_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/*.cpp)
  crescent_library(crescent_face ${face_sources})
  target_link_libraries(crescent_face PUBLIC ${crescent_folders})
  add_library(crescent INTERFACE)
  target_link_libraries(crescent INTERFACE crescent_face)
  add_library(crescent::crescent ALIAS crescent)
endmacro()
