// A test that fails beyond chance is drawn anew before it counts; one for whose fresh draws questions ran out is noted.
#include "trials/trial_context.h"

#include <algorithm>

namespace crescent::inline trials {

void TrialContext::redraw(std::uint32_t seed) {
    Integrals::redraw(seed);
    kept = {};
}

void TrialContext::note_unconfirmed(double p_first) const {
    if (p_first < settings.screen * settings.confirm && confirmed_by_fewer())
        unconfirmed_ = std::min(unconfirmed_, p_first);
}

Verdict TrialContext::verdict(std::string_view name, State state, std::string say) const {
    Verdict v;
    v.arm = trial.arm;
    v.trial = trial.text();
    v.name = name;
    v.state = state;
    v.say = std::move(say);
    return v;
}

}  // namespace crescent::inline trials
