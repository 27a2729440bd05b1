// f and variances of two samplers beside one another.
#pragma once

#include "check/against_draws.h"
#include "check/constants.h"
#include "check/decide/check_at.h"
#include "check/verdict.h"

namespace crescent::check {

/// What a comparison at one w_o is made of.
struct AgainstCase {
    const AgainstSide &a, &b;
    const CommonGround& ground;
    const AgainstDraws &draws_a, &draws_b;
    const CheckAt &own_a, &own_b;  // of each by itself
    std::uint32_t of_f = 0;
    Levels levels;
    bool expect_same = false;
};

/// Whether f is the same at directions all over and where either draws, and q times weight of each delta part.
void compare_f(const AgainstCase& c, Verdict& v);
/// Var X_A / Var X_B, where they are of one integral and neither sampler is wrong itself. of_f: what compare_f found.
void compare_variances(const AgainstCase& c, const Verdict& of_f, Verdict& v);

}  // namespace crescent::check
