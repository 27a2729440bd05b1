// A check as plain data: two quantities of a run, or a quantity and a number, and how they are compared. The text of
// one is read in quantity_text.h.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace crescent::inline experiment {

/// One side of a check. n = 0: not said; s = 0: the experiment's own.
struct ParsedQuantity {
    std::string word, region, subject;
    std::uint64_t n = 0;
    double s = 0;
    std::optional<double> number = {};  // a plain number; the rest is empty then
};

/// left op right.
struct Comparison {
    ParsedQuantity left, right;
    std::string op;  // "<", "<=", ">", ">=", "=="; "": nothing was parsed yet
};

/// The quantity in full, as parse_quantity reads it.
std::string to_string(const ParsedQuantity& quantity);
/// "left op right", as parse_comparison reads it.
std::string to_string(const Comparison& comparison);

/// Whether left op right. No comparison with NaN holds.
bool holds(double left, std::string_view op, double right);

}  // namespace crescent::inline experiment
