# Samplers with a known verdict. crescent_planted has the planted faults, which `crescent check --planted` checks, and
# the correct samplers that they change; crescent_known_samplers those that only tests check. No installed library
# contains them.
function(crescent_samplers target)
  set(sources "")
  foreach(folder ${ARGN})
    file(GLOB of_folder CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/known_samplers/${folder}/*.cpp)
    list(APPEND sources ${of_folder})
  endforeach()
  add_library(${target} STATIC EXCLUDE_FROM_ALL ${sources})
  target_include_directories(${target} PUBLIC ${PROJECT_SOURCE_DIR})
  target_link_libraries(${target} PUBLIC crescent_check PRIVATE crescent_compile_options)
  crescent_use_pch(${target} <nlohmann/json.hpp>)
  crescent_unity(${target} ${sources})
endfunction()
crescent_samplers(crescent_planted correct faulty)
crescent_samplers(crescent_known_samplers held_out reported study)
# Some of them have helpers of one name, such as `half`.
file(GLOB own_helpers ${CMAKE_CURRENT_LIST_DIR}/faulty/*.cpp ${CMAKE_CURRENT_LIST_DIR}/held_out/*.cpp
  ${CMAKE_CURRENT_LIST_DIR}/reported/*.cpp)
set_source_files_properties(${own_helpers} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
target_link_libraries(crescent_known_samplers PUBLIC crescent_planted)
