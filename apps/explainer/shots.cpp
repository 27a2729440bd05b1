// The order of the video is a table of functions; each is called once with the data.
#include "shots.h"

namespace crescent::explainer {

std::vector<Shot> shots_of(const Data& data) {
    using Make = Shot (*)(const Data&);
    constexpr Make makes[] = {
        title,
        columns,
        one_pixel,
        same_randoms,
        firefly,
        ladder_cosine,
        ladder_phong,
        heat,
        failure_b,
        heavy_tail,
        tilt,
        exponent,
        seeds,
        beyond,
        claims,
        closing,
    };
    std::vector<Shot> shots;
    for (const Make make : makes)
        if (Shot shot = make(data); shot.seconds > 0) shots.push_back(std::move(shot));
    return shots;
}

}  // namespace crescent::explainer
