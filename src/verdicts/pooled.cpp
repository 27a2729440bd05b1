// Four contrasts of the draws at each w_o, in standard errors, less what the integrals leave open. Their squares are
// added up over all w_o of an arm, chi-square; what fails is drawn anew before it is told.
#include "verdicts/pooled.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "math/functions.h"
#include "simd/random.h"
#include "stats/p_values.h"
#include "subjects/faults.h"
#include "trials/contrasts.h"
#include "verdicts/outcome.h"

namespace crescent::inline verdicts {

namespace {

constexpr const char* names[contrast_count] = {
    "the mean of log p", "how near to the axis they fall", "the cosine of their azimuth", "the sine of their azimuth"};

/// Draws of a fresh seed at each of `count` w_o: four times as many; of a limited sampler as many again, as far as what
/// it may be asked in all allows, a sample and its pdf each.
std::uint64_t fresh_draws(const Trial& trial, std::size_t count, const TestSettings& settings) {
    if (!trial.subject->limited()) return 4 * settings.draws;
    const std::uint64_t asked = trial.subject->spending().answers, all = settings.questions_in_all / 40 * 39;
    return std::min<std::uint64_t>(settings.draws, (all > asked ? all - asked : 0) / (2 * count));
}

std::vector<Contrasts> fresh_contrasts(const Trial& trial, std::size_t index, const Contrasted& of,
    const TestSettings& settings, std::uint64_t draws, TestCounts& test_counts) {
    TestSettings fresh = settings;
    fresh.seed = seed_of(settings.seed, 0x9001u);
    fresh.draws = draws;
    const TrialContext work(trial, fresh, test_counts, static_cast<std::uint32_t>(index));
    std::vector<Contrasts> out;
    for (std::size_t t = 0; t < of.densities.size(); ++t)
        out.push_back(contrasts_of(work, of.densities[t], work.first(static_cast<int>(t))));
    return out;
}

using Members = std::vector<std::size_t>;
constexpr std::size_t fewest_members = 4;  // w_o; of fewer, density finds nearly as much

std::vector<Members> groups_of(std::span<const Trial> trials) {
    std::vector<Members> out;
    for (std::size_t i = 0; i < trials.size(); ++i) {
        if (trials[i].baseline || !trials[i].subject->traits().has_pdf || !trials[i].subject->draws_at_will()) continue;
        const auto same =
            std::find_if(out.begin(), out.end(), [&](const Members& m) { return trials[m[0]].arm == trials[i].arm; });
        if (same == out.end()) out.push_back({i});
        else same->push_back(i);
    }
    std::erase_if(out, [](const Members& m) { return m.size() < fewest_members; });
    return out;
}

struct Pooled {
    double statistic = 0, degrees = 0, largest = 0;
    std::size_t at = 0;  // the trial that shows it most
    void add(double z, std::size_t trial) {
        statistic += z * z;
        ++degrees;
        if (std::fabs(z) > std::fabs(largest)) largest = z, at = trial;
    }
    double p() const { return chi_squared_p(statistic, degrees); }
};

void tell(Verdict& v, const Pooled& screened, const Pooled& fresh, std::size_t contrast) {
    v.state = State::wrong;
    v.evidence["pooled_contrast"] = names[contrast];
    v.evidence["pooled_chi2"] = fresh.statistic;
    v.evidence["pooled_degrees"] = fresh.degrees;
    v.say = fmt::format(
        "The draws do not follow p: {} is off over {:g} w_o together, chi-square {:.4g} on {:g} degrees and {:.4g} on "
        "a fresh seed, most here, by {:.1f} standard errors. Bin by bin no w_o shows it alone.",
        names[contrast], fresh.degrees, screened.statistic, fresh.degrees, fresh.statistic, fresh.largest);
}

Verdict* density_of(Outcome& o) {
    const auto at =
        std::find_if(o.verdicts.begin(), o.verdicts.end(), [](const Verdict& v) { return v.name == "density"; });
    return at == o.verdicts.end() ? nullptr : &*at;
}

void judge_group(const Members& all, std::span<const Trial> trials, std::span<Outcome> outcomes,
    const TestSettings& settings, TestCounts& test_counts) {
    Members members;
    for (std::size_t i : all) {
        Verdict* v = density_of(outcomes[i]);
        if (v && v->state == State::wrong) return;  // told already
        for (std::size_t t = 0; v && outcomes[i].contrasted && t < outcomes[i].contrasted->z.size(); ++t)
            v->evidence[t == 0 ? "contrasts" : "contrasts_2"] = outcomes[i].contrasted->z[t];
        if (outcomes[i].contrasted && v && v->state == State::right) members.push_back(i);
    }
    if (members.size() < fewest_members) return;
    std::optional<std::vector<std::vector<Contrasts>>> again;
    for (std::size_t c = 0; c < contrast_count; ++c) {
        Pooled first, second;
        for (std::size_t i : members)
            for (const Contrasts& z : outcomes[i].contrasted->z) first.add(z[c], i);
        ++test_counts.tests;
        if (!(first.p() < settings.screen)) continue;
        ++test_counts.screened;
        if (!again) {
            constexpr std::uint64_t few = 4096;
            const std::uint64_t draws = fresh_draws(trials[members[0]], members.size(), settings);
            if (draws < few) return;
            again.emplace();
            for (std::size_t i : members)
                again->push_back(fresh_contrasts(trials[i], i, *outcomes[i].contrasted, settings, draws, test_counts));
        }
        for (std::size_t k = 0; k < members.size(); ++k)
            for (const Contrasts& z : (*again)[k]) second.add(z[c], members[k]);
        if (!(second.p() < settings.confirm)) continue;
        ++test_counts.confirmed;
        return tell(*density_of(outcomes[second.at]), first, second, c);
    }
}

}  // namespace

std::uint64_t pooled_tests(std::span<const Trial> trials) { return contrast_count * groups_of(trials).size(); }

void judge_pooled(std::span<const Trial> trials, std::span<Outcome> outcomes, const TestSettings& settings,
    TestCounts& test_counts, const ProgressMonitor& monitor) {
    for (const Members& group : groups_of(trials)) {
        monitor.check();
        try {
            judge_group(group, trials, outcomes, settings, test_counts);
        } catch (const SubjectFault&) {}  // a program that broke off said so where it was asked first
    }
}

}  // namespace crescent::inline verdicts
