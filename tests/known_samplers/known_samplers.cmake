# Samplers with a known verdict: planted faults and correct samplers. `crescent check --planted` and `--right` and tests
# check them; no installed library contains them.
file(GLOB known CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/*/*.cpp)
add_library(crescent_known_samplers STATIC EXCLUDE_FROM_ALL ${known})
target_include_directories(crescent_known_samplers PUBLIC ${PROJECT_SOURCE_DIR})
target_link_libraries(crescent_known_samplers PUBLIC crescent_check PRIVATE crescent_compile_options)
crescent_use_pch(crescent_known_samplers <nlohmann/json.hpp>)
set_target_properties(crescent_known_samplers PROPERTIES UNITY_BUILD OFF)  # many faults have a `Bend` of their own
