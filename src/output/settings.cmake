# templates.cpp alone includes kainjow::mustache: programs that link this library need no header of it.
target_include_directories(crescent_output SYSTEM PRIVATE ${kainjow_INCLUDE_DIR})
