# Every pixel passes through the integrals: worth a longer compilation.
target_compile_options(crescent_reference PRIVATE $<$<CONFIG:Release>:-O3>)
