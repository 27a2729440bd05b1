// The kernels for one plain float at a time: no intrinsics; the others are compared with it.
#define CRESCENT_ISA scalar
#include "render/kernel_body.h"

namespace crescent::inline render {

KernelTable scalar_kernels() { return scalar::kernels_of<float>("scalar", Samplers{}); }

}  // namespace crescent::inline render
