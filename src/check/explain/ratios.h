// Ratios that are known without noise, as of a weight over f cos / p at a draw: which constant or factor they are.
#pragma once

#include "check/explain/factors.h"

#include <optional>
#include <span>

namespace crescent::check {

/// What was given over what is due for one pair of directions; positive.
struct KnownRatio {
    Vec3d wo{}, wi{};
    double value = 1;
    double error = 0;  // relative
};

struct RatioCause {
    std::string name;  // "constant", "cos theta_i"
    double exponent = 0, constant = 1;
    double explained = 0;  // share of the ratios
};

/// Nine of ten are a constant, or a constant times a simple power of one factor; none where half of them are 1.
std::optional<RatioCause> explain_ratios(std::span<const KnownRatio> ratios, std::span<const Factor> factors);

}  // namespace crescent::check
