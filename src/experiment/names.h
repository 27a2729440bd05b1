// The words an experiment may use for samplers; arms/all.h holds the samplers themselves, and a law holds the two
// equal.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace crescent {

/// Every sampler an arm can name.
std::vector<std::string> sampler_names();

/// Where the films of an arm at exponent s go under films/, without .exr: the arm's name, followed by an s that is not
/// the experiment's own. The references have a file beside them.
std::string film_file(std::string_view arm, double s, double own_s);
inline constexpr std::string_view reference_file = "reference";

/// Whether the sampler is steered by an exponent s.
bool sampler_needs_s(std::string_view sampler);

}  // namespace crescent
