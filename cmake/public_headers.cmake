# crescent_public_headers(SOURCE DESTINATION): the headers of include/ and src/ of the tree SOURCE, all below
# DESTINATION/crescent and including each other from there: "base/text.h" becomes "crescent/base/text.h". A program that
# has a folder base/ of its own then never meets ours. `cmake --install` calls it with its prefix, and a project that
# adds this tree to its own with a folder of the build.
function(crescent_public_headers source destination)
  file(GLOB folders RELATIVE ${source}/src ${source}/src/*)
  list(JOIN folders "|" folders)
  file(GLOB_RECURSE headers RELATIVE ${source} ${source}/include/crescent/*.h ${source}/src/*.h)
  list(FILTER headers EXCLUDE REGEX "^src/gl/")
  foreach(header IN LISTS headers)
    string(REGEX REPLACE "^(include/crescent|src)/" "" name ${header})
    file(READ ${source}/${header} text)
    string(REGEX REPLACE "#include \"(${folders})/" "#include \"crescent/\\1/" text "${text}")
    set(old "")
    if(EXISTS ${destination}/crescent/${name})
      file(READ ${destination}/crescent/${name} old)
    endif()
    if(NOT old STREQUAL text)  # so that nothing is compiled again for it
      file(WRITE ${destination}/crescent/${name} "${text}")
    endif()
  endforeach()
endfunction()
