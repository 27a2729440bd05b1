// Two samplers are asked in turn: what breaks off says which of them it was.
#pragma once

#include <memory>
#include <string>

#include "subjects/subject.h"

namespace crescent::inline subjects {

/// `sampler`, whose faults begin with `side`, "A", and its name; a fault that has a side already keeps it. What is
/// recorded, or cannot fail, is given back as it is.
std::shared_ptr<const JudgedSampler> named_side(std::shared_ptr<const JudgedSampler> sampler, const std::string& side);

}  // namespace crescent::inline subjects
