// A check written out, and held: five ways to compare two doubles.
#include "experiment/comparison.h"

#include <fmt/format.h>

#include <cmath>

namespace crescent::inline experiment {

std::string to_string(const ParsedQuantity& q) {
    if (q.number) return fmt::format("{}", *q.number);
    std::string text = q.word;
    if (!q.region.empty()) text += "." + q.region;
    if (q.subject.empty()) return text;
    text += "(" + q.subject;
    if (q.n > 0) text += fmt::format(", n={}", q.n);
    if (q.s > 0) text += fmt::format(", s={}", q.s);
    return text + ")";
}

std::string to_string(const Comparison& c) {
    return fmt::format("{} {} {}", to_string(c.left), c.op, to_string(c.right));
}

bool holds(double left, std::string_view op, double right) {
    if (std::isnan(left) || std::isnan(right)) return false;
    if (op == "<") return left < right;
    if (op == "<=") return left <= right;
    if (op == ">") return left > right;
    if (op == ">=") return left >= right;
    return op == "==" && left == right;
}

}  // namespace crescent::inline experiment
