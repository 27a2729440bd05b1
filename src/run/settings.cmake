# Version, commit and compiler, as cmake/provenance.cmake has them; files that run once.
crescent_unoptimised(${PROJECT_SOURCE_DIR}/src/run/checkpoint.cpp)
set_source_files_properties(${PROJECT_SOURCE_DIR}/src/run/version.cpp PROPERTIES
  COMPILE_DEFINITIONS "${crescent_provenance}" INCLUDE_DIRECTORIES ${PROJECT_BINARY_DIR}/provenance)
add_dependencies(crescent_run crescent_commit)
