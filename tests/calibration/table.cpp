// Records with the same engine, mode, number of w_o and transport (process or pipe) form a group, divided by set.
#include "tests/calibration/table.h"

#include <algorithm>
#include <boost/math/distributions/beta.hpp>
#include <fmt/format.h>
#include <functional>
#include <map>
#include <set>

#include "tests/calibration/records.h"

namespace crescent::calibration {

using Json = nlohmann::ordered_json;

double upper_bound(std::uint64_t hits, std::uint64_t of) {
    if (hits >= of) return 1;
    return boost::math::quantile(
        boost::math::beta_distribution<>(static_cast<double>(hits) + 1, static_cast<double>(of - hits)), 0.95);
}
double lower_bound(std::uint64_t hits, std::uint64_t of) {
    if (hits == 0) return 0;
    return boost::math::quantile(
        boost::math::beta_distribution<>(static_cast<double>(hits), static_cast<double>(of - hits) + 1), 0.05);
}

namespace {

using Records = std::vector<const Json*>;
using Groups = std::map<std::string, Records>;

std::string text(const Json& r, const char* key) { return r.at(key).get<std::string>(); }
bool found(const Json& r) { return r.at("state") == "wrong"; }
bool right(const Json& r) { return r.at("expected") == "right"; }

Groups grouped(const Records& all, const std::function<std::string(const Json&)>& key) {
    Groups out;
    for (const Json* r : all) out[key(*r)].push_back(r);
    return out;
}
std::string run_of(const Json& r) {
    const int wo = r.at("wo").get<int>();
    return fmt::format("{} {}{}{}", text(r, "engine"), text(r, "mode"), text(r, "by") == "pipe" ? " by pipe" : "",
        wo == 0 ? "" : fmt::format(", {} w_o", wo));
}
Records only(const Records& all, const std::function<bool(const Json&)>& keep) {
    Records out;
    std::ranges::copy_if(all, std::back_inserter(out), [&](const Json* r) { return keep(*r); });
    return out;
}
std::uint64_t count(const Records& all, const std::function<bool(const Json&)>& is) {
    return static_cast<std::uint64_t>(std::ranges::count_if(all, [&](const Json* r) { return is(*r); }));
}
double quantile_of(const Records& all, double q, const std::function<double(const Json&)>& value) {
    std::vector<double> v;
    for (const Json* r : all) v.push_back(value(*r));
    std::ranges::sort(v);
    return v.empty() ? 0 : v[std::min(v.size() - 1, static_cast<std::size_t>(q * static_cast<double>(v.size())))];
}

std::string false_positives(const Records& all) {
    std::string out =
        "| run | set | correct cases | reported wrong | upper bound | inconclusive | error |\n"
        "|---|---|---|---|---|---|---|\n";
    for (const auto& [run, of_run] : grouped(only(all, right), run_of))
        for (const auto& [set, r] : grouped(of_run, [](const Json& j) { return text(j, "set"); })) {
            if (set.starts_with("stated")) continue;
            const std::uint64_t wrong = count(r, found);
            out += fmt::format("| {} | {} | {} | {} | {:.3g} % | {} | {} |\n", run, set, r.size(), wrong,
                100 * upper_bound(wrong, r.size()),
                count(r, [](const Json& j) { return j["state"] == "inconclusive"; }),
                count(r, [](const Json& j) { return j["state"] == "error"; }));
        }
    return out;
}

/// Families with a case that is not reported right.
std::string by_family(const Records& all) {
    std::string out;
    for (const auto& [run, of_run] : grouped(only(all, right), run_of))
        for (const auto& [family, r] : grouped(of_run, [](const Json& j) { return text(j, "family"); })) {
            const std::uint64_t wrong = count(r, found),
                                calls_right = count(r, [](const Json& j) { return j["state"] == "right"; });
            if (calls_right < r.size())
                out += fmt::format(
                    "| {} | {} | {} | {} | {} |\n", run, family, r.size(), wrong, r.size() - calls_right - wrong);
        }
    const char* head = "| run | family | correct cases | reported wrong | inconclusive |\n|---|---|---|---|---|\n";
    return out.empty() ? "" : head + out;
}

std::string called_wrong(const Records& all) {
    std::string out;
    for (const Json* r : only(all, [](const Json& j) { return right(j) && (found(j) || j["state"] == "error"); }))
        out += fmt::format("| {} | {} {} {} | {} ({}), {} | {} by {} |\n", run_of(*r), text(*r, "set"),
            r->at("seed").get<std::uint64_t>(), r->at("index").get<std::uint64_t>(), text(*r, "family"),
            text(*r, "parameters"), text(*r, "real"), text(*r, "state"), r->at("wrong").dump());
    return out.empty() ? "" : "| run | case | sampler | reported |\n|---|---|---|---|\n" + out;
}

/// "9 of 10" for each run, by kind and size; runs are columns. From 100 cases on with the lower bound of the rate.
std::string found_by_size(const Records& all, const std::set<std::string>& runs) {
    std::string out = "| set | fault | size |";
    for (const std::string& run : runs) out += " " + run + " |";
    out += "\n|---|---|---|";
    for (std::size_t k = 0; k < runs.size(); ++k) out += "---|";
    out += "\n";
    const auto line = [&](const std::string& head, const Records& r) {
        out += head;
        for (const auto& run : runs) {
            const Records of = only(r, [&](const Json& j) { return run_of(j) == run; });
            const std::uint64_t hits = count(of, found);
            if (of.empty()) out += " |";
            else if (of.size() < 100) out += fmt::format(" {} of {} |", hits, of.size());
            else out += fmt::format(" {} of {}, over {:.3f} |", hits, of.size(), lower_bound(hits, of.size()));
        }
        out += "\n";
    };
    for (const auto& [set, of_set] : grouped(all, [](const Json& j) { return text(j, "set"); })) {
        std::map<std::pair<std::string, double>, Records> cells;
        const bool by_size = set != "known" && set != "faults" && set != "stated" && set != "stated-held-out";
        for (const Json* r : of_set)
            cells[by_size ? std::pair{text(*r, "kind"), r->at("size").get<double>()} : std::pair{std::string("-"), 0.0}]
                .push_back(r);
        for (const auto& [cell, r] : cells)
            line(fmt::format("| {} | {} | {} |", set, cell.first, cell.second ? fmt::format("{:g}", cell.second) : "-"),
                r);
        if (cells.size() > 1) line(fmt::format("| {} | all | - |", set), of_set);
    }
    return out;
}

std::string missed(const Records& all) {
    std::string out;
    for (const Json* r : all)
        if (!found(*r))
            out += fmt::format("| {} | {} {} {} | {} {:g} in {} ({}), {} | {} |\n", run_of(*r), text(*r, "set"),
                r->at("seed").get<std::uint64_t>(), r->at("index").get<std::uint64_t>(), text(*r, "kind"),
                r->at("size").get<double>(), text(*r, "family"), text(*r, "parameters"), text(*r, "real"),
                text(*r, "state"));
    return out.empty() ? "" : "| run | case | fault | reported |\n|---|---|---|---|\n" + out;
}

/// Cases that two runs of different engines share: found by both, by one only, by none.
std::string paired(const Records& all, const std::set<std::string>& runs) {
    std::string out;
    for (auto a = runs.begin(); a != runs.end(); ++a)
        for (auto b = std::next(a); b != runs.end(); ++b) {
            std::map<std::string, std::pair<int, int>> both;  // of a and of b: 1 found, 0 not found, -1 not run
            for (const Json* r : all) {
                auto& [of_a, of_b] = both.emplace(fmt::format("{} {} {} {}", text(*r, "set"), r->at("seed").dump(),
                                                      r->at("index").dump(), r->at("wo").dump()),
                                             std::pair{-1, -1})
                                         .first->second;
                if (run_of(*r) == *a) of_a = found(*r);
                if (run_of(*r) == *b) of_b = found(*r);
            }
            int n[2][2] = {};
            for (const auto& [key, pair] : both)
                if (pair.first >= 0 && pair.second >= 0) ++n[pair.first][pair.second];
            if (n[0][0] + n[0][1] + n[1][0] + n[1][1] > 0)
                out += fmt::format("| {} | {} | {} | {} | {} | {} |\n", *a, *b, n[1][1], n[1][0], n[0][1], n[0][0]);
        }
    return out.empty()
        ? ""
        : "| A | B | found by both | by A only | by B only | by none |\n|---|---|---|---|---|---|\n" + out;
}

/// The causes of the faults that are found: named causes where the cause is known, and where it has no name.
std::string causes(const Records& all) {
    std::string out =
        "| run | set | found, with a cause | cause named | with others | only another | none | "
        "found, without a cause | a true one named | a false one named |\n|---|---|---|---|---|---|---|---|---|---|\n";
    const auto names = [](const Json& j) { return causes_of(j).named; };
    const auto silent = [](const Json& j) { return causes_of(j).given == 0; };
    const auto others = [](const Json& j) { return causes_of(j).others; };
    for (const auto& [run, of_run] : grouped(only(all, found), run_of))
        for (const auto& [set, r] : grouped(of_run, [](const Json& j) { return text(j, "set"); })) {
            const Records with = only(r, [](const Json& j) { return text(j, "cause") != ""; });
            const Records without = only(r, [](const Json& j) { return text(j, "cause") == ""; });
            const std::uint64_t named = count(with, names), none = count(with, silent);
            const double share = with.empty() ? 0 : static_cast<double>(named) / static_cast<double>(with.size());
            out += fmt::format("| {} | {} | {} | {} = {:.1f} % | {} | {} | {} | {} | {} | {} |\n", run, set,
                with.size(), named, 100 * share, count(with, others), with.size() - named - none, none, without.size(),
                count(without, names), count(without, others));
        }
    return out;
}

std::string stated(const Records& all) {
    std::string out;
    const Records r = only(all, [](const Json& j) { return j.contains("stated_size"); });
    for (const auto& [run, of_run] : grouped(r, run_of))
        for (const auto& [kind, of_kind] : grouped(of_run, [](const Json& j) { return text(j, "kind"); })) {
            const Records with = only(of_kind, [](const Json& j) { return !j["stated_size"].is_null(); });
            const std::uint64_t hits = count(with, found);
            out += fmt::format("| {} | {} | {} | {} | {:.3g} | {} | {:.2g} |\n", run, kind, of_kind.size(), with.size(),
                quantile_of(with, 0.5, [](const Json& j) { return j["stated_size"].get<double>(); }), hits,
                with.empty() ? 0 : lower_bound(hits, with.size()));
        }
    return out.empty() ? ""
                       : "| run | fault | cases | with a stated size | median size | found | lower bound "
                         "|\n|---|---|---|---|---|---|---|\n" +
            out;
}

std::string cost(const Records& all) {
    std::string out =
        "| run | set | cases | CPU s per w_o, median | 90 % | evaluations per w_o, median | largest in all |\n"
        "|---|---|---|---|---|---|---|\n";
    for (const auto& [run, of_run] : grouped(all, run_of))
        for (const auto& [set, r] : grouped(of_run, [](const Json& j) { return text(j, "set"); })) {
            const auto a_wo = [](const char* key) {
                return [key](const Json& j) { return j[key].get<double>() / std::max(1, j["directions"].get<int>()); };
            };
            out += fmt::format("| {} | {} | {} | {:.3f} | {:.3f} | {:.0f} | {:.0f} |\n", run, set, r.size(),
                quantile_of(r, 0.5, a_wo("cpu")), quantile_of(r, 0.9, a_wo("cpu")),
                quantile_of(r, 0.5, a_wo("evaluations")),
                quantile_of(r, 1, [](const Json& j) { return j["evaluations"].get<double>(); }));
        }
    return out;
}

/// Shares of p-values of right samplers with random parameters below each level; for an exact test the share is the
/// level.
std::string p_values(const Records& all) {
    std::string out;
    const Records at_random = only(all, [](const Json& j) { return text(j, "set").starts_with("right"); });
    for (const auto& [run, r] : grouped(at_random, run_of)) {
        std::map<std::string, std::vector<double>> by;
        for (const Json* j : r)
            for (const auto& [name, p] : j->at("p").items()) by[name].push_back(p.get<double>());
        for (const auto& [name, p] : by) {
            out += fmt::format("| {} | {} | {} |", run, name, p.size());
            for (const double level : {0.5, 0.1, 0.01, 1e-3, 1e-4, 1e-5})
                out += fmt::format(" {:.3g} |", static_cast<double>(std::ranges::count_if(p, [&](double v) {
                    return v < level;
                })) / static_cast<double>(p.size()));
            out += "\n";
        }
    }
    return out.empty() ? ""
                       : "| run | p-value | cases | < .5 | < .1 | < .01 | < 1e-3 | < 1e-4 | < 1e-5 "
                         "|\n|---|---|---|---|---|---|---|---|---|\n" +
            out;
}

}  // namespace

std::string table_of(const std::vector<Json>& records) {
    Records all;
    std::set<std::string> runs;
    for (const Json& r : records) {
        all.push_back(&r);
        runs.insert(run_of(r));
    }
    const Records wrong = only(all, [](const Json& j) { return !right(j); });
    std::string out;
    const auto section = [&](const char* title, const std::string& body) {
        if (!body.empty()) out += fmt::format("### {}\n\n{}\n", title, body);
    };
    section("Correct samplers", false_positives(all));
    section("Correct samplers by family", by_family(all));
    section("Correct samplers reported wrong", called_wrong(all));
    section("Faults found", found_by_size(wrong, runs));
    section("Faults found, paired", paired(wrong, runs));
    section("Faults missed", missed(wrong));
    section("Causes", causes(wrong));
    section("Stated sizes", stated(all));
    section("Cost", cost(all));
    section("p-values of correct samplers", p_values(all));
    return out;
}

}  // namespace crescent::calibration
