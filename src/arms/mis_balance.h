// mis-balance: BRDF mixture and light by area, two samples, balance heuristic.
//   w_i = p_i / (p_1 + p_2)      Veach & Guibas 1995, eq. (11) with one sample from each.
#pragma once

#include "arms/mis.h"

namespace crescent::inline arms {

struct BalanceHeuristic {
    /// 1 / (1 + other/own): no overflow for large densities; own = 0 was not drawn and weighs 0.
    template <class F> static F weight(F own, F other) {
        const auto drawn = own > number<F>(0);
        return select(drawn, number<F>(1) / (number<F>(1) + other / select(drawn, own, number<F>(1))), number<F>(0));
    }
};

template <class F> struct MisBalance : TwoSampleMis<F, BalanceHeuristic> {
    static constexpr std::string_view name = "mis-balance";
    static constexpr ArmManual manual = {.label = name,
        .summary = "mixture and light-area, a direction of each, weighed by the balance heuristic",
        .formula = R"(w_i=\frac{p_i}{p_1+p_2})",
        .density = R"(p_1,p_2)",
        .draw = "a direction by mixture and one by light-area, balance heuristic",
        .axis = "both",
        .needs_s = true,
        .combines = true,
        .trials = mis_trials,
        .gl = {5e-6, "as mixture; weights are at most 1"}};
    static ExpectedBehaviour theory(const TrialPoint&) { return {.bounded = true}; }
    using TwoSampleMis<F, BalanceHeuristic>::TwoSampleMis;
};

}  // namespace crescent::inline arms
