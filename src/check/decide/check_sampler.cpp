// Results do not depend on the number of threads: each case has its own streams, selected by its index in the call. A
// program has a limited time: a few draws at every w_o come first, then the w_o nearest to 45 degrees and the most
// grazing one, then the others while time is left.
#include "check/decide/check_sampler.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>
#include <tuple>
#include <type_traits>

#include "base/parallel.h"
#include "base/text.h"
#include "check/constants.h"
#include "check/decide/tail.h"
#include "check/decide/whole_sampler.h"
#include "check/estimate/evaluation_noise.h"
#include "check/sources/check_case.h"

namespace crescent::check {

bool CheckOutcome::wrong() const {
    return !small.empty() || std::ranges::any_of(checks, [](const auto& techniques) {
        return std::ranges::any_of(techniques, [](const CheckAt& c) { return c.wrong(); });
    });
}

namespace {

std::vector<CheckOutcome> grouped(std::span<const CheckCase> check_cases) {
    std::vector<CheckOutcome> out;
    for (std::size_t i = 0; i < check_cases.size(); ++i) {
        if (check_cases[i].baseline) continue;
        const auto is_same_sampler = [&](const CheckOutcome& o) {
            const CheckCase& t = check_cases[o.check_cases[0]];
            return t.arm == check_cases[i].arm && t.brdf == check_cases[i].brdf &&
                t.parameters == check_cases[i].parameters && t.lighting == check_cases[i].lighting;
        };
        auto outcome = std::ranges::find_if(out, is_same_sampler);
        if (outcome == out.end()) outcome = out.insert(out.end(), {check_cases[i].arm, {}, {}, {}, {}, 0, {}, {}});
        outcome->check_cases.push_back(i);
    }
    return out;
}

/// Built-in arms are made for one w_o and one light. Special w_o are tested only for samplers that take any.
bool takes_any_wo(std::span<const CheckCase> check_cases, const CheckOutcome& o) {
    return std::ranges::all_of(
        o.check_cases, [&](std::size_t i) { return check_cases[i].adapter == check_cases[o.check_cases[0]].adapter; });
}

/// An estimate of f is not reciprocal. If a sampler is checked serially, no w_o has been checked before this call.
bool estimates_f(const CheckCase& check_case, const CheckOutcome& o, const StreamKey& key) {
    if (std::ranges::all_of(o.checks, [](const auto& techniques) { return techniques.empty(); })) {
        Source source(*check_case.adapter, 0, check_case.wo, check_case.light);
        return look_for_noise(source, key).f();
    }
    const auto is_estimate = [](const CheckAt& c) { return c.scatter.f(); };
    return std::ranges::any_of(
        o.checks, [&](const auto& techniques) { return std::ranges::any_of(techniques, is_estimate); });
}

void test_whole_sampler(std::span<const CheckCase> check_cases, const CheckSettings& settings, CheckOutcome& out) {
    const SamplerAdapter& adapter = *check_cases[out.check_cases[0]].adapter;
    StreamKey key{.seed = settings.seed,
        .place = static_cast<std::uint16_t>(out.check_cases[0]),
        .technique = 0,
        .stage = 1,
        .purpose = Purpose::light,
        .part = 0};
    const auto add = [&](std::optional<SmallFault> fault) {
        if (fault) out.small.push_back(*fault);
    };
    if (takes_any_wo(check_cases, out)) {
        std::vector<Vec3d> ordinary;
        for (std::size_t i : out.check_cases) ordinary.push_back(check_cases[i].wo);
        for (int t = 0; t < adapter.techniques(); ++t) add(special_places(adapter, t, ordinary));
        if (const std::optional<SmallFault> fault = reciprocity(adapter, key))
            if (!estimates_f(check_cases[out.check_cases[0]], out, key)) add(fault);
    }
    for (std::size_t i : out.check_cases) {
        const std::size_t fault_count = out.small.size();
        add(mis_weights(*check_cases[i].adapter, check_cases[i].wo, key));
        if (out.small.size() > fault_count) break;
    }
}

/// One w_o of one sampler.
struct Job {
    CheckOutcome* outcome;
    std::size_t index;  // index into its cases
};

/// Runs `work` and returns the error of an external sampler.
template <class Work> std::optional<Cut> cut_of(const Work& work) {
    try {
        work();
    } catch (const SamplerTimeout& fault) {
        return Cut{Cut::Why::too_slow, fault.what(), false};
    } catch (const SamplerExited& fault) {
        return Cut{Cut::Why::exited, fault.what(), false};
    } catch (const SamplerError& fault) { return Cut{Cut::Why::fault, fault.what(), false}; }
    return {};
}

/// Unusable numbers among a few draws.
std::optional<SmallFault> fault_of_first_draws(const CheckCase& check_case, const StreamKey& key) {
    // A program with 10 answers per second needs less than five minutes for 12 w_o.
    constexpr std::uint32_t draw_count = 256;
    SmallFault out{Family::values};
    const Traits traits = check_case.adapter->traits();
    const std::vector<PrimarySample> u = first_numbers(key, draw_count, traits);
    std::vector<Draw> draws(u.size());
    for (int t = 0; t < check_case.adapter->techniques(); ++t) {
        check_case.adapter->sample(t, check_case.wo, u, draws);
        out.trials += draw_count;
        for (std::size_t i = 0; i < u.size(); ++i)
            if (const auto fault = fault_of(draws[i], traits); fault && out.times++ == 0) {
                out.first = {.u = u[i], .draw = draws[i], .p = draws[i].pdf, .expected = 0};
                out.what = *fault;
            }
    }
    return out.times > 0 ? std::optional(out) : std::nullopt;
}

class Call {
public:
    Call(std::span<const CheckCase> check_cases, const CheckSettings& settings, ProgressMonitor& monitor)
        : check_cases_(check_cases), settings_(settings), monitor_(monitor), outcomes_(grouped(check_cases)) {
        for (CheckOutcome& o : outcomes_) {
            o.checks.resize(o.check_cases.size());
            o.cut.resize(o.check_cases.size());
            o.tails.resize(o.check_cases.size());
            for (std::size_t k = 0; k < o.check_cases.size(); ++k) jobs_.push_back({&o, k});
        }
        further_ = settings.further_in_all;
        const double looks = 1 + (further_ > 0 ? further_looks * early_look : 0);
        const double families = static_cast<double>(Family::families) * looks;
        levels_ = levels_of(settings.alpha, std::max(settings.cases, static_cast<double>(jobs_.size())) * families);
    }

    std::vector<CheckOutcome> run() {
        const bool is_serial =
            std::ranges::any_of(check_cases_, [](const CheckCase& t) { return t.adapter->serial(); });
        const bool is_limited_in_time =
            std::ranges::any_of(check_cases_, [](const CheckCase& t) { return t.adapter->spending().allowed > 0; });
        if (is_serial || is_limited_in_time) {
            run_within_time(is_serial);
        } else {
            parallel_for(std::size_t{0}, jobs_.size(), [&](std::size_t j) { check(jobs_[j]); });
            check_whole();
        }
        for (CheckOutcome& o : outcomes_) {
            for (const auto& techniques : o.checks)
                for (const CheckAt& c : techniques) o.evaluations += c.evaluations;
        }
        return std::move(outcomes_);
    }

private:
    std::span<const CheckCase> check_cases_;
    const CheckSettings& settings_;
    ProgressMonitor& monitor_;
    std::vector<CheckOutcome> outcomes_;
    std::vector<Job> jobs_;
    Levels levels_;
    double further_ = 0;         // evaluations that are left for going on
    std::size_t jobs_left_ = 0;  // of a serial check
    std::atomic_flag logged_{};  // whether the first w_o was reported

    std::size_t index_of(const Job& job) const { return job.outcome->check_cases[job.index]; }
    const CheckCase& case_of(const Job& job) const { return check_cases_[index_of(job)]; }

    void check(const Job& job) {
        monitor_.check();
        const CheckCase& check_case = case_of(job);
        CheckBudget budget = check_case.adapter->limited() ? settings_.budget_of_limited() : settings_.budget;
        if (check_case.theory.wrong)
            budget.stop_when_conclusive = false;  // a known fault is searched with the full budget
        const double techniques = check_case.adapter->techniques();
        budget.most_evaluations =
            std::min(settings_.most_at_one, budget.evaluations + further_for_one(check_case)) / techniques;
        const double reserved = static_cast<double>(jobs_left_) * budget.evaluations;
        std::vector<CheckAt>& checks = job.outcome->checks[job.index];
        std::optional<Cut>& cut = job.outcome->cut[job.index];
        cut = cut_of([&] {
            for (int t = 0; t < check_case.adapter->techniques(); ++t)
                checks.push_back(check_sampler_at(*check_case.adapter, t, check_case.wo,
                    {.light = check_case.light,
                        .place = static_cast<std::uint16_t>(index_of(job)),
                        .levels = levels_,
                        .reserved = reserved},
                    budget, settings_.seed));
        });
        if (check_case.adapter->serial())
            for (const CheckAt& c : checks)
                further_ -= std::max(static_cast<double>(c.evaluations) - budget.evaluations, 0.0);
        if (cut) checks.clear();
        job.outcome->tails[job.index] = tail_of(checks);
        log_first(check_case, checks, cut);
        for (CheckAt& c : checks) release_unused(c, check_case.adapter->traits().has_pdf);
        monitor_.advance(1);
    }

    /// What the first w_o shows, for a user who waits for the others.
    void log_first(const CheckCase& check_case, std::span<const CheckAt> techniques, const std::optional<Cut>& cut) {
        if (jobs_.size() < 2 || cut || logged_.test_and_set(std::memory_order_relaxed)) return;
        std::vector<std::string_view> wrong;
        const auto add = [&](Family family) {
            const std::string_view verdict = info(family).verdict;
            if (std::ranges::find(wrong, verdict) == wrong.end()) wrong.push_back(verdict);
        };
        for (const CheckAt& c : techniques) {
            for (const SmallFault& f : c.small) add(f.family);
            for (const Finding& f : c.findings) add(f.first.family);
        }
        const bool is_open = std::ranges::any_of(techniques, &CheckAt::inconclusive);
        const std::optional<std::string>& known_fault = check_case.theory.wrong;
        const bool is_expected = known_fault && wrong.size() == 1 && wrong[0] == *known_fault;
        const std::string result = !wrong.empty()
            ? fmt::format("{} wrong{}", fmt::join(wrong, ", "), is_expected ? " as expected" : "")
            : is_open ? "inconclusive"
                      : "no fault found";
        monitor_.log(
            fmt::format("1 of {}: {}, {}: {}", jobs_.size(), printable(check_case.arm), check_case.text(), result));
    }

    /// The evaluations by which one w_o may go on: what is left, in the order of a serial check; an equal share if w_o
    /// are checked in any order, so that the result does not depend on it.
    double further_for_one(const CheckCase& check_case) const {
        if (!(settings_.further_in_all > 0) || check_case.theory.wrong) return 0;
        if (check_case.adapter->serial()) return std::max(further_, 0.0);
        return settings_.further_in_all / static_cast<double>(jobs_.size());
    }

    /// Frees memory that neither the explanation nor the report needs, several megabytes at each w_o. A right w_o keeps
    /// only its numbers, unless pictures are drawn or the draws are the only evidence of the density.
    void release_unused(CheckAt& c, bool has_density) const {
        const auto free = [](auto&... containers) {
            (std::remove_reference_t<decltype(containers)>().swap(containers), ...);
        };
        free(c.observations.direction_keys, c.observations.node_by_set, c.integrals.light.weighted_points);
        if (settings_.keep_evidence) return;
        free(c.observations.weights);
        if (c.wrong() || !has_density) return;
        c.plan.reset();
        free(c.integrals.leaves, c.observations.leaves, c.observations.counts);
    }

    void check_whole() {
        for (CheckOutcome& o : outcomes_) o.whole_cut = cut_of([&] { test_whole_sampler(check_cases_, settings_, o); });
    }

    /// Moves the w_o nearest to 45 degrees to the front, then the most grazing one: together they show most faults.
    void order_jobs() {
        std::ranges::sort(
            jobs_, {}, [&](const Job& j) { return std::tuple(std::fabs(case_of(j).theta_deg - 45), index_of(j)); });
        const auto grazing = std::ranges::find_if(jobs_, [&](const Job& j) { return case_of(j).theta_deg == 85; });
        if (grazing != jobs_.end() && grazing > jobs_.begin()) std::rotate(jobs_.begin() + 1, grazing, grazing + 1);
    }

    /// Keeps the fault of the first draws if the later draws do not show it or are missing.
    void keep_first_fault(const Job& job, const std::optional<SmallFault>& fault) {
        std::vector<CheckAt>& techniques = job.outcome->checks[job.index];
        std::optional<Cut>& cut = job.outcome->cut[job.index];
        if (cut) cut->first_draws = true;
        if (!fault) return;
        const auto is_invalid = [](const auto& f) { return info(f.family).verdict == info(Family::values).verdict; };
        for (const CheckAt& c : techniques) {
            if (std::ranges::any_of(c.small, is_invalid)) return;
            if (std::ranges::any_of(c.findings, [&](const Finding& f) { return is_invalid(f.first); })) return;
        }
        if (techniques.empty()) techniques.emplace_back().wo = case_of(job).wo;
        techniques.front().small.push_back(*fault);
    }

    /// What the w_o of one program took so far; of those that several threads check at once, each counts what all took.
    struct Spending {
        double answers = 0, seconds = 0, most_answers = 0;  // most_answers: answers of one w_o
        void add(const QueryUsage& start, const QueryUsage& end) {
            const double answer_count = static_cast<double>(end.answers - start.answers);
            answers += answer_count;
            most_answers = std::max(most_answers, answer_count);
            seconds += end.seconds - start.seconds;
        }
        bool has_time(const QueryUsage& usage) const {
            if (usage.allowed <= 0 || answers == 0) return true;
            return usage.seconds + most_answers * seconds / answers < usage.allowed;
        }
    };

    /// First a few draws at every w_o and the tests of the whole sampler, then each w_o while time is left. The cost of
    /// the most expensive w_o so far predicts the next one. The first w_o of each program is always tried.
    void run_within_time(bool is_serial) {
        order_jobs();
        std::vector<std::optional<SmallFault>> first_faults(jobs_.size());
        for (std::size_t j = 0; j < jobs_.size(); ++j) {
            monitor_.check();
            const CheckCase& check_case = case_of(jobs_[j]);
            const StreamKey key{.seed = settings_.seed,
                .place = static_cast<std::uint16_t>(index_of(jobs_[j])),
                .technique = 0,
                .stage = 1,
                .purpose = Purpose::light,
                .part = 1};
            if (check_case.adapter->can_draw())
                jobs_[j].outcome->cut[jobs_[j].index] =
                    cut_of([&] { first_faults[j] = fault_of_first_draws(check_case, key); });
        }
        check_whole();
        std::atomic<std::size_t> next = 0;  // in this order, also on several threads
        Mutex lock;
        std::map<const SamplerAdapter*, Spending> spending;  // guarded by the lock
        for_each_index(is_serial, jobs_.size(), [&](std::size_t) {
            const std::size_t j = next++;
            const Job& job = jobs_[j];
            const SamplerAdapter* adapter = case_of(job).adapter.get();
            if (is_serial) jobs_left_ = jobs_.size() - j - 1;
            std::optional<Cut>& cut = job.outcome->cut[job.index];
            if (cut) return monitor_.advance(1);
            const QueryUsage start = adapter->spending();
            const bool has_time = [&] {
                const Guard guard(lock);
                return spending[adapter].has_time(start);
            }();
            if (has_time) check(job);
            else {
                cut = Cut{Cut::Why::too_slow, "no time is left", true};
                monitor_.advance(1);
            }
            keep_first_fault(job, first_faults[j]);
            const Guard guard(lock);
            spending[adapter].add(start, adapter->spending());
        });
    }
};

}  // namespace

std::vector<CheckOutcome> check_samplers(
    std::span<const CheckCase> check_cases, const CheckSettings& settings, ProgressMonitor& monitor) {
    return Call(check_cases, settings, monitor).run();
}

}  // namespace crescent::check
