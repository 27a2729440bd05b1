# Code that runs per sample or per pixel is compiled with more optimisation.
target_compile_options(crescent_render PRIVATE $<$<CONFIG:Release>:-O3>)

set(crescent_kernel_target crescent_render)
include(${CMAKE_CURRENT_LIST_DIR}/kernels.cmake)
