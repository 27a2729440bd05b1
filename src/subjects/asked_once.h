// A sampler that is asked for the same thing once: what p and f are at a pair of directions is kept as long as a trial
// lasts. Integrals of one trial start from the same cells, so that a sampler answers for their nodes a single time.
#pragma once

#include <array>
#include <memory>

#include "subjects/subject.h"

namespace crescent::inline subjects {

/// `sampler`, with its answers for quadrature and for f kept, and those that it gives counted; for one thread. draws:
/// those for the same u, and pdf(w) at them, are kept too.
std::shared_ptr<const JudgedSampler> asked_once(std::shared_ptr<const JudgedSampler> sampler, bool draws = false);
/// What answers anew, whatever was kept.
const JudgedSampler& afresh(const JudgedSampler& sampler);

/// One side of a comparison and the stream that it draws from.
struct Side {
    Trial trial;
    std::uint32_t stream = 0;
};

/// A program is asked once at each w_o: its answers and its draws there serve every trial that has this w_o, whatever
/// the surface and the light of the other side are. Trials of one w_o come one after the other.
class AskedByDirection {
public:
    Side of(const Trial& trial, std::uint32_t stream);

private:
    std::shared_ptr<const JudgedSampler> asked_, kept_;
    std::array<double, 3> wo_{};
    std::uint32_t stream_ = 0;
};

}  // namespace crescent::inline subjects
