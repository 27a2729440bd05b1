crescent_unoptimised(${PROJECT_SOURCE_DIR}/src/experiment/published.cpp ${PROJECT_SOURCE_DIR}/src/experiment/schema_print.cpp)
