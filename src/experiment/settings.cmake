crescent_unoptimised(${PROJECT_SOURCE_DIR}/src/experiment/published.cpp
  ${PROJECT_SOURCE_DIR}/src/experiment/json_schema.cpp)
