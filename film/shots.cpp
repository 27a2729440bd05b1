#include "shots.h"

namespace crescent::film {

std::vector<Shot> shots_of(const Data& data) {
    using Make = Shot (*)(const Data&);
    constexpr Make makes[] = {
        title,      // 1
        one_pixel,  // 3
        same_randoms, firefly, heavy_tail, tilt,
    };
    std::vector<Shot> shots;
    for (const Make make : makes)
        if (Shot shot = make(data); shot.seconds > 0) shots.push_back(std::move(shot));
    return shots;
}

}  // namespace crescent::film
