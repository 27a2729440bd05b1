// The two stages of a test: the member of each family with the least p, and a second test of the same member.
// `visit_all` visits every member of all families; an answer has a family, a member, a difference and a p.
#pragma once

#include <algorithm>
#include <map>

namespace crescent::check {

/// For one family, with the number of its members.
template <class Answer> struct LeastOf {
    Answer answer{};
    double members = 0;
    double p() const { return std::min(1.0, answer.p * members); }
};

template <class Answer, class VisitAll> auto least_by_family(const VisitAll& visit_all) {
    std::map<decltype(Answer::family), LeastOf<Answer>> out;
    visit_all([&](const Answer& a) {
        LeastOf<Answer>& least = out[a.family];
        if (least.members++ == 0 || a.p < least.answer.p) least.answer = a;
    });
    return out;
}

/// With p = 1 if the member does not exist any more.
template <class Answer, class VisitAll> Answer same_member(const VisitAll& visit_all, const Answer& first) {
    Answer out = first;
    out.p = 1;
    visit_all([&](const Answer& a) {
        if (a.family == first.family && a.member == first.member) out = a;
    });
    return out;
}

/// The one-sided p of `again` for a difference with the sign of the first one.
template <class Answer> double one_sided(const Answer& first, const Answer& again) {
    return (again.difference > 0) == (first.difference > 0) ? again.p / 2 : 1;
}

}  // namespace crescent::check
