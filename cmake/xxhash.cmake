# The target xxHash::xxhash, if no package found by CMake defines it: Debian's has only a header and a library.
if(NOT TARGET xxHash::xxhash)
  find_path(xxHash_INCLUDE_DIR xxhash.h)
  find_library(xxHash_LIBRARY xxhash)
  mark_as_advanced(xxHash_INCLUDE_DIR xxHash_LIBRARY)
  if(xxHash_INCLUDE_DIR AND xxHash_LIBRARY)
    add_library(xxHash::xxhash UNKNOWN IMPORTED)
    set_target_properties(xxHash::xxhash PROPERTIES IMPORTED_LOCATION ${xxHash_LIBRARY}
      INTERFACE_INCLUDE_DIRECTORIES ${xxHash_INCLUDE_DIR})
  endif()
endif()
