// Without pdf(w) the draws are compared with f alone, by their weights; where these are missing too, nothing says
// whether the draws are right.
#include "check/report/limits.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "check/constants.h"
#include "check/report/implied.h"

namespace crescent::check {

namespace {

bool comes_weighted(const CheckAt& c) { return c.observations.weighed > 0 && c.observations.weightless == 0; }

void note_density(const SamplerAdapter& sampler, const CheckAt& c, Verdict& v) {
    note_implied_density(c, v);
    v.state = State::skipped;
    const bool of_deltas = static_cast<double>(c.observations.checks.deltas) == c.observations.independent;
    if (of_deltas || (sampler.has_f() && comes_weighted(c))) return;
    v.state = State::inconclusive;
    v.message += fmt::format(" There is {}: whether the draws are right could not be examined.",
        comes_weighted(c) ? "no f either" : "no weight with the draws either");
    v.next_step = comes_weighted(c) ? "f(w), which the mean of the weights is compared with."
                                    : "pdf(w), or f(w) and a weight, f |cos| / p, with each draw (weight=yes).";
}

void note_mean(const SamplerAdapter& sampler, const CheckAt& c, Verdict& v) {
    const bool asked = std::ranges::any_of(c.answers, [](const Answer& a) { return a.family == Family::mean; });
    if (asked) return;
    if (c.observations.weightless > 0) {
        v.state = State::skipped;
        v.message = "The draws come with neither a pdf nor a weight.";
    } else if (comes_weighted(c) && (!sampler.traits().has_pdf || c.scatter.pdf() || c.scatter.f())) {
        v.state = State::inconclusive;
        v.message = "The weights have a heavy tail: their mean has no known error.";
        v.next_step = "Draws whose weights are bounded.";
    }
}

/// A file says how its rows were used, and how many would do.
void note_rows(const CheckAt& c, Verdict& v) {
    if (v.name == "density") {
        v.evidence["rows_compared"] = c.observations.independent;
        v.message += fmt::format("{}One row in eight shapes the tree, four are compared with p, three confirm.",
            v.message.empty() ? "" : " ");
    }
    if (v.state != State::inconclusive || c.sizes.constant == std::nullopt) return;
    v.next = {};
    const double times = worst_ratio(c.sizes) / inconclusive_at;
    if (times > 1)
        v.next_step =
            fmt::format("About {:.2g} rows, and a table as fine.", 2 * c.observations.independent * times * times);
}

}  // namespace

void note_limits(const SamplerAdapter& sampler, const CheckAt& c, Verdict& v) {
    if (v.state == State::wrong) return;
    if (v.name == "density" && !sampler.traits().has_pdf) note_density(sampler, c, v);
    if (v.name == "mean" && sampler.has_f()) note_mean(sampler, c, v);
    if (v.name == "valid") v.message += text_of(c.scatter);
    if (!sampler.can_draw()) note_rows(c, v);
}

}  // namespace crescent::check
