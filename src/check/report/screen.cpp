// The first view of one sampler on a terminal, in at most 12 lines. Wrong verdicts come first, each with its place and
// size, the first also with its cause and the next step; then right ones, and what they could hide. The layout is the
// fullest of several that has room.
#include "check/report/screen.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <set>

#include "check/report/print.h"
#include "check/report/summary.h"
#include "check/verdict.h"

namespace crescent {

namespace {

constexpr std::size_t most_rows = 12;
constexpr std::size_t hanging_indent = 2;

/// What a layout leaves out, the least needed first.
struct Layout {
    bool lists_right = true;       // a line for each right verdict
    bool completes_others = true;  // all sentences of the findings after the first
    bool lists_others = true;      // a line for each of these findings
    bool completes_first = true;   // all sentences of the first
};

constexpr Layout layouts[] = {
    {},
    {.lists_right = false},
    {.lists_right = false, .completes_others = false},
    {.lists_right = false, .lists_others = false},
    {.lists_right = false, .lists_others = false, .completes_first = false},
};

std::string shortened(const Verdict& v, bool is_full) {
    return in_one_line(is_full ? v.message() : v.first_sentence());
}

/// " as expected" or " as waived" with the reason; "" for a verdict that is not expected.
std::string expectation_of(const Finding& f) {
    return f.expected ? fmt::format(" as {}", f.worst->waived ? "waived" : "expected") : "";
}

ScreenLine line_of(const Finding& f, bool is_full) {
    if (f.state == State::error) return {f.state, "error", in_one_line(failure_text(f))};
    const std::string where = where_found(f);
    return {f.state, fmt::format("{}: {}{}", f.name, word(f.state), expectation_of(f)),
        fmt::format("{}{}{} {}", where.empty() ? "" : " ", where, f.expected ? ":" : ".",
            f.expected ? f.worst->why_expected : shortened(*f.worst, is_full))};
}

/// Cause and next step of the first finding, below it.
void add_steps(const Finding& f, FrontEnd front_end, std::vector<ScreenLine>& out) {
    if (f.state == State::error || f.expected) return;
    if (!f.cause.empty()) out.push_back({{}, "  Cause: ", in_one_line(f.cause)});
    std::string next = in_one_line(next_step_text(*f.worst, front_end));
    if (next.empty() && f.worst->wo && f.total > 1 && f.state == State::wrong)
        next = one_wo_text(*f.worst->wo, front_end);
    if (!next.empty()) out.push_back({{}, "  Next step: ", next});
}

void add_findings(
    const std::vector<Finding>& findings, const Layout& layout, FrontEnd front_end, std::vector<ScreenLine>& out) {
    std::map<std::string, std::vector<std::string>> others;  // names by state
    for (std::size_t i = 0; i < findings.size(); ++i) {
        const Finding& f = findings[i];
        if (i > 0 && !layout.lists_others) {
            others[fmt::format("{}{}", word(f.state), expectation_of(f))].push_back(f.name);
            continue;
        }
        out.push_back(line_of(f, i == 0 ? layout.completes_first : layout.completes_others));
        if (i == 0) add_steps(f, front_end, out);
        else if (layout.completes_others && !f.named_cause.empty() && f.named_cause != findings[0].cause)
            out.back().text += " " + in_one_line(f.named_cause);
    }
    for (const auto& [state, names] : others)
        out.push_back({{}, "", fmt::format("Also {}: {}", state, fmt::join(names, ", "))});
}

/// The verdicts whose worst state is this one, in the order of the list, with the number of w_o at which they are.
std::vector<std::pair<std::string, std::size_t>> names_in(const CheckResult& result, State state) {
    std::vector<std::pair<std::string, std::size_t>> out;
    for (std::string_view name : verdict_names) {
        std::size_t count = 0;
        bool has_other = false;
        for (const Verdict& v : result.verdicts) {
            if (v.name != name) continue;
            count += v.state == state;
            has_other = has_other || (v.state != state && v.state != State::skipped);
        }
        if (count > 0 && !has_other) out.emplace_back(name, count);
    }
    return out;
}

void add_right(const CheckResult& result, const Layout& layout, std::vector<ScreenLine>& out) {
    const auto right_names = names_in(result, State::right);
    std::set<std::string> cases;
    bool has_wo = true;
    for (const Verdict& v : result.verdicts) {
        cases.insert(v.check_case);
        has_wo = has_wo && v.wo;
    }
    std::string joined_names;
    for (const auto& [name, count] : right_names) {
        const std::string where =
            cases.size() > 1 ? fmt::format(" at {} of {} {}", count, cases.size(), has_wo ? "w_o" : "cases") : "";
        if (layout.lists_right) out.push_back({State::right, name + ": right", where});
        else joined_names += (joined_names.empty() ? " " : ", ") + name;
    }
    if (!joined_names.empty()) out.push_back({State::right, "right:", joined_names});
}

/// The verdicts that were skipped everywhere, and what most of them need.
void add_skipped(const CheckResult& result, std::vector<ScreenLine>& out) {
    std::string names, reason;
    std::map<std::string, std::size_t> counts;
    for (const auto& [name, count] : names_in(result, State::skipped)) {
        const auto v = std::ranges::find(result.verdicts, name, &Verdict::name);
        const std::string candidate = shortened(*v, false);
        if (const std::size_t occurrences = ++counts[candidate]; occurrences > counts[reason]) reason = candidate;
        names += (names.empty() ? " " : ", ") + name;
    }
    if (!names.empty()) out.push_back({State::skipped, "skipped:", fmt::format("{}. {}", names, reason)});
}

std::vector<ScreenLine> lines_by(
    const Layout& layout, const CheckResult& result, const std::vector<Finding>& findings, FrontEnd front_end) {
    std::vector<ScreenLine> out;
    add_findings(findings, layout, front_end, out);
    add_right(result, layout, out);
    add_skipped(result, out);
    for (const std::string& line : result.unmet) out.push_back({{}, "", in_one_line(line)});
    for (const std::string& text : closing_texts(result)) out.push_back({{}, "", in_one_line(text)});
    return out;
}

/// Breaks the text between words. Rows after the first begin with spaces.
void break_rows(ScreenLine& line, std::size_t columns) {
    const std::size_t mark = line.state ? 2 : 0;
    std::size_t column = mark + line.head.size();
    std::string text;
    for (std::size_t start = 0; start < line.text.size();) {
        const std::size_t end = std::min(line.text.find(' ', start + 1), line.text.size());
        const std::string next = line.text.substr(start, end - start);
        if (column + next.size() > columns && column > hanging_indent) {
            text += "\n" + std::string(hanging_indent, ' ');
            column = hanging_indent;
            text += next.substr(next.starts_with(' '));
            column += next.size() - next.starts_with(' ');
        } else {
            text += next;
            column += next.size();
        }
        start = end;
    }
    line.text = text;
}

std::size_t rows_of(const std::vector<ScreenLine>& lines) {
    std::size_t out = lines.size();
    for (const ScreenLine& line : lines) out += static_cast<std::size_t>(std::ranges::count(line.text, '\n'));
    return out;
}

}  // namespace

std::vector<ScreenLine> screen_of(const CheckResult& result, std::size_t columns, FrontEnd front_end) {
    std::vector<Finding> findings;
    for (const bool expected : {false, true})
        for (const Finding& f : findings_of(result))
            if (f.expected == expected) findings.push_back(f);
    std::vector<ScreenLine> lines;
    for (const Layout& layout : layouts) {
        lines = lines_by(layout, result, findings, front_end);
        for (ScreenLine& line : lines)
            if (columns > 0) break_rows(line, columns);
        if (rows_of(lines) <= most_rows) return lines;
    }
    while (rows_of(lines) >= most_rows) lines.pop_back();
    lines.push_back({{}, "", "..."});
    return lines;
}

const char* mark_of(State state) {
    switch (state) {
        case State::right: return "✓";
        case State::wrong: return "✗";
        case State::inconclusive: return "?";
        case State::skipped: return "-";
        case State::error: return "!";
    }
    return "";
}

std::string verdict_screen(const CheckResult& result, FrontEnd front_end) {
    std::string out;
    for (const ScreenLine& line : screen_of(result, 0, front_end))
        out += fmt::format(
            "{}{}{}{}\n", line.state ? mark_of(*line.state) : "", line.state ? " " : "", line.head, line.text);
    return out;
}

bool one_sampler(const CheckResult& result) {
    return std::ranges::all_of(result.verdicts, [&](const Verdict& v) { return v.arm == result.verdicts.front().arm; });
}

}  // namespace crescent
