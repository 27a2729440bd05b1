// The words of each front end for one step stand side by side.
#include "judgements/next_step.h"

#include <array>
#include <fmt/format.h>

namespace crescent::inline judgements {

namespace {

/// By front end.
using Words = std::array<const char*, 3>;
constexpr Words thorough = {"--full", "crescent::IsARightSamplerBy(crescent::TestSettings::thorough())", "full=True"};
constexpr Words time = {"--patience SECONDS", "a sampler that answers faster", "patience=SECONDS"};
constexpr Words accept = {"--allow-inconclusive", "crescent::IsNotAWrongSampler()", "state != 'wrong'"};

std::string named(const Words& words, FrontEnd front_end) { return words[static_cast<std::size_t>(front_end)]; }

}  // namespace

std::string settling(const Verdict& v, FrontEnd front_end) {
    switch (v.next.kind) {
        case NextStep::Kind::none: return v.settle;
        case NextStep::Kind::more_draws:
            return named(thorough, front_end) + " draws more" +
                (v.next.times > 0 ? fmt::format(" (about {:.2g} times as many draws are needed).", v.next.times) : ".");
        case NextStep::Kind::more_time: return named(time, front_end) + ": there was no time to look at all of it.";
        case NextStep::Kind::heavier_pdf:
            return "a pdf that falls off no faster than f; " + named(accept, front_end) + " accepts a heavy tail.";
    }
    return v.settle;
}

std::string one_wo_text(std::pair<double, double> wo, FrontEnd front_end) {
    const auto [theta, azimuth] = wo;
    switch (front_end) {
        case FrontEnd::command_line: return fmt::format("--wo {:g},{:g} judges this w_o alone.", theta, azimuth);
        case FrontEnd::cpp:
            return fmt::format(
                "crescent::IsARightSamplerBy(settings) with settings.wo = {{{{{:g}, {:g}}}}} judges "
                "this w_o alone.",
                theta, azimuth);
        case FrontEnd::python: return fmt::format("wo_deg=[({:g}, {:g})] judges this w_o alone.", theta, azimuth);
    }
    return "";
}

}  // namespace crescent::inline judgements
