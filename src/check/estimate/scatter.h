// Whether pdf(w) and f(w) are random estimates that are right only in the mean, such as those of layered surfaces. Then
// two answers for one direction differ or, if their random numbers are a hash of the direction, answers for
// neighbouring directions do not converge as the directions do.
#pragma once

#include <string>
#include <vector>

#include "check/estimate/source.h"

namespace crescent::check {

struct EvaluationNoise {
    double of_pdf = 0, of_f = 0;  // median relative difference of two answers; 0: no estimate
    bool hashed = false;
    bool pdf() const { return of_pdf > 0; }
    bool f() const { return of_f > 0; }
};

/// Uses a few hundred answers, at drawn directions and over the whole sphere.
EvaluationNoise look_for_noise(Source& source, const StreamKey& key);
/// A sentence; "" if nothing is an estimate.
std::string text_of(const EvaluationNoise& scatter);

// ---- The reciprocity of f if no index is stated: f or f |cos| is symmetric, so that no index scales it across the
// surface, or neither is.

enum class BothWays { not_known, same_f, phase_function };

/// Evaluates f at pairs of directions. A phase function, given as f |cos|, is positive in every direction. For a
/// sampler that takes only w_o above the surface, only pairs above it are exchanged.
BothWays both_ways(const SamplerAdapter& adapter, StreamKey key);

// ---- Steps of the direction in single precision: a cosine next to 1 takes few values, so that draws lie on rings
// about an axis.

/// The next change of w(u), for a draw that does not change while one of its numbers moves by an ulp.
struct LocalStep {
    double jump = 0;  // an angle; 0 if there is none, or if single precision does not explain it
    Vec3d next{};
};
/// w: the draws at u. Returns steps for all of them, or for the first ones only.
std::vector<LocalStep> local_steps(Source& source, const std::vector<PrimarySample>& u, const std::vector<Vec3d>& w);

}  // namespace crescent::check
