// A sampler of points of another domain than directions that the page's user writes in JavaScript, as an adapter for
// `check`.
#pragma once

#include <memory>

#include "api.h"

namespace crescent::web {

/// The sampler of the page's functions over the domain that they declare; none if that is of directions.
std::shared_ptr<const SamplerAdapter> page_point_sampler();

}  // namespace crescent::web
