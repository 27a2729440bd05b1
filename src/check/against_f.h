// f and variances of two samplers.
#pragma once

#include <cstdint>

#include "check/against_draws.h"
#include "check/constants.h"
#include "check/decide/check_at.h"
#include "check/verdict.h"

namespace crescent::check {

/// The inputs of a comparison at one w_o.
struct AgainstCase {
    const AgainstSide &a, &b;
    const CommonPlan& common;
    const SamplerDraws &draws_a, &draws_b;
    const CheckAt &check_a, &check_b;  // checks of each sampler alone
    std::uint32_t f_draws = 0;
    Levels levels;
    bool expect_same = false;
};

/// Tests whether f is the same at directions over the whole sphere and at draws of either sampler, and q times weight
/// of each delta part.
void compare_f(const AgainstCase& c, Verdict& v);
/// Var X_A / Var X_B if both estimate the same integral and neither sampler is wrong. f_verdict: result of compare_f().
void compare_variances(const AgainstCase& c, const Verdict& f_verdict, Verdict& v);

}  // namespace crescent::check
