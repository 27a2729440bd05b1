# The planted faults stand with the laws, and `crescent check --planted` judges them.
target_sources(crescent_verdicts PRIVATE ${PROJECT_SOURCE_DIR}/laws/planted/planted.cpp)
target_include_directories(crescent_verdicts PRIVATE ${PROJECT_SOURCE_DIR})
if(CRESCENT_PRECOMPILED)
  target_precompile_headers(crescent_verdicts PRIVATE <nlohmann/json.hpp>)
endif()
