# WebAssembly with its 128-bit vectors, through clang, wasi-libc and libc++. No relaxed vectors: their results depend on
# the machine.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR wasm32)
set(CMAKE_CXX_COMPILER clang++-19)
set(CMAKE_CXX_COMPILER_TARGET wasm32-wasi)
set(CMAKE_CXX_FLAGS_INIT "-msimd128 -mno-relaxed-simd")
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
