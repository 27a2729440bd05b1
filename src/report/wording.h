// Which arms a report sets against each other, and sentences on what they are. All of it follows from the arms' manuals
// and from what was measured.
#pragma once

#include <string>

#include "report/page.h"

namespace crescent::inline report {

/// An arm about the normal and one about the mirror direction that ran at one N; of several about the normal, the one
/// that shares most sample counts with the other, and then the one with the smallest errors.
struct ArmPair {
    const ArmPlan *broad = nullptr, *narrow = nullptr;
    std::uint64_t n = 0;
    explicit operator bool() const { return broad && narrow && n > 0; }
};
/// The narrow and the broad arm that the report tells apart.
ArmPair arm_pair(const Page& page);

/// Arms about the normal that join no others.
std::vector<const ArmPlan*> arms_about_normal(const Experiment& experiment);

/// The first arm about the mirror direction; null where there is none.
const ArmPlan* arm_about_mirror(const Experiment& experiment);

/// "phong, N = 64, s = 32"; s where it says something.
std::string run_html(const RunKey& key, const Experiment& experiment);

/// On arms whose N counts pairs, and on those that cannot reach all light; "" where there are none.
std::string ray_words(const Experiment& experiment);
std::string bias_words(const Experiment& experiment);

}  // namespace crescent::inline report
