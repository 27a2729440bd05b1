// The roles of an experiment's arms and regions in the video.
#pragma once

#include <string>
#include <vector>

#include "crescent/crescent.h"

namespace crescent::explainer {

/// The names in the experiment of what the video shows.
struct Cast {
    std::string uniform;              // "": the experiment has no such arm
    std::string cosine, phong;        // the two main arms
    std::string mixture, mis;         // further arms; added if the experiment has none
    std::string highlight, surround;  // regions: the first, the largest of the others
    double s = 0;                     // the experiment's
    std::uint64_t n = 0;              // default samples per pixel
    std::uint32_t seed = 0;
    std::vector<std::uint64_t> sample_counts;  // common to cosine and phong, ascending
};

/// Adds the further arms to `experiment` and returns the roles. InputError with everything that is missing.
Cast cast_of(Experiment& experiment);

}  // namespace crescent::explainer
