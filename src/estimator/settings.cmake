# What runs once a sample is worth a longer compilation.
target_compile_options(crescent_estimator PRIVATE $<$<CONFIG:Release>:-O3>)

set(crescent_kernel_target crescent_estimator)
include(${CMAKE_CURRENT_LIST_DIR}/kernels.cmake)
