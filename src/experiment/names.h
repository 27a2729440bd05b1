// The names of the files that films go into.
#pragma once

#include <string>
#include <string_view>

namespace crescent::inline experiment {

/// Where the films of an arm at exponent s go under films/, without .exr: the arm's name, followed by an s that is not
/// the experiment's own. The references have a file beside them.
std::string film_file(std::string_view arm, double s, double own_s);
inline constexpr std::string_view reference_file = "reference";

}  // namespace crescent::inline experiment
