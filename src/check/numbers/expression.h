// Expressions of constants, such as exp(-1.7) or 2 * pi / 3, for expected values.
#pragma once

#include <string>
#include <string_view>

namespace crescent {

/// The value of an expression: numbers, pi, e, + - * / ^, parentheses, and exp, log, sqrt, sin, cos, tan, abs.
/// Throws std::invalid_argument with the column and what was expected.
double constant_value(std::string_view text);

}  // namespace crescent
