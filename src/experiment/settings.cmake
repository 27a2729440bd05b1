# Runs once, and compiles slowly with optimization.
crescent_low_optimization(${PROJECT_SOURCE_DIR}/src/experiment/published.cpp
  ${PROJECT_SOURCE_DIR}/src/experiment/json_schema.cpp)
