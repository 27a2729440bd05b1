// The kernels for one float at a time, without intrinsics; the other kernels are compared with them.
#define CRESCENT_ISA scalar
#include "render/kernel_body.h"

namespace crescent::inline render {

KernelTable scalar_kernels() { return scalar::kernels_of<float>("scalar", Samplers{}); }

}  // namespace crescent::inline render
