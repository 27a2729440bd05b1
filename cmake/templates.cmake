# crescent_templates(NAME): the templates (*.html) and style sheets (*.css) of src/NAME become part of crescent_NAME, as
# the function NAME_templates() of output/templates.h. Run as a script, it writes the source file of that function.
if(CMAKE_SCRIPT_MODE_FILE)
  set(entries "")
  foreach(file IN LISTS FILES)
    get_filename_component(short ${file} NAME)
    file(READ ${file} text)
    string(APPEND entries "    {\"${short}\", R\"template(${text})template\"},\n")
  endforeach()
  file(WRITE ${OUTPUT} "// Made by cmake/templates.cmake from the templates of src/${NAME}.
#include \"output/templates.h\"

namespace crescent {

static constexpr Template all[] = {
${entries}};

Templates ${NAME}_templates() { return all; }

}  // namespace crescent
")
  return()
endif()

function(crescent_templates name)
  file(GLOB_RECURSE files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${name}/*.html ${PROJECT_SOURCE_DIR}/src/${name}/*.css)
  if(NOT files)
    return()
  endif()
  set(output ${PROJECT_BINARY_DIR}/pages/${name}.cpp)
  add_custom_command(OUTPUT ${output} DEPENDS ${files} ${CMAKE_CURRENT_FUNCTION_LIST_FILE} VERBATIM
    COMMAND ${CMAKE_COMMAND} -DNAME=${name} "-DFILES=${files}" -DOUTPUT=${output} -P ${CMAKE_CURRENT_FUNCTION_LIST_FILE}
    COMMENT "templates of src/${name}")
  target_sources(crescent_${name} PRIVATE ${output})
endfunction()
