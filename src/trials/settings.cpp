// How levels are shared over the tests of a call, and what the full mode has more of.
#include "trials/settings.h"

#include <algorithm>
#include <cmath>

#include "math/functions.h"

namespace crescent::inline trials {

TestSettings TestSettings::thorough() {
    TestSettings r;
    r.full = true;
    r.draws = std::uint64_t{1} << 19;
    r.rings = 30;
    r.sectors = 32;
    r.evaluations = 1000000;
    r.questions = 6000000;
    r.questions_in_all = 72000000;
    return r;
}

void TestSettings::share(std::uint64_t tests) {
    const double each = -math::expm1(math::log1p(-alpha) / static_cast<double>(std::max<std::uint64_t>(tests, 1)));
    screen = std::min(std::sqrt(10 * each), 0.05);
    confirm = std::min(each / screen, screen / 10);
}

}  // namespace crescent::inline trials
