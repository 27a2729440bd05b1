// The choice of what is tested again, and the second test.
#include "check/decide/two_stages.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace crescent::check {

std::vector<Least> suspects_of(
    const VisitAll& visit_all, const std::map<Family, Least>& least_answers, double level, double draws) {
    struct Suspect {
        double errors;  // of its difference
        Least candidate;
    };
    std::map<Family, Suspect> suspects;
    for (const auto& [family, member] : least_answers)
        if (member.p() < level) suspects[family] = {-1, member};
    if (suspects.empty()) return {};
    visit_all([&](const Answer& a) {
        const auto suspect = suspects.find(a.family);
        if (suspect == suspects.end() || a.p * suspect->second.candidate.members >= level) return;
        const double d = std::fabs(a.difference);
        const double errors = std::max(d - a.floor, 0.0) / std::sqrt(a.sd * a.sd + d / draws + 1e-300);
        if (errors <= suspect->second.errors) return;
        suspect->second.errors = errors;
        suspect->second.candidate.answer = a;
    });
    std::vector<Least> out;
    for (const auto& [family, suspect] : suspects) out.push_back(suspect.candidate);
    return out;
}

Answer retest(const VisitAll& visit_all, const Answer& first) {
    if (first.family == Family::values || first.family == Family::corners) return first;
    Answer out = same_member(visit_all, first);
    const bool is_two_sided = out.p > 0 && first.family != Family::depth;
    if (is_two_sided) out.p = one_sided(first, out);
    return out;
}

}  // namespace crescent::check
