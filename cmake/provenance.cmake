# Version, commit and compiler, as every output states them.
execute_process(COMMAND git describe --always --dirty --abbrev=12 WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
  OUTPUT_VARIABLE crescent_commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT crescent_commit)
  set(crescent_commit unknown)
endif()
set(crescent_provenance
  CRESCENT_VERSION="${PROJECT_VERSION}"
  CRESCENT_COMMIT="${crescent_commit}"
  CRESCENT_COMPILER="${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}")
