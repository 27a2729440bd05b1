# Writes OUTPUT, a C++ file with every shader of FOLDER as a string, by its path there.
cmake_minimum_required(VERSION 3.25)
file(GLOB_RECURSE paths RELATIVE ${FOLDER} ${FOLDER}/*.glsl)
list(SORT paths)
file(WRITE ${OUTPUT}
  "#include \"program.h\"\n\nnamespace crescent::gl {\n\nconst ShaderFile shader_files[] = {\n")
foreach(path IN LISTS paths)
  file(READ ${FOLDER}/${path} text)
  file(APPEND ${OUTPUT} "    {\"${path}\", R\"glsl(${text})glsl\"},\n")
endforeach()
list(LENGTH paths count)
file(APPEND ${OUTPUT} "};\nconst int shader_file_count = ${count};\n\n}  // namespace crescent::gl\n")
