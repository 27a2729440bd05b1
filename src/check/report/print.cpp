// The table of the terminal shows the worst state over all w_o; JUnit contains every verdict.
#include "check/report/print.h"

#include <array>
#include <fmt/format.h>
#include <map>

#include "base/text.h"
#include "check/report/summary.h"
#include "check/verdict.h"
#include "output/format.h"

namespace crescent {

namespace {

State worst(State a, State b) {
    const auto rank = [](State s) {
        return s == State::wrong ? 4 : s == State::error ? 3 : s == State::inconclusive ? 2 : s == State::right ? 1 : 0;
    };
    return rank(b) > rank(a) ? b : a;
}

/// The worst state of each verdict of one arm.
using Row = std::map<std::string, State>;

/// Ends a line without the blanks of its last column.
void end_line(std::string& text) { text.erase(text.find_last_not_of(' ') + 1) += "\n"; }

std::string rows_of(const CheckResult& result) {
    std::vector<std::string> order;
    std::map<std::string, Row> rows;
    for (const Verdict& v : result.verdicts) {
        if (!rows.count(v.arm)) order.push_back(v.arm);
        Row& row = rows[v.arm];
        row[v.name] = row.count(v.name) ? worst(row[v.name], v.state) : v.state;
    }
    std::string out = fmt::format("{:<18}", "arm");
    for (std::string_view name : verdict_names) out += fmt::format(" {:<12}", name);
    end_line(out);
    for (const std::string& arm : order) {
        out += fmt::format("{:<18}", arm);
        for (std::string_view name : verdict_names) {
            const auto entry = rows[arm].find(std::string(name));
            out += fmt::format(" {:<12}", entry == rows[arm].end() ? "-" : word(entry->second));
        }
        end_line(out);
    }
    return out;
}

std::string expected_ones(const CheckResult& result) {
    std::map<std::string, int> lines;  // number of cases by line
    for (const Verdict& v : result.verdicts)
        if (v.expected && !v.why_expected.empty() && v.state != State::right && v.state != State::skipped)
            ++lines[fmt::format(
                "{}: {} {} as {}: {}", v.arm, word(v.state), v.name, v.waived ? "waived" : "expected", v.why_expected)];
    std::string out = lines.empty() && result.unmet.empty() ? "" : "\n";
    for (const auto& [line, count] : lines) out += fmt::format("{} ({} cases)\n", line, count);
    for (const std::string& line : result.unmet) out += line + "\n";
    return out;
}

}  // namespace

std::string verdict_table(const CheckResult& result, bool includes_right) {
    const std::string summary = summary_of(result);
    std::string out = summary + (summary.empty() ? "" : "\n") + rows_of(result) + expected_ones(result);
    out += details_of(result);
    for (const Verdict& v : result.verdicts)
        if (includes_right)
            out += fmt::format("\n{} [{}]\n  {}: {}. {}\n", v.arm, v.check_case, v.name, word(v.state), describe(v));
    for (const std::string& text : {implied_text(result), unseen_text(result), nothing_drawn_text(result)})
        if (!text.empty()) out += "\n" + text + "\n";
    const std::string questions_text =
        result.questions > 0 ? fmt::format("; {} questions were answered", result.questions) : "";
    out += fmt::format(
        "\n{}; {} statistical tests share a family-wise error of {:g}; {} failed once, {} again on a fresh seed{}\n",
        word(result.state), result.tests, result.alpha, result.screened, result.confirmed, questions_text);
    return out;
}

namespace {

/// Verdicts that fail or are inconclusive and that the caller does not expect.
std::vector<Annotation> annotations_of(const CheckResult& result, const std::pair<std::string, unsigned>& place) {
    std::vector<Annotation> out;
    const auto add = [&](const std::string& rule, const char* level, const std::string& message,
                         const std::string& identity) {
        out.push_back({rule, level, message, place.first, place.second, identity});
    };
    for (const Verdict& v : result.verdicts) {
        if (v.waived || (!v.why_expected.empty() && v.expected)) continue;
        const bool fails = v.state == State::wrong || v.state == State::error || !v.expected;
        if (!fails && v.state != State::inconclusive) continue;
        const bool is_open = v.state == State::inconclusive;
        add(v.name, is_open ? "warning" : "error",
            fmt::format("{} is {} at {}: {}{}", v.arm, word(v.state), v.check_case, v.message(),
                v.cause.empty() ? "" : " " + v.cause),
            fmt::format("{} {} {}", v.arm, v.check_case, v.name));
    }
    for (const std::string& line : result.unmet) add("expectation", "error", line, line);
    return out;
}

}  // namespace

TestReport verdict_report(
    const CheckResult& result, const std::pair<std::string, unsigned>& place, const std::string& version) {
    using Case = TestCase::State;
    TestReport report{.name = "crescent check",
        .rules = {verdict_names.begin(), verdict_names.end()},
        .annotations = annotations_of(result, place),
        .version = version};
    report.rules.emplace_back("expectation");
    for (const auto& [arm, device] : result.devices) report.properties.emplace_back("device of " + arm, device.text());
    for (const Verdict& v : result.verdicts) {
        const bool fails = v.why_expected.empty() ? v.state == State::wrong || !v.expected : !v.expected;
        const bool is_open = v.state == State::skipped || v.state == State::inconclusive;
        const std::string next = next_step_text(v);
        const Case state = v.state == State::error ? Case::error
            : fails                                ? Case::failed
            : is_open                              ? Case::skipped
                                                   : Case::passed;
        report.cases.push_back({v.arm, fmt::format("{} [{}]", v.name, v.check_case), state,
            fmt::format("{}: {}", word(v.state), v.first_sentence()),
            v.message() + (v.cause.empty() ? "" : " " + v.cause) + (next.empty() ? "" : " Next step: " + next),
            v.seconds});
    }
    for (const std::string& line : result.unmet)
        report.cases.push_back({"crescent check", "expectations", Case::failed, line, line, 0});
    return report;
}

// ---- The terms of each front end for a next step.

namespace {

/// By front end.
using Words = std::array<const char*, 3>;
constexpr Words thorough = {"--full", "crescent::IsARightSamplerBy(crescent::TestSettings::thorough())", "full=True"};
constexpr Words time = {
    "--patience SECONDS", "TestSettings::seconds, or a sampler that answers faster", "patience=SECONDS"};
constexpr Words accept = {"--allow-inconclusive", "crescent::IsNotAWrongSampler()", "state != 'wrong'"};

std::string named(const Words& words, FrontEnd front_end) { return words[static_cast<std::size_t>(front_end)]; }

/// `flag`: the name of a thorough check, which makes twelve times as many draws as a quick one.
std::string more_draws_text(const NextStep& next, const std::string& flag) {
    constexpr double times_of_thorough = 12;
    constexpr double most_times = 1e6;  // a quick check makes 1.2 million draws: 1e12 take days of any machine
    if (next.times > most_times) return "more draws are needed than can be made.";
    const std::string need_text = fmt::format("about {:.2g} times as many draws are needed", next.times);
    if (next.thorough) return next.times > 0 ? need_text + " as " + flag + " makes." : "";
    if (!(next.times > 0)) return flag + " draws more.";
    if (next.times <= times_of_thorough) return flag + " draws more (" + need_text + ").";
    return fmt::format("{}; {} makes only {:g} times as many.", need_text, flag, times_of_thorough);
}

}  // namespace

std::string next_step_text(const Verdict& v, FrontEnd front_end) {
    switch (v.next.kind) {
        case NextStep::Kind::none: return v.next_step;
        case NextStep::Kind::more_draws: return more_draws_text(v.next, named(thorough, front_end));
        case NextStep::Kind::more_time: return named(time, front_end) + ": the time was too short for all tests.";
        case NextStep::Kind::heavier_pdf:
            return "a pdf that falls off no faster than f; " + named(accept, front_end) + " accepts a heavy tail.";
    }
    return v.next_step;
}

std::string one_wo_text(std::pair<double, double> wo, FrontEnd front_end) {
    const auto [theta, azimuth] = wo;
    switch (front_end) {
        case FrontEnd::command_line: return fmt::format("--wo {:g},{:g} checks only this w_o.", theta, azimuth);
        case FrontEnd::cpp:
            return fmt::format(
                "crescent::IsARightSamplerBy(settings) with settings.wo = {{{{{:g}, {:g}}}}} checks "
                "only this w_o.",
                theta, azimuth);
        case FrontEnd::python: return fmt::format("wo_deg=[({:g}, {:g})] checks only this w_o.", theta, azimuth);
    }
    return "";
}

}  // namespace crescent
