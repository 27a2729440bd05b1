// A context of OSMesa, which renders on the CPU.
#pragma once

#include <memory>

#include "context.h"

namespace crescent::gl {

std::unique_ptr<Context> open_osmesa();

}  // namespace crescent::gl
