// The names of states, and the state of all verdicts of a call: wrong before error, error before inconclusive.
#include "check/verdict.h"

namespace crescent::inline results {

std::string_view word(State state) {
    switch (state) {
        case State::right: return "right";
        case State::wrong: return "wrong";
        case State::inconclusive: return "inconclusive";
        case State::skipped: return "skipped";
        case State::error: return "error";
    }
    return "";
}

void note_first_failure(const std::string& what, Verdict& v) {
    v.first_failure = true;
    v.evidence["first_fault"] = what;
}

void next_step(CheckResult& j) {
    bool wrong = !j.unmet.empty(), error = false, doubt = false;
    j.as_expected = j.unmet.empty();
    for (const Verdict& v : j.verdicts) {
        if (v.waived) continue;
        wrong = wrong || v.state == State::wrong;
        error = error || v.state == State::error;
        doubt = doubt || v.state == State::inconclusive;
        j.as_expected = j.as_expected && v.expected;
    }
    j.state = wrong ? State::wrong : error ? State::error : doubt ? State::inconclusive : State::right;
}

}  // namespace crescent::inline results
