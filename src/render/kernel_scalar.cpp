// The kernels for one float at a time, without intrinsics; the other kernels are compared with them.
#define CRESCENT_ISA scalar
#include "render/flip_kernel_body.h"
#include "render/kernel_body.h"

namespace crescent {

KernelTable scalar_kernels() { return scalar::kernels_of<float>("scalar", Samplers{}); }
FlipKernel scalar_flip() { return scalar::compute_flip<float>; }

}  // namespace crescent
