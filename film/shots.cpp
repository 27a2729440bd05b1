#include "shots.h"

namespace crescent::film {

std::vector<Shot> shots_of(const Data& data) {
    using Make = Shot (*)(const Data&);
    constexpr Make makes[] = {
        title,
    };
    std::vector<Shot> shots;
    for (const Make make : makes) shots.push_back(make(data));
    return shots;
}

}  // namespace crescent::film
