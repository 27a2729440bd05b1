// Which arms and regions of an experiment play which part in the film.
#pragma once

#include <string>
#include <vector>

#include "crescent/crescent.h"

namespace crescent::explainer {

/// The names under which the experiment has what the film tells of.
struct Cast {
    std::string uniform;              // "": the experiment has no such arm
    std::string cosine, phong;        // the two arms of the story
    std::string mixture, mis;         // what goes beyond it; the film adds them where the experiment has none
    std::string highlight, surround;  // regions: the first, the largest of the others
    double s = 0;                     // the experiment's
    std::uint64_t n = 0;              // samples a pixel where none is named
    std::uint32_t seed = 0;
    std::vector<std::uint64_t> sample_counts;  // that cosine and phong share, ascending
};

/// Adds the arms that go beyond the story to `experiment` and says who is who. InputError with everything that is
/// missing.
Cast cast_of(Experiment& experiment);

}  // namespace crescent::explainer
