# Samplers whose verdict is known: planted faults and right samplers. `crescent check --planted` and `--right` and the
# laws judge them; no library that is installed has them.
file(GLOB known CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/laws/planted/*.cpp ${PROJECT_SOURCE_DIR}/laws/right/*.cpp
  ${PROJECT_SOURCE_DIR}/laws/known/*.cpp)
add_library(crescent_known STATIC EXCLUDE_FROM_ALL ${known})
target_include_directories(crescent_known PUBLIC ${PROJECT_SOURCE_DIR})
target_link_libraries(crescent_known PUBLIC crescent_check PRIVATE crescent_settings)
crescent_precompiled(crescent_known <nlohmann/json.hpp>)
set_target_properties(crescent_known PROPERTIES UNITY_BUILD OFF)  # many faults have a `Bend` of their own
