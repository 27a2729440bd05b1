// Whether pdf(w) and f(w) are random estimates that are right only in the mean, such as those of layered surfaces.
// Then two answers for one direction differ or, if their random numbers are a hash of the direction, answers for
// neighbouring directions do not converge as the directions do.
#pragma once

#include "check/estimate/source.h"

namespace crescent::check {

struct EvaluationNoise {
    double pdf_noise = 0, f_noise = 0;  // median relative difference of two answers; 0: no estimate
    bool hashed = false;
    bool pdf() const { return pdf_noise > 0; }
    bool f() const { return f_noise > 0; }
};

/// Uses a few hundred answers, at drawn directions and over the whole sphere.
EvaluationNoise look_for_noise(Source& source, const StreamKey& key);
/// None if nothing is an estimate.
Sentences sentences_of(const EvaluationNoise& noise);

}  // namespace crescent::check
