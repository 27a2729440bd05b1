// Whether pdf(w) and f(w) are random estimates, right in the mean alone, as those of layered surfaces are: two answers
// to one question differ, or, where they hash their random numbers from the question, answers for neighbouring
// directions do that do not come together as the directions do.
#pragma once

#include <string>
#include <vector>

#include "check/estimate/source.h"

namespace crescent::check {

struct EvaluationNoise {
    double of_pdf = 0, of_f = 0;  // median relative difference of two answers; 0: they are no estimates
    bool hashed = false;
    bool pdf() const { return of_pdf > 0; }
    bool f() const { return of_f > 0; }
};

/// A few hundred answers, at directions that are drawn and all over the sphere.
EvaluationNoise look_for_noise(Source& source, const StreamKey& key);
/// A sentence; "" where nothing is an estimate.
std::string text_of(const EvaluationNoise& scatter);

// ---- What f is the other way round, where no index is stated: the same as f or as f |cos|, so that none scales it
// across the surface, or neither.

enum class BothWays { not_known, same_f, phase_function };

/// By f at pairs of directions. A phase function, given as f |cos|, is positive in every direction; of a sampler that
/// takes w_o above the surface alone, only pairs above are turned round.
BothWays both_ways(const SamplerAdapter& adapter, StreamKey key);

// ---- Where single precision makes a direction a step function of the random numbers: a cosine next to 1 takes few
// values, so that draws lie on rings about an axis.

/// Where w(u) jumps to when it next changes, for a draw that stays the same while one of its numbers moves by an ulp.
struct LocalStep {
    double jump = 0;  // an angle; 0 where there is none, or where single precision does not explain it
    Vec3d next{};
};
/// w: the draws at u. As many as were looked at: all, or the first of them.
std::vector<LocalStep> local_steps(Source& source, const std::vector<PrimarySample>& u, const std::vector<Vec3d>& w);

}  // namespace crescent::check
