# Version, commit and compiler, as src/run/version.cpp states them.
set(crescent_commit_header ${PROJECT_BINARY_DIR}/provenance/commit.h)
add_custom_target(crescent_commit BYPRODUCTS ${crescent_commit_header}
  COMMAND ${CMAKE_COMMAND} -DSOURCE=${CMAKE_CURRENT_LIST_DIR}/.. -DOUTPUT=${crescent_commit_header}
  -P ${CMAKE_CURRENT_LIST_DIR}/commit.cmake
  COMMENT "commit" VERBATIM)
set(crescent_provenance
  CRESCENT_VERSION="${PROJECT_VERSION}"
  CRESCENT_COMPILER="${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}")
