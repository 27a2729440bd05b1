// Verdicts of one arm with equal name and state form one finding, described by the one with the largest deviation.
// Other sentences follow with their w_o.
#include "check/report/summary.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <set>
#include <span>
#include <vector>

#include "base/vec.h"
#include "check/report/print.h"
#include "check/report/sentences.h"
#include "check/sources/check_case.h"
#include "check/verdict.h"
#include "math/functions.h"
#include "math/simd/scalar.h"

namespace crescent {

namespace {

int rank(State s) { return s == State::wrong ? 0 : s == State::error ? 1 : 2; }

using Key = std::pair<std::string, std::string>;  // arm and case

std::map<Key, std::set<std::string>> left_out_of(const CheckResult& j) {
    std::map<Key, std::set<std::string>> out;
    for (const SkippedCase& l : j.left_out) out[{l.arm, l.check_case}].insert(l.verdicts.begin(), l.verdicts.end());
    return out;
}

struct Count {
    std::size_t cases = 0;
    bool differs_by_wo = true;  // whether they differ only by w_o
};

std::map<std::string, Count> count_cases(const CheckResult& j) {
    std::map<std::string, std::set<std::string>> cases;
    std::map<std::string, std::set<std::pair<double, double>>> directions;
    for (const Verdict& v : j.verdicts) {
        cases[v.arm].insert(v.check_case);
        if (v.wo) directions[v.arm].insert(*v.wo);
    }
    std::map<std::string, Count> out;
    for (const auto& [arm, check_cases] : cases)
        out[arm] = {check_cases.size(), directions[arm].size() == check_cases.size()};
    return out;
}

void add(Finding& f, const Verdict& v) {
    ++f.count;
    if (!f.worst || v.size > f.worst->size) f.worst = &v;
}

/// Lists what the worst verdict does not state, each once: the sentence of the largest size, with its cases.
void list_sentences(Finding& f, const std::vector<const Verdict*>& verdicts) {
    struct Stated {
        const Sentence* sentence;
        double size = 0;
        std::vector<std::string> cases{};  // first that of the sentence
    };
    std::vector<Stated> others;
    for (const Verdict* v : verdicts)
        for (const Sentence& sentence : v->sentences) {
            const auto states_same = [&](const Sentence& s) { return s.states_same(sentence); };
            if (sentence.what == Sentence::expected || std::ranges::any_of(f.worst->sentences, states_same)) continue;
            auto match =
                std::ranges::find_if(others, [&](const Stated& other) { return states_same(*other.sentence); });
            if (match == others.end()) match = others.insert(others.end(), {&sentence, v->size});
            const bool is_larger = !match->cases.empty() && v->size > match->size;
            if (is_larger) {
                match->sentence = &sentence;
                match->size = v->size;
            }
            match->cases.insert(is_larger ? match->cases.begin() : match->cases.end(), v->check_case);
        }
    for (Stated& other : others) f.sentences.emplace_back(other.sentence->text, std::move(other.cases));
}

/// Where the verdicts are wrong, if not at all w_o: "30 to 60 deg"; what their integrals are; the cause that one of
/// them has.
void note_range(Finding& f, const std::vector<const Verdict*>& verdicts) {
    double low = 1e300, high = -1e300;
    const Verdict *least_verdict = nullptr, *greatest_verdict = nullptr;
    bool has_every_wo = true;
    for (const Verdict* v : verdicts) {
        if (f.named_cause.empty()) f.named_cause = v->cause;
        has_every_wo = has_every_wo && v->wo;
        if (v->wo) {
            low = std::min(low, v->wo->first);
            high = std::max(high, v->wo->first);
        }
        if (!v->integral) continue;
        if (!least_verdict || *v->integral < *least_verdict->integral) least_verdict = v;
        if (!greatest_verdict || *v->integral > *greatest_verdict->integral) greatest_verdict = v;
    }
    if (has_every_wo && f.count < f.total && high > low) f.range = fmt::format(" ({:g} to {:g} deg)", low, high);
    constexpr double one_value = 1.02, no_value = 0.01;
    if (least_verdict && *greatest_verdict->integral > one_value * *least_verdict->integral + no_value &&
        f.named_cause.empty())
        f.named_cause = fmt::format("Over these {} p integrates to {:.4g} ({}) up to {:.4g} ({}).", f.cases,
            *least_verdict->integral, least_verdict->check_case, *greatest_verdict->integral,
            greatest_verdict->check_case);
}

/// The cause of the worst verdict or of another wrong verdict of the same arm, preferably with the same name.
std::string cause_of(const Finding& f, const CheckResult& j) {
    std::string out = f.worst->cause;
    for (const bool needs_name : {true, false})
        for (const Verdict& v : j.verdicts)
            if (out.empty() && v.arm == f.arm && v.state == State::wrong && (!needs_name || v.name == f.name))
                out = v.cause;
    return out;
}

}  // namespace

namespace {

/// The message with a cause, which may be that of another w_o.
std::string described(const Verdict& v, const std::string& cause, FrontEnd front_end) {
    const std::string next = next_step_text(v, front_end);
    return v.message() + (cause.empty() ? "" : " " + cause) + (next.empty() ? "" : " Next step: " + next) +
        (v.timed_message.empty() ? "" : " " + v.timed_message);
}

}  // namespace

std::string describe(const Verdict& v, FrontEnd front_end) { return described(v, v.cause, front_end); }

std::vector<Finding> findings_of(const CheckResult& j) {
    const auto left_out = left_out_of(j);
    const std::map<std::string, Count> counts = count_cases(j);
    std::map<std::tuple<std::string, std::string, State, bool>, std::size_t> positions;
    std::vector<Finding> out;
    std::vector<std::vector<const Verdict*>> members;
    for (const Verdict& v : j.verdicts) {
        if (v.state == State::right || v.state == State::skipped) continue;
        const auto skipped_case = left_out.find({v.arm, v.check_case});
        if (skipped_case != left_out.end() && skipped_case->second.count(v.name)) continue;
        const bool expected = v.expected && !v.why_expected.empty();
        const auto [entry, is_new] =
            positions.try_emplace({v.arm, v.state == State::error ? "" : v.name, v.state, expected}, out.size());
        if (is_new) {
            out.push_back({v.arm, v.name, v.state, expected, 0, counts.at(v.arm).cases,
                counts.at(v.arm).differs_by_wo ? "w_o" : "cases", nullptr, {}});
            members.emplace_back();
        }
        add(out[entry->second], v);
        members[entry->second].push_back(&v);
    }
    for (std::size_t i = 0; i < out.size(); ++i) {
        if (out[i].state == State::wrong) {
            out[i].cause = cause_of(out[i], j);
            note_range(out[i], members[i]);
        }
        if (out[i].state != State::error) list_sentences(out[i], members[i]);
        else
            for (const Verdict* v : members[i])
                if (v->first_failure) out[i].worst = v;
        if (out[i].state == State::error) {
            out[i].total = j.verdicts.size();
            out[i].cases = "verdicts";
        }
    }
    const auto order = [](const Finding& f) {
        const auto name = std::find(verdict_names.begin(), verdict_names.end(), f.name);
        return std::tuple(rank(f.state), f.arm, name - verdict_names.begin(), f.expected);
    };
    std::sort(out.begin(), out.end(), [&](const Finding& a, const Finding& b) { return order(a) < order(b); });
    return out;
}

std::string where_found(const Finding& f) {
    if (f.count == 1 && !f.worst->place.empty()) return "at " + f.worst->place;
    if (f.total == 1 && f.worst->check_case == without_wo) return "";
    const char* words = f.count == 1 ? "at" : f.state == State::wrong ? "worst at" : "as at";
    return fmt::format("at {} of {} {}{}, {} {}", f.count, f.total, f.cases, f.range, words, f.worst->check_case);
}

std::string failure_text(const Finding& f, FrontEnd front_end) {
    const std::string message = described(*f.worst, f.named_cause, front_end);
    if (f.worst->check_case == before_any_case) return ". " + message;
    return fmt::format(": {} of {} verdicts could not be evaluated, the first at {}. {}", f.count, f.total,
        f.worst->check_case, message);
}

std::string describe(const Finding& f, FrontEnd front_end) {
    if (f.state == State::error) return "error" + failure_text(f, front_end);
    const std::string where = where_found(f);
    return fmt::format("{}: {}{}. {}", f.name, word(f.state), where.empty() ? "" : " " + where,
        described(*f.worst, f.named_cause, front_end));
}

std::string skipped_text(const CheckResult& j) {
    if (j.left_out.empty()) return "";
    std::set<Key> cases;
    for (const Verdict& v : j.verdicts) cases.insert({v.arm, v.check_case});
    std::vector<std::string> check_cases;
    bool keeps_valid = true;
    for (const SkippedCase& l : j.left_out) {
        check_cases.push_back(l.check_case);
        keeps_valid = keeps_valid && l.verdicts.size() + 1 == verdict_names.size();
    }
    return fmt::format("Left out: {} at {} of {} w_o ({}). {}", keeps_valid ? "all but valid" : "some verdicts",
        check_cases.size(), cases.size(), fmt::join(check_cases, "; "), j.left_out[0].why);
}

namespace {

/// The first of many cases, and how many follow.
std::string listed_cases(const std::vector<std::string>& cases) {
    constexpr std::size_t most_cases = 3;
    if (cases.size() <= most_cases + 1) return fmt::format("{}", fmt::join(cases, "; "));
    return fmt::format("{}; {} more", fmt::join(std::span(cases).first(most_cases), "; "), cases.size() - most_cases);
}

}  // namespace

std::string summary_of(const CheckResult& j) {
    std::string out;
    for (const Finding& f : findings_of(j))
        if (!f.expected) out += fmt::format("{}{}\n", f.arm.empty() ? "" : f.arm + ", ", describe(f));
    if (const std::string skipped = skipped_text(j); !skipped.empty()) out += skipped + "\n";
    return out;
}

std::string details_of(const CheckResult& j) {
    std::string out;
    for (const Finding& f : findings_of(j)) {
        if (f.expected || f.sentences.empty()) continue;
        out += fmt::format("\n{}, {}: {}\n", f.arm, f.name, word(f.state));
        for (const auto& [sentence, check_cases] : f.sentences)
            out += fmt::format("  [{}] {}\n", listed_cases(check_cases), sentence);
    }
    return out;
}

std::string in_one_line(std::string text) {
    std::ranges::replace(text, '\n', ' ');
    return text;
}

namespace {

/// One line each for the message, the place and the cause.
std::vector<std::string> lines_of(const Finding& f, bool includes_cause) {
    if (f.state == State::error) return {in_one_line(describe(f, FrontEnd::cpp))};
    std::vector<std::string> out = {
        in_one_line(fmt::format("{} is {}: {}", f.name, word(f.state), f.worst->message()))};
    if (const std::string where = where_found(f); !where.empty()) out.push_back("  " + where);
    if (includes_cause && !f.cause.empty()) out.push_back("  " + in_one_line(f.cause));
    return out;
}

/// The next step of the first finding: a check of one w_o if it is wrong, the step of the verdict if it is
/// inconclusive.
std::string next_step_of(const Finding& f) {
    const Verdict& v = *f.worst;
    std::string message = in_one_line(next_step_text(v, FrontEnd::cpp));
    if (message.empty() && v.wo && f.state == State::wrong) message = one_wo_text(*v.wo, FrontEnd::cpp);
    return message.empty() ? "" : "Next: " + message;
}

}  // namespace

std::string what_is_wrong(const CheckResult& result, std::size_t most_lines) {
    std::vector<Finding> findings = findings_of(result);
    std::erase_if(findings, [](const Finding& f) { return f.expected; });
    std::vector<std::string> closing_lines;
    if (const std::string skipped = skipped_text(result); !skipped.empty())
        closing_lines.push_back(in_one_line(skipped));
    if (!findings.empty())
        if (const std::string next = next_step_of(findings[0]); !next.empty()) closing_lines.push_back(next);
    std::vector<std::string> lines;
    std::size_t index = 0;
    for (; index < findings.size(); ++index) {
        const std::vector<std::string> finding_lines =
            lines_of(findings[index], index == 0 || findings[index].cause != findings[0].cause);
        const bool has_others = index + 1 < findings.size();
        if (index > 0 && lines.size() + finding_lines.size() + has_others + closing_lines.size() > most_lines) break;
        lines.insert(lines.end(), finding_lines.begin(), finding_lines.end());
    }
    std::vector<std::string> others;
    for (; index < findings.size(); ++index)
        others.push_back(fmt::format("{} ({})", findings[index].name, word(findings[index].state)));
    if (!others.empty()) lines.push_back(fmt::format("Also not right: {}", fmt::join(others, ", ")));
    lines.insert(lines.end(), closing_lines.begin(), closing_lines.end());
    return lines.empty() ? "" : fmt::format("{}\n", fmt::join(lines, "\n"));
}

std::string unseen_text(const CheckResult& result) {
    if (result.state == State::error) return "";  // the right verdicts are incomplete
    std::map<std::string, double> largest;
    for (const Verdict& v : result.verdicts)
        for (const auto& [kind, size] : v.hidden)
            if (v.state == State::right) largest[kind] = std::max(largest[kind], size);
    const std::vector<std::string> faults = check::found_faults(std::move(largest));
    return faults.empty() ? "" : fmt::format("Found with a probability of 90 %: {}.", fmt::join(faults, ", "));
}

std::string nothing_drawn_text(const CheckResult& result) {
    constexpr double least_share = 0.01;
    std::string out;
    const auto add = [&](double Verdict::* share, const char* what) {
        const auto largest = std::ranges::max_element(result.verdicts, {}, share);
        if (largest == result.verdicts.end() || !((*largest).*share > least_share)) return;
        out += fmt::format("{}Up to {:.3g} % of the draws {}: {}{}.", out.empty() ? "" : " ", 100 * (*largest).*share,
            what, largest->arm, largest->check_case == without_wo ? "" : " at " + largest->check_case);
    };
    add(&Verdict::nothing, "are no sample (they have pdf 0)");
    add(&Verdict::outside, "have a direction below the surface, where pdf(w) is 0");
    return out;
}

std::vector<std::string> closing_texts(const CheckResult& result) {
    std::vector<std::string> out{skipped_text(result), nothing_drawn_text(result), unseen_text(result)};
    std::erase(out, "");
    return out;
}

std::string what_was_tested(const CheckResult& result) {
    std::map<std::string, std::vector<std::string>> skipped;  // verdicts by reason
    for (const Verdict& v : result.verdicts) {
        if (v.state != State::skipped) continue;
        std::vector<std::string>& names = skipped[in_one_line(v.message())];
        if (std::ranges::find(names, v.name) == names.end()) names.push_back(v.name);
    }
    std::string out;
    for (const auto& [reason, names] : skipped) out += fmt::format("Skipped: {}. {}\n", fmt::join(names, ", "), reason);
    for (const std::string& text : closing_texts(result)) out += text + "\n";
    return out;
}

// ---- The text of a density that draws imply (check/report/implied.cpp). Rings of 15 degrees are means of the finer
// rings, weighted by solid angle.

namespace {

constexpr double edges[] = {0, 15, 30, 45, 60, 75, 90, 180};  // degrees
constexpr std::size_t rings = std::size(edges) - 1, most_lines = 16;

/// "2.61 +- 0.02", to the first digit of the error; "0" if there are no draws.
std::string with_error(double v, double se) {
    if (!(v > 0)) return "0";
    if (!(se > 0)) return fmt::format("{:.4g}", v);
    const int digits = static_cast<int>(std::floor(math::log10(se)));
    if (digits > 0 || digits < -6) return fmt::format("{:.3g} +- {:.1g}", v, se);
    return fmt::format("{:.{}f} +- {:.{}f}", v, -digits, se, -digits);
}

/// The mean over the rings between two angles.
std::string ring_text(const std::vector<ImpliedDensity::Ring>& fine_rings, double from, double to) {
    double sum = 0, square = 0, covered_angle = 0;
    for (const ImpliedDensity::Ring& r : fine_rings) {
        if (r.from < from || r.to > to) continue;
        const double angle = math::cos(r.from * pi / 180) - math::cos(r.to * pi / 180);
        sum += r.pdf * angle;
        square += sqr(r.error * angle);
        covered_angle += angle;
    }
    if (to > 90) covered_angle = 1;  // the list ends at the last ring with draws
    return covered_angle > 0 ? with_error(sum / covered_angle, std::sqrt(square) / covered_angle) : "-";
}

std::string line_of(const ImpliedDensity& d, const std::string& name) {
    std::string out = fmt::format("{:<20}", name);
    for (std::size_t k = 0; k < rings; ++k) out += fmt::format(" {:<15}", ring_text(d.rings, edges[k], edges[k + 1]));
    return out + " " + with_error(d.peak, d.peak_error) + "\n";
}

}  // namespace

std::string implied_text(const CheckResult& j) {
    std::vector<const Verdict*> verdicts;
    bool has_one_arm = true;
    for (const Verdict& v : j.verdicts)
        if (v.implied) {
            verdicts.push_back(&v);
            has_one_arm = has_one_arm && v.arm == verdicts[0]->arm;
        }
    if (verdicts.empty()) return "";
    std::string out = fmt::format("{:<20}", "degrees from n");
    for (std::size_t k = 0; k < rings; ++k)
        out += fmt::format(" {:<15}", fmt::format("{:g} to {:g}", edges[k], edges[k + 1]));
    out += " highest\n";
    for (std::size_t i = 0; i < std::min(verdicts.size(), most_lines); ++i)
        out += line_of(*verdicts[i]->implied,
            has_one_arm ? verdicts[i]->check_case : verdicts[i]->arm + " " + verdicts[i]->check_case);
    if (verdicts.size() > most_lines) out += fmt::format("and {} more\n", verdicts.size() - most_lines);
    return "The density that the draws imply, since there is no pdf(w): 1/sr, the mean over each ring and one standard "
           "error.\n" +
        out + "Finer in the JSON: implied_rings, implied_bins.";
}

}  // namespace crescent
