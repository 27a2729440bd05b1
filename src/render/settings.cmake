# What runs once per sample or per pixel is worth a longer compilation.
target_compile_options(crescent_render PRIVATE $<$<CONFIG:Release>:-O3>)

set(crescent_kernel_target crescent_render)
include(${CMAKE_CURRENT_LIST_DIR}/kernels.cmake)
