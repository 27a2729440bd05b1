// The arms that a report compares, and sentences about them. All of it follows from SamplerInfo and from the
// measurements.
#pragma once

#include <string>

#include "base/text.h"
#include "report/page.h"

// The few pieces of markup that sentences contain.
namespace crescent::html {

/// A number in a sentence keeps its digits together and in tabular figures.
inline std::string value(std::string_view text) { return "<span class=\"v\">" + escape(with_minus(text)) + "</span>"; }
/// In the place of an interval.
inline std::string heavy_tail() { return "<span class=\"heavy\">heavy tail</span>"; }

}  // namespace crescent::html

namespace crescent::inline report {

/// An arm about the normal and one about the mirror direction that ran at one N; among several about the normal, the
/// one that shares most sample counts with the other, then the one with the smallest errors.
struct ArmPair {
    const ArmPlan *broad = nullptr, *narrow = nullptr;
    std::uint64_t n = 0;
    explicit operator bool() const { return broad && narrow && n > 0; }
};
/// Returns the narrow and the broad arm that the report compares.
ArmPair arm_pair(const Page& page);

/// Returns the arms about the normal that combine no others.
std::vector<const ArmPlan*> arms_about_normal(const Experiment& experiment);

/// Returns the first arm about the mirror direction; null if there is none.
const ArmPlan* arm_about_mirror(const Experiment& experiment);

/// Returns "phong, N = 64, s = 32"; s only if it identifies a run.
std::string run_html(const RunKey& key, const Experiment& experiment);

/// Returns remarks on arms whose N counts pairs, and on those that cannot reach all light; "" if there are none.
std::string ray_words(const Experiment& experiment);
std::string bias_words(const Experiment& experiment);

}  // namespace crescent::inline report
