// A program is asked by one thread and has a limited time. Every w_o keeps at least `valid`; what else there was no
// time for is inconclusive and says so, whatever the load of the machine.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>

#include "subjects/faults.h"
#include "verdicts/outcome.h"
#include "verdicts/verdict_kind.h"

namespace crescent::inline verdicts {

namespace {

constexpr std::uint64_t few_draws = 256;

/// The middle first, then the grazing one: between them they meet most faults. Arms to rank against last.
std::vector<std::size_t> order_of(std::span<const Trial> trials) {
    std::vector<std::size_t> order(trials.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto rank = [&](std::size_t i) {
        return std::tuple(trials[i].baseline, std::fabs(trials[i].theta_deg - 45), i);
    };
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
    const auto grazing = std::find_if(
        order.begin(), order.end(), [&](std::size_t i) { return trials[i].theta_deg == 85 && !trials[i].baseline; });
    if (grazing != order.end() && grazing > order.begin()) std::rotate(order.begin() + 1, grazing, grazing + 1);
    return order;
}

/// `valid` from a few draws.
Outcome look(const Trial& trial, std::size_t index, const TestSettings& settings, TestCounts& test_counts) {
    Outcome out;
    try {
        TrialContext work(trial, settings, test_counts, static_cast<std::uint32_t>(index));
        out.verdicts.push_back(kinds::valid.judge(work));
    } catch (const SubjectFault& fault) { out.cut = cut_by(fault); }
    return out;
}

Cut left_out(const Trial& trial, const TestSettings& settings) {
    const double seconds = trial.subject->spending().allowed;
    const std::string say = fmt::format(
        "Not looked at: {:g} s are too short for this program to be asked everything at every w_o. {} --accept-few "
        "judges by what was looked at.",
        seconds,
        settings.full ? "--patience gives it longer;" : "--full gives it an hour, --patience as long as you say;");
    return {settings.accept_few ? State::skipped : State::inconclusive, say, say, {}};
}

/// The dearest trial so far tells what the next one may cost; the first is tried in any case.
bool affords(const Spending& now, std::uint64_t dearest) {
    if (now.allowed <= 0 || dearest == 0) return true;
    const double rate = static_cast<double>(now.answers) / std::max(now.seconds, 1e-9);
    return now.seconds + static_cast<double>(dearest) / rate < now.allowed;
}

/// What all w_o may be asked, but for what follows the last one.
std::size_t questions_for(const TestSettings& settings, std::size_t count) {
    constexpr std::size_t enough = 333000;  // of the even share, where more w_o are asked for than the grid has
    return std::max(settings.questions_in_all, count * enough) / 40 * 37;
}

/// What one w_o may be asked, but for the least of what comes last, which is asked in any case.
std::size_t most_of_one(const TestSettings& settings) { return settings.questions / 50 * 48; }

/// What one w_o may be asked: what is left, less nine tenths of an even share for each of those still to come. What one
/// does not need the next may have.
std::size_t share_of(const TestSettings& settings, std::size_t count, std::uint64_t asked, std::size_t to_come) {
    const std::size_t all = questions_for(settings, count), each = all / 10 * 9 / count;
    const std::size_t kept = asked + to_come * each;
    return std::min(most_of_one(settings), std::max(all > kept ? all - kept : 0, each));
}

}  // namespace

std::size_t even_share(const TestSettings& settings, std::size_t count) {
    return std::min(most_of_one(settings), questions_for(settings, count) / std::max<std::size_t>(count, 1));
}

std::vector<Outcome> judge_in_turn(
    std::span<const Trial> trials, const TestSettings& settings, TestCounts& test_counts, ProgressMonitor& monitor) {
    TestSettings quick_look = settings;
    quick_look.draws = std::min(settings.draws, few_draws);
    quick_look.pictures = false;
    std::vector<Outcome> outcomes(trials.size()), looks(trials.size());
    const std::vector<std::size_t> order = order_of(trials);
    for (std::size_t i : order) {
        monitor.check();
        if (!trials[i].baseline) looks[i] = look(trials[i], i, quick_look, test_counts);
    }
    std::uint64_t dearest = 0;
    std::size_t count = 0;
    for (const Trial& t : trials) count += !t.baseline;
    std::size_t to_come = count;
    for (std::size_t i : order) {
        monitor.check();
        const Spending before = trials[i].subject->spending();
        TestSettings here = settings;
        if (!trials[i].baseline) here.questions = share_of(settings, count, before.answers, --to_come);
        if (looks[i].cut || !affords(before, trials[i].baseline ? 0 : dearest)) {
            outcomes[i] = std::move(looks[i]);
            const bool slow = !outcomes[i].cut || outcomes[i].cut->state == State::inconclusive;
            if (slow) outcomes[i].cut = left_out(trials[i], settings);
        } else {
            outcomes[i] = judge_one(trials[i], i, here, test_counts, monitor);
            dearest = std::max(dearest, trials[i].subject->spending().answers - before.answers);
            const bool cut_short = outcomes[i].cut && outcomes[i].cut->state == State::inconclusive;
            if (cut_short) outcomes[i].cut = left_out(trials[i], settings);
            std::vector<Verdict>& verdicts = outcomes[i].verdicts;
            const auto is_wrong = [](const std::vector<Verdict>& v) { return v[0].state == State::wrong; };
            const bool met = !looks[i].verdicts.empty() &&
                (verdicts.empty() || (is_wrong(looks[i].verdicts) && !is_wrong(verdicts)));
            if (met && verdicts.empty()) verdicts = std::move(looks[i].verdicts);
            else if (met) verdicts[0] = std::move(looks[i].verdicts[0]);
        }
        monitor.advance(1);
    }
    std::size_t whole = 0;
    for (std::size_t i : order) whole += !trials[i].baseline && !outcomes[i].cut;
    for (Outcome& o : outcomes)  // few may be accepted, none may not
        if (whole == 0 && o.cut && o.cut->state == State::skipped) o.cut->state = State::inconclusive;
    return outcomes;
}

}  // namespace crescent::inline verdicts
