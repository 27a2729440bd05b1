// The kernels for sse4; the flags stand in settings.cmake.
#define CRESCENT_ISA sse4
#include "simd/pack.h"
// clang-format off
#include "estimator/kernel_body.h"

namespace crescent {

KernelTable sse4_kernels() { return sse4::kernels_of<sse4::Pack>("sse4", Arms{}); }

}  // namespace crescent
