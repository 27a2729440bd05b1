#include "verdicts/print.h"

#include <fmt/format.h>
#include <map>

#include "base/text.h"

namespace crescent {

namespace {

State worst(State a, State b) {
    const auto rank = [](State s) { return s == State::wrong ? 4 : s == State::error ? 3 : s == State::inconclusive ? 2 : s == State::right ? 1 : 0; };
    return rank(b) > rank(a) ? b : a;
}

/// The worst state of each of the nine verdicts of one arm.
using Row = std::map<std::string, State>;

}  // namespace

std::string verdict_table(const Judgement& judgement, bool all) {
    std::vector<std::string> order;
    std::map<std::string, Row> rows;
    for (const Verdict& v : judgement.verdicts) {
        if (!rows.count(v.arm)) order.push_back(v.arm);
        Row& row = rows[v.arm];
        row[v.name] = row.count(v.name) ? worst(row[v.name], v.state) : v.state;
    }
    std::string out = fmt::format("{:<18}", "arm");
    for (std::string_view name : verdict_names) out += fmt::format(" {:<12}", name);
    out += "\n";
    for (const std::string& arm : order) {
        out += fmt::format("{:<18}", arm);
        for (std::string_view name : verdict_names) {
            const auto at = rows[arm].find(std::string(name));
            out += fmt::format(" {:<12}", at == rows[arm].end() ? "-" : word(at->second));
        }
        out += "\n";
    }
    std::map<std::string, int> expected;  // told once each, with how often
    for (const Verdict& v : judgement.verdicts) {
        const bool notable = v.state == State::wrong || v.state == State::error || v.state == State::inconclusive || !v.expected;
        if (v.expected && !v.why_expected.empty() && notable) ++expected[fmt::format("{}: {} {} as the list expects: {}", v.arm, word(v.state), v.name, v.why_expected)];
        else if (all || !v.expected || v.state == State::wrong) out += fmt::format("\n{} [{}]\n  {}: {}. {}\n", v.arm, v.trial, v.name, word(v.state), v.say);
    }
    if (!expected.empty()) out += "\n";
    for (const auto& [line, count] : expected) out += fmt::format("{} ({} cases)\n", line, count);
    out += fmt::format("\n{}; {} statistical tests share a family-wise error of {:g}; {} failed once, {} again on a fresh seed\n", word(judgement.state), judgement.tests, judgement.alpha,
                       judgement.screened, judgement.confirmed);
    return out;
}

std::string verdict_json(const Judgement& judgement) {
    nlohmann::ordered_json root;
    root["state"] = word(judgement.state);
    root["as_expected"] = judgement.as_expected;
    root["alpha"] = judgement.alpha;
    root["tests"] = judgement.tests;
    root["failed_once"] = judgement.screened;
    root["failed_twice"] = judgement.confirmed;
    if (judgement.questions > 0) root["questions"] = judgement.questions;
    root["left_out"] = nlohmann::ordered_json::array();
    for (const LeftOut& l : judgement.left_out) root["left_out"].push_back({{"arm", l.arm}, {"case", l.trial}, {"verdicts", l.verdicts}, {"why", l.why}});
    root["verdicts"] = nlohmann::ordered_json::array();
    for (const Verdict& v : judgement.verdicts) {
        nlohmann::ordered_json one;
        one["arm"] = v.arm;
        one["case"] = v.trial;
        one["name"] = v.name;
        one["state"] = word(v.state);
        one["say"] = v.say;
        one["expected"] = v.expected;
        if (!v.why_expected.empty()) one["why_expected"] = v.why_expected;
        one["evidence"] = v.evidence;
        root["verdicts"].push_back(std::move(one));
    }
    return root.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::string verdict_junit(const Judgement& judgement) {
    std::size_t failures = 0, errors = 0, skipped = 0;
    std::string cases;
    for (const Verdict& v : judgement.verdicts) {
        cases += fmt::format("  <testcase classname=\"{}\" name=\"{} [{}]\">", escape(v.arm), v.name, escape(v.trial));
        const bool fails = v.why_expected.empty() ? v.state == State::wrong || !v.expected : !v.expected;
        if (v.state == State::error) {
            ++errors;
            cases += fmt::format("<error message=\"{}\">{}</error>", word(v.state), escape(v.say));
        } else if (fails) {
            ++failures;
            cases += fmt::format("<failure message=\"{}\">{}</failure>", word(v.state), escape(v.say));
        } else if (v.state == State::skipped || v.state == State::inconclusive) {
            ++skipped;
            cases += fmt::format("<skipped message=\"{}: {}\"/>", word(v.state), escape(v.say));
        }
        cases += "</testcase>\n";
    }
    return fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuite name=\"crescent check\" tests=\"{}\" failures=\"{}\" errors=\"{}\" skipped=\"{}\">\n{}</testsuite>\n", judgement.verdicts.size(), failures, errors,
                       skipped, cases);
}

}  // namespace crescent
