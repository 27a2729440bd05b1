// The density that the draws of a sampler without pdf(w) imply: their share in a cell over its solid angle, with its
// standard error.
#pragma once

#include "check/decide/check_at.h"
#include "check/verdict.h"

namespace crescent::check {

/// Adds the implied density to the verdict on the density: by cells of the tree, by rings about n, and at its maximum.
void note_implied_density(const CheckAt& c, Verdict& v);

}  // namespace crescent::check
