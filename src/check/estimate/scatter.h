// Whether pdf(w) and f(w) are random estimates, right in the mean alone, as those of layered surfaces are: two answers
// to one question differ, or, where they hash their random numbers from the question, answers for neighbouring
// directions do that do not come together as the directions do.
#pragma once

#include <string>

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

}  // namespace crescent::check
