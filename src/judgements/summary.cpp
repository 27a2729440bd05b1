// Verdicts of one arm, name and state are one finding, told by the one that is furthest off; the other sentences follow
// with the w_o at which they were said.
#include "judgements/summary.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <set>

#include "judgements/all.h"
#include "judgements/verdict.h"
#include "subjects/subject.h"

namespace crescent::inline judgements {

namespace {

int rank(State s) { return s == State::wrong ? 0 : s == State::error ? 1 : 2; }

/// How far off a verdict is, in whatever it measures: comparable within one verdict's name alone.
double badness(const Verdict& v) {
    const auto number = [&](const char* key) {
        const auto at = v.evidence.find(key);
        return at != v.evidence.end() && at->is_number() ? at->get<double>() : std::nan("");
    };
    for (const char* key : {"lost_fraction", "largest_relative_difference", "z", "k"})
        if (const double x = std::fabs(number(key)); std::isfinite(x)) return x;
    if (const double x = number("chi2") / number("degrees"); std::isfinite(x)) return x;
    for (const char* key : {"integral", "smallest_p_jacobian"})
        if (const double x = std::fabs(number(key) - 1); std::isfinite(x)) return x;
    const double albedo = number("albedo");
    return std::isfinite(albedo) ? albedo : 0;
}

using Key = std::pair<std::string, std::string>;  // arm and case

std::map<Key, std::set<std::string>> left_out_of(const Judgement& j) {
    std::map<Key, std::set<std::string>> out;
    for (const LeftOut& l : j.left_out) out[{l.arm, l.trial}].insert(l.verdicts.begin(), l.verdicts.end());
    return out;
}

struct Count {
    std::size_t cases = 0;
    bool by_wo = true;  // they differ by w_o alone
};

std::map<std::string, Count> count_cases(const Judgement& j) {
    std::map<std::string, std::set<std::string>> cases;
    for (const Verdict& v : j.verdicts) cases[v.arm].insert(v.trial);
    std::map<std::string, Count> out;
    for (const auto& [arm, trials] : cases)
        out[arm] = {trials.size(), std::all_of(trials.begin(), trials.end(), [](const std::string& t) {
                        return t.starts_with("w_o") && t.find(',') == std::string::npos;
                    })};
    return out;
}

void add(Finding& f, const Verdict& v) {
    ++f.count;
    if (!f.worst || badness(v) > badness(*f.worst)) f.worst = &v;
}

/// What a verdict says beyond what the worst of its finding says already.
std::string told_beside(const Verdict& v, const std::set<std::string>& already) {
    std::string out;
    for (const std::string& sentence : sentences_of(told(v)))
        if (!already.contains(sentence)) out += (out.empty() ? "" : " ") + sentence;
    return out;
}

void list_sentences(Finding& f, const std::vector<const Verdict*>& all) {
    const std::vector<std::string> of_worst = sentences_of(told(*f.worst));
    const std::set<std::string> already(of_worst.begin(), of_worst.end());
    for (const Verdict* v : all) {
        const std::string say = told_beside(*v, already);
        if (say.empty()) continue;
        const auto same =
            std::find_if(f.sentences.begin(), f.sentences.end(), [&](const auto& s) { return s.first == say; });
        if (same != f.sentences.end()) same->second.push_back(v->trial);
        else f.sentences.push_back({say, {v->trial}});
    }
}

/// A diagnosis of the same arm for a worst verdict that nothing usual explains.
void find_explained(Finding& f, const Judgement& j) {
    if (f.state != State::wrong || f.worst->evidence.value("diagnosis", "") != "none") return;
    for (const Verdict& v : j.verdicts)
        if (v.arm == f.arm && v.state == State::wrong && v.evidence.contains("diagnosis_says")) {
            const bool better = !f.explained || (v.name == f.name && f.explained->name != f.name);
            if (better) f.explained = &v;
        }
}

}  // namespace

std::string told(const Verdict& v) {
    return v.say + (v.settle.empty() ? "" : " What would settle it: " + v.settle) +
        (v.say_timed.empty() ? "" : " " + v.say_timed);
}

std::vector<std::string> sentences_of(const std::string& text) {
    std::vector<std::string> out;
    std::size_t from = 0;
    for (std::size_t at = text.find(". "); at != std::string::npos; at = text.find(". ", at + 1)) {
        if (at + 2 >= text.size() || text[at + 2] < 'A' || text[at + 2] > 'Z') continue;
        out.push_back(text.substr(from, at + 1 - from));
        from = at + 2;
    }
    out.push_back(text.substr(from));
    return out;
}

std::vector<Finding> findings_of(const Judgement& j) {
    const auto left_out = left_out_of(j);
    const std::map<std::string, Count> counts = count_cases(j);
    std::map<std::tuple<std::string, std::string, State, bool>, std::size_t> place;
    std::vector<Finding> out;
    std::vector<std::vector<const Verdict*>> members;
    for (const Verdict& v : j.verdicts) {
        if (v.state == State::right || v.state == State::skipped) continue;
        const auto left = left_out.find({v.arm, v.trial});
        if (left != left_out.end() && left->second.count(v.name)) continue;
        const bool expected = v.expected && !v.why_expected.empty();
        const auto [at, fresh] =
            place.try_emplace({v.arm, v.state == State::error ? "" : v.name, v.state, expected}, out.size());
        if (fresh) {
            out.push_back({v.arm, v.name, v.state, expected, 0, counts.at(v.arm).cases,
                counts.at(v.arm).by_wo ? "w_o" : "cases", nullptr, {}});
            members.emplace_back();
        }
        add(out[at->second], v);
        members[at->second].push_back(&v);
    }
    for (std::size_t i = 0; i < out.size(); ++i) {
        find_explained(out[i], j);
        if (out[i].state != State::error) list_sentences(out[i], members[i]);
        else
            for (const Verdict* v : members[i])
                if (v->evidence.contains("first_fault")) out[i].worst = v;
        if (out[i].state == State::error) out[i].of = j.verdicts.size(), out[i].cases = "verdicts";
    }
    const auto order = [](const Finding& f) {
        const auto name = std::find(verdict_names.begin(), verdict_names.end(), f.name);
        return std::tuple(rank(f.state), f.arm, name - verdict_names.begin(), f.expected);
    };
    std::sort(out.begin(), out.end(), [&](const Finding& a, const Finding& b) { return order(a) < order(b); });
    return out;
}

std::string told(const Finding& f) {
    if (f.state == State::error && f.worst->trial == before_any_trial) return "error. " + told(*f.worst);
    if (f.state == State::error)
        return fmt::format("error: {} of {} verdicts could not be asked, the first at {}. {}", f.count, f.of,
            f.worst->trial, told(*f.worst));
    const char* as = f.count == 1 ? "at" : f.state == State::wrong ? "worst at" : "as at";
    const bool alone = f.of == 1 && f.worst->trial == without_wo;
    std::string out = fmt::format("{}: {}{}. {}", f.name, word(f.state),
        alone ? "" : fmt::format(" at {} of {} {}, {} {}", f.count, f.of, f.cases, as, f.worst->trial), told(*f.worst));
    if (f.explained)
        out += fmt::format(" What explains it at {}: {}.", f.explained->trial,
            f.explained->evidence["diagnosis_says"].get<std::string>());
    return out;
}

std::string left_out_told(const Judgement& j) {
    if (j.left_out.empty()) return "";
    std::set<Key> cases;
    for (const Verdict& v : j.verdicts) cases.insert({v.arm, v.trial});
    std::vector<std::string> trials;
    bool valid_alone = true;
    for (const LeftOut& l : j.left_out) {
        trials.push_back(l.trial);
        valid_alone = valid_alone && l.verdicts.size() + 1 == verdict_names.size();
    }
    return fmt::format("Left out: {} at {} of {} w_o ({}). {}", valid_alone ? "all but valid" : "some verdicts",
        trials.size(), cases.size(), fmt::join(trials, "; "), j.left_out[0].why);
}

std::string summary_of(const Judgement& j) {
    std::string out, details, arm;
    for (const Finding& f : findings_of(j)) {
        if (f.expected) continue;
        out += fmt::format("{}{}\n", f.arm.empty() ? "" : f.arm + ", ", told(f));
        if (f.sentences.empty()) continue;
        details += fmt::format("\n{}, {}: {}\n", f.arm, f.name, word(f.state));
        for (const auto& [say, trials] : f.sentences)
            details += fmt::format("  [{}] {}\n", fmt::join(trials, "; "), say);
    }
    if (const std::string left = left_out_told(j); !left.empty()) out += left + "\n";
    return out + details;
}

std::string what_is_wrong(const Judgement& judgement) { return summary_of(judgement); }

std::string unseen_told(const Judgement& judgement) {
    double integral = 0, bin = 0;
    if (judgement.state == State::error) return "";  // what there is of right verdicts is not the whole
    for (const Verdict& v : judgement.verdicts) {
        if (v.state != State::right) continue;
        integral = std::max(integral, v.evidence.value("unseen", 0.0));
        bin = std::max(bin, v.evidence.value("unseen_in_one_bin", 0.0));
    }
    std::string out;
    if (integral > 0) out = fmt::format("p that integrates to one but for {:.2g}", integral);
    if (bin > 0)
        out += fmt::format(
            "{}{:.2g} % of the draws too many or too few in one bin", out.empty() ? "" : ", and ", 100 * bin);
    return out.empty() ? "" : "What is right could hide " + out + ".";
}

std::string nothing_drawn_told(const Judgement& judgement) {
    double most = 0;
    const Verdict* where = nullptr;
    for (const Verdict& v : judgement.verdicts)
        if (v.evidence.contains("share_that_drew_nothing"))  // what was cut short may have no evidence at all
            if (const double share = v.evidence["share_that_drew_nothing"].get<double>(); share > most)
                most = share, where = &v;
    if (!where) return "";
    return fmt::format("Up to {:.3g} % of the draws drew nothing, pdf 0 or under the horizon: {} at {}.", 100 * most,
        where->arm, where->trial);
}

}  // namespace crescent::inline judgements
