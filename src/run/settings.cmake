# Version, commit and compiler, as cmake/provenance.cmake has them; files that run once.
crescent_low_optimization(${PROJECT_SOURCE_DIR}/src/run/checkpoint.cpp ${PROJECT_SOURCE_DIR}/src/run/join.cpp)
set_source_files_properties(${PROJECT_SOURCE_DIR}/src/run/version.cpp PROPERTIES
  COMPILE_DEFINITIONS "${crescent_provenance}" INCLUDE_DIRECTORIES ${PROJECT_BINARY_DIR}/provenance)
add_dependencies(crescent_run crescent_commit)
if(NOT CRESCENT_PLATES)  # a file that needs Cairo, which films and metrics in memory do not
  set_source_files_properties(${PROJECT_SOURCE_DIR}/src/run/write.cpp PROPERTIES HEADER_FILE_ONLY ON)
endif()
