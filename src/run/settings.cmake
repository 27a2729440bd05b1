# Version, commit and compiler, as cmake/provenance.cmake has them.
set_source_files_properties(${PROJECT_SOURCE_DIR}/src/run/version.cpp PROPERTIES
  COMPILE_DEFINITIONS "${crescent_provenance}" INCLUDE_DIRECTORIES ${PROJECT_BINARY_DIR}/provenance)
add_dependencies(crescent_run crescent_commit)
if(NOT CRESCENT_PLATES)  # a file that needs Cairo, which films and metrics in memory do not
  set_source_files_properties(${PROJECT_SOURCE_DIR}/src/run/write.cpp PROPERTIES HEADER_FILE_ONLY ON)
endif()
