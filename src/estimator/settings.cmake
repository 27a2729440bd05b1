# What runs once a sample is worth a longer compilation.
target_compile_options(crescent_estimator PRIVATE $<$<CONFIG:Release>:-O3>)

set_source_files_properties(${PROJECT_SOURCE_DIR}/src/estimator/kernel_sse4.cpp ${PROJECT_SOURCE_DIR}/src/estimator/kernel_avx2.cpp
  ${PROJECT_SOURCE_DIR}/src/estimator/kernel_avx512.cpp PROPERTIES SKIP_PRECOMPILE_HEADERS ON)

# Each instruction set's kernels are compiled with its own flags, on processors that have any of them.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set(dir ${PROJECT_SOURCE_DIR}/src/estimator)
  set_source_files_properties(${dir}/kernel_sse4.cpp PROPERTIES COMPILE_OPTIONS "-msse4.2")
  set_source_files_properties(${dir}/kernel_avx2.cpp PROPERTIES COMPILE_OPTIONS "-mavx2;-mf16c")
  set_source_files_properties(${dir}/kernel_avx512.cpp PROPERTIES COMPILE_OPTIONS "-mavx512f;-mavx512vl;-mavx512dq;-mavx512bw;-mavx512cd")
  # One source makes all kernels. ASan reads it in the scalar and AVX2 builds, UBSan in the scalar one: there they cost
  # the least to compile.
  if(CRESCENT_SANITIZE)
    set_property(SOURCE ${dir}/kernel_avx2.cpp APPEND PROPERTY COMPILE_OPTIONS "-fno-sanitize=undefined")
    foreach(isa sse4 avx512)
      set_property(SOURCE ${dir}/kernel_${isa}.cpp APPEND PROPERTY COMPILE_OPTIONS "-fno-sanitize=all")
    endforeach()
  endif()
endif()
