# published.cpp and json_schema.cpp are built without optimisation: they run once, and compile slowly otherwise.
crescent_unoptimised(${PROJECT_SOURCE_DIR}/src/experiment/published.cpp
  ${PROJECT_SOURCE_DIR}/src/experiment/json_schema.cpp)
