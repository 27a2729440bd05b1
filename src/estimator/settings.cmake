# Each instruction set's kernels are compiled with its own flags, on processors that have any of them.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set(dir ${PROJECT_SOURCE_DIR}/src/estimator)
  set_source_files_properties(${dir}/kernel_sse4.cpp PROPERTIES COMPILE_OPTIONS "-msse4.2")
  set_source_files_properties(${dir}/kernel_avx2.cpp PROPERTIES COMPILE_OPTIONS "-mavx2;-mf16c")
  set_source_files_properties(${dir}/kernel_avx512.cpp PROPERTIES COMPILE_OPTIONS "-mavx512f;-mavx512vl;-mavx512dq;-mavx512bw;-mavx512cd")
  # UBSan reads the one source of all kernels in the scalar build; in the others it triples the time to compile.
  if(CRESCENT_SANITIZE)
    foreach(isa sse4 avx2 avx512)
      set_property(SOURCE ${dir}/kernel_${isa}.cpp APPEND PROPERTY COMPILE_OPTIONS "-fno-sanitize=undefined")
    endforeach()
  endif()
endif()
