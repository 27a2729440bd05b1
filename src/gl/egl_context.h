// Contexts of EGL without a surface, and the devices that it has.
#pragma once

#include <memory>
#include <vector>

#include "context.h"
#include "crescent/crescent.h"

namespace crescent::gl {

std::unique_ptr<Context> open_egl(int device);
/// Returns none if EGL is missing.
std::vector<BackendDevice> egl_devices();

}  // namespace crescent::gl
