# Planted faults and right samplers stand with the laws; `crescent check --planted` and `--right` judge them.
file(GLOB judged_by_laws CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/laws/planted/*.cpp
  ${PROJECT_SOURCE_DIR}/laws/right/*.cpp)
target_sources(crescent_verdicts PRIVATE ${judged_by_laws})
target_include_directories(crescent_verdicts PRIVATE ${PROJECT_SOURCE_DIR})
if(CRESCENT_PRECOMPILED)
  target_precompile_headers(crescent_verdicts PRIVATE <nlohmann/json.hpp>)
endif()
# Every verdict has a `judge` of its own, many faults a `Bend`.
set_target_properties(crescent_verdicts PROPERTIES UNITY_BUILD OFF)
