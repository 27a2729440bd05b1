// The kernels for avx512; the flags stand in settings.cmake.
#define CRESCENT_ISA avx512
#include "simd/pack.h"
// clang-format off
#include "estimator/kernel_body.h"

namespace crescent {

KernelTable avx512_kernels() { return avx512::kernels_of<avx512::Pack>("avx512", Arms{}); }

}  // namespace crescent
