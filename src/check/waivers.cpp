// A line is split at its first '=' and at the next ':'. Words are compared with the known verdicts, and arms with those
// that are checked.
#include "check/waivers.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <filesystem>
#include <sstream>

#include "base/errors.h"
#include "base/input.h"
#include "base/text.h"
#include "check/verdict.h"

namespace crescent {

namespace {

const std::vector<std::string> waivable = [] {
    std::vector<std::string> out(verdict_names.begin(), verdict_names.end());
    out.insert(out.end(), {"same_distribution", "same_f", "variance"});  // of two samplers: against.cpp
    return out;
}();

std::string trimmed(const std::string& s) {
    const auto from = s.find_first_not_of(" \t\r"), to = s.find_last_not_of(" \t\r");
    return from == s.npos ? "" : s.substr(from, to - from + 1);
}

struct Origin {
    std::string file;
    unsigned line = 0;
    std::string text() const { return line == 0 ? file : fmt::format("{}:{}", file, line); }
};

Waiver read_one(const std::string& text, const Origin& origin) {
    const auto fault = [&](const std::string& message) { throw InputError({origin.file, origin.line, 0}, message); };
    const std::size_t equals = text.find('='), colon = text.find(':', equals == text.npos ? 0 : equals);
    if (equals == text.npos) fault(fmt::format("expected [ARM ]VERDICT=STATE: REASON, got '{}'", printable(text)));
    const std::string left_side = trimmed(text.substr(0, equals));
    const std::size_t space = left_side.find_last_of(" \t");
    Waiver out;
    out.place = origin.text();
    out.verdict = space == left_side.npos ? left_side : left_side.substr(space + 1);
    out.arm = space == left_side.npos ? "" : trimmed(left_side.substr(0, space));
    if (out.arm == "*") out.arm.clear();
    const std::string state = trimmed(text.substr(equals + 1, colon == text.npos ? colon : colon - equals - 1));
    if (colon != text.npos) out.reason = trimmed(text.substr(colon + 1));
    if (std::find(waivable.begin(), waivable.end(), out.verdict) == waivable.end()) {
        const std::string suggestion = nearest(out.verdict, waivable);
        fault(fmt::format("no verdict '{}'{}", printable(out.verdict),
            suggestion.empty() ? fmt::format("; they are {}", fmt::join(waivable, ", "))
                               : "; did you mean '" + suggestion + "'?"));
    }
    if (state == "inconclusive") out.state = State::inconclusive;
    else if (state != "wrong") fault(fmt::format("expected wrong or inconclusive, got '{}'", printable(state)));
    if (out.reason.empty())
        fault(fmt::format("expected the reason behind the state, as in '{}: it never reaches the horizon', got '{}'",
            printable(trimmed(text.substr(0, colon))), printable(text)));
    return out;
}

bool is_of(const Waiver& w, const Verdict& v) {
    return w.arm.empty() || v.arm == w.arm || v.arm.starts_with(w.arm + " against ");
}

void read_file(const std::string& path, std::vector<Waiver>& out) {
    std::error_code error;
    if (!std::filesystem::exists(path, error) || std::filesystem::is_directory(path, error))
        throw InputError(
            {"--expect " + path, 0, 0}, "is neither [ARM ]VERDICT=STATE: REASON nor a file that can be read");
    std::istringstream in(read_input(path, std::size_t{1} << 20, "a file of waivers"));
    std::string line;
    for (unsigned number = 1; std::getline(in, line); ++number)
        if (const std::string text = trimmed(line.substr(0, line.find('#'))); !text.empty())
            out.push_back(read_one(text, {path, number}));
}

}  // namespace

std::vector<Waiver> read_waivers(std::span<const std::string> texts) {
    std::vector<Waiver> out;
    for (const std::string& text : texts) {
        if (text.find('=') != text.npos) out.push_back(read_one(text, {"--expect"}));
        else read_file(text, out);
    }
    return out;
}

void check_waivers(std::span<const Waiver> waivers, std::span<const std::string> arms) {
    for (const Waiver& w : waivers) {
        if (w.arm.empty() || std::find(arms.begin(), arms.end(), w.arm) != arms.end()) continue;
        const std::string suggestion = nearest(w.arm, {arms.begin(), arms.end()});
        throw InputError({w.place, 0, 0},
            fmt::format("no sampler '{}' is checked here; {}", printable(w.arm),
                suggestion.empty() ? fmt::format("there is {}", fmt::join(arms, ", "))
                                   : "did you mean '" + suggestion + "'?"));
    }
}

void waive(CheckResult& j, std::span<const Waiver> waivers) {
    for (const Waiver& w : waivers) {
        std::size_t match_count = 0;
        for (Verdict& v : j.verdicts) {
            if (v.name != w.verdict || v.state != w.state || !is_of(w, v)) continue;
            ++match_count;
            v.waived = v.expected = true;
            v.why_expected = w.reason;
        }
        if (match_count == 0)
            j.unmet.push_back(fmt::format("{}: {}{} is expected to be {} but is not: the expectation can go", w.place,
                w.arm.empty() ? "" : w.arm + " ", w.verdict, word(w.state)));
    }
    set_state(j);
}

}  // namespace crescent
