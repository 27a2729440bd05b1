// The kernels for avx2; the flags stand in settings.cmake.
#define CRESCENT_ISA avx2
#include "simd/pack.h"
// clang-format off
#include "estimator/kernel_body.h"

namespace crescent {

KernelTable avx2_kernels() { return avx2::kernels_of<avx2::Pack>("avx2", Arms{}); }

}  // namespace crescent
