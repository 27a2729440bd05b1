// mis-power: BRDF mixture and light by area, two samples, power heuristic.
//   w_i = p_i^2 / (p_1^2 + p_2^2)      Veach & Guibas 1995, eq. (13) with beta = 2.
#pragma once

#include "arms/mis.h"

namespace crescent::inline arms {

struct PowerHeuristic {
    template <class F> static F weight(F own, F other) {
        const auto drawn = own > number<F>(0);
        return select(
            drawn, number<F>(1) / (number<F>(1) + sqr(other / select(drawn, own, number<F>(1)))), number<F>(0));
    }
};

template <class F> struct MisPower : TwoSampleMis<F, PowerHeuristic> {
    static constexpr std::string_view name = "mis-power";
    static constexpr ArmManual manual = {.label = name,
        .summary = "mixture and light-area, a direction of each, weighed by the power heuristic",
        .formula = R"(w_i=\frac{p_i^2}{p_1^2+p_2^2})",
        .density = R"(p_1,p_2)",
        .draw = "a direction by mixture and one by light-area, power heuristic",
        .axis = "both",
        .needs_s = true,
        .combines = true,
        .trials = mis_trials,
        .gl = {5e-6, "as mixture; weights are at most 1"}};
    static ExpectedBehaviour theory(const TrialPoint&) { return {.bounded = true}; }
    using TwoSampleMis<F, PowerHeuristic>::TwoSampleMis;
};

}  // namespace crescent::inline arms
