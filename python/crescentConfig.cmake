# The CMake package in the Python package:
#   find_package(crescent REQUIRED COMPONENTS headers)    with -Dcrescent_DIR=$(crescent --cmake-dir)
# crescent::headers has the interface of plugins (crescent/plugin.h, C and C++) and the headers of samplers in C++. The
# libraries, crescent::check and crescent::crescent, are those of `cmake --install`.
if(NOT TARGET crescent::headers)
  get_filename_component(crescent_package ${CMAKE_CURRENT_LIST_DIR}/../../.. ABSOLUTE)
  add_library(crescent::headers INTERFACE IMPORTED)
  set_target_properties(crescent::headers PROPERTIES INTERFACE_INCLUDE_DIRECTORIES ${crescent_package}/include)
endif()
set(crescent_headers_FOUND TRUE)
foreach(component IN LISTS crescent_FIND_COMPONENTS)
  if(NOT component STREQUAL "headers" AND crescent_FIND_REQUIRED_${component})
    set(crescent_FOUND FALSE)
    set(crescent_NOT_FOUND_MESSAGE "the Python package has COMPONENTS headers; ${component} is installed by cmake --install")
  endif()
endforeach()
