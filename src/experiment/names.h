// The words an experiment may use for samplers; arms/all.h holds the samplers themselves, and a law holds the two equal.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace crescent {

/// Every sampler an arm can name.
std::vector<std::string> sampler_names();

/// Whether the sampler is steered by an exponent s.
bool sampler_needs_s(std::string_view sampler);

}  // namespace crescent
