// The list of instruction sets with kernels. kernels.cmake reads it too: it makes kernel_NAME.cpp for each set of the
// target processor, with -mFEATURE for every feature that is named here.
//
// isa(name, what a machine must have), in rising order of speed; scalar, which needs nothing, comes before all of them.
#pragma once

// clang-format off: one a line
#define CRESCENT_ISAS_X86(isa)                                                  \
    isa(sse4, has("sse4.2"))                                                    \
    isa(avx2, has("avx2") && has("f16c"))                                       \
    isa(avx512, has("avx512f") && has("avx512vl") && has("avx512dq") && has("avx512bw") && has("avx512cd"))
// clang-format on
#define CRESCENT_ISAS_ARM(isa) isa(neon, true)
#define CRESCENT_ISAS_WASM(isa) isa(wasm128, has("simd128"))

#if defined(CRESCENT_SCALAR)
#define CRESCENT_ISAS(isa)
#elif defined(__x86_64__)
#define CRESCENT_ISAS(isa) CRESCENT_ISAS_X86(isa)
#define CRESCENT_MACHINE_HAS(feature) (__builtin_cpu_supports(feature) != 0)
#elif defined(__aarch64__)
#define CRESCENT_ISAS(isa) CRESCENT_ISAS_ARM(isa)
#elif defined(__wasm_simd128__)
#define CRESCENT_ISAS(isa) CRESCENT_ISAS_WASM(isa)
#else
#define CRESCENT_ISAS(isa)
#endif
#ifndef CRESCENT_MACHINE_HAS
#define CRESCENT_MACHINE_HAS(feature) true  // required by the compiler flags
#endif
