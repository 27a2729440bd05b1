// The conclusions from the measurements of a lesson, in words: which is largest, by what factor, a sampler's verdicts.
// Every number was measured for this answer, and `kind` names the result, so that the text can depend on it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "api.h"

namespace crescent::web {

namespace {

struct Found {
    std::string answer, kind;
    std::vector<std::string> lines{};
};

/// A measurement of measure.cpp with its text.
struct Series {
    std::string name;  // "cosine, N = 64: RMSE of H"
    double n = 0, median = 0, low = 0, high = 0;
    double mean = 0, hit_share = 0;  // Y of the reference; share of the directions that met a light
    std::vector<double> rmse;

    std::string line() const {
        return fmt::format(
            "{} {}, from {} to {} between the 5 % and 95 % quantiles of {} seeds; mean Y there is {}, and "
            "{} % of the directions met a light's disk",
            name, figures(median), figures(low), figures(high), rmse.size(), figures(mean, 3),
            figures(100 * hit_share, 2));
    }
};

Series series_of(const ordered_json& v) {
    Series out{v.at("name").get<std::string>(), v.at("n").get<double>(), v.at("median").get<double>(),
        v.at("q05").get<double>(), v.at("q95").get<double>(), v.at("mean").get<double>(), v.at("met").get<double>(),
        {}};
    for (const auto& x : v.at("rmse")) out.rmse.push_back(x.get<double>());
    return out;
}

/// Returns the largest or the smallest of these if its band is disjoint from every other; else "overlap".
Found extreme_of(const ordered_json& query, const ordered_json& measurements) {
    const double sign = query.at("by").get<std::string>() == "largest" ? 1 : -1;
    std::vector<Series> series;
    for (const auto& v : measurements) series.push_back(series_of(v));
    const auto best = std::ranges::max_element(series, {}, [&](const Series& s) { return sign * s.median; });
    Found out{query.at("options").at(static_cast<std::size_t>(best - series.begin())).get<std::string>(), ""};
    bool is_apart = true;
    for (const Series& s : series) {
        out.lines.push_back(s.line());
        if (&s != &*best) is_apart = is_apart && (sign > 0 ? s.high < best->low : best->high < s.low);
    }
    out.kind = is_apart ? out.answer : "overlap";
    if (!is_apart) out.answer = "overlap";
    return out;
}

/// The same for the request, with the additional measurements.
Found extreme(const ordered_json& query) {
    Found out = extreme_of(query, query.at("of"));
    if (!query.contains("beside")) return out;
    Found additions = extreme_of(query, query.at("beside"));
    std::ranges::move(additions.lines, std::back_inserter(out.lines));
    return out;
}

/// Returns the factor from the first to the second, seed by seed.
Found factor(const ordered_json& query) {
    const Series a = series_of(query.at("of").at(0)), b = series_of(query.at("of").at(1));
    std::vector<double> factors;
    for (std::size_t k = 0; k < a.rmse.size(); ++k) factors.push_back(a.rmse[k] / b.rmse[k]);
    const double median = quantile(factors, 0.5), low = quantile(factors, 0.05), high = quantile(factors, 0.95);
    const auto rise_count = std::ranges::count_if(factors, [](double x) { return x < 1; });
    Found out{figures(median, 3), rise_count > 0 ? "rises" : "falls", {a.line(), b.line()}};
    out.lines.push_back(
        fmt::format("Seed by seed the error falls by a factor of {}, from {} to {}; it rises for {} of {} seeds",
            figures(median, 3), figures(low, 3), figures(high, 3), rise_count, factors.size()));
    out.lines.push_back(fmt::format("A finite variance gives √({:g} / {:g}) = {} in the mean of squares", b.n, a.n,
        figures(std::sqrt(b.n / a.n), 3)));
    return out;
}

Found spread_over_seeds(const ordered_json& query) {
    const Series s = series_of(query.at("of").at(0));
    const double times = s.high / s.low;
    return {figures(times, 3), times > 2 ? "wide" : "narrow",
        {s.line(), fmt::format("the 95 % quantile is {} times the 5 % quantile", figures(times, 3))}};
}

const ordered_json& verdict_of(const ordered_json& entry, const std::string& name) {
    for (const auto& v : entry.at("verdicts"))
        if (v.at("name").get<std::string>() == name) return v;
    throw InputError({"lesson", 0, 0}, "no verdict '" + name + "' in " + entry.dump());
}
/// Returns the smallest p-value of a verdict, each for all members of its family; "" if it has none.
std::string least_p(const ordered_json& v) {
    const ordered_json p_values = v.at("evidence").value("p", ordered_json::object());
    double smallest = 1;
    for (const auto& p : p_values) smallest = std::min(smallest, p.get<double>());
    if (p_values.empty()) return "";
    return fmt::format("; the smallest p-value of its tests, {} in all, is {}", p_values.size(), figures(smallest, 2));
}
std::string message_of(const ordered_json& v) {
    const auto name = v.at("name").get<std::string>(), state = v.at("state").get<std::string>(),
               message = v.at("message").get<std::string>();
    if (message.empty()) return fmt::format("{}: {}{}", name, state, least_p(v));
    return fmt::format("{}: {}. {}", name, state, message);
}
std::string state_of(const ordered_json& v) { return v.at("state").get<std::string>(); }

/// Returns the case on a surface; without a surface, the only one.
const ordered_json& case_on(const ordered_json& result, const std::string& surface) {
    for (const auto& entry : result.at("cases"))
        if (surface.empty() || entry.at("surface").get<std::string>() == surface) return entry;
    throw InputError({"lesson", 0, 0}, "'" + surface + "' is not a surface on which it was checked");
}

/// Returns whether light is out of reach.
Found unbiased(const ordered_json& entry) {
    const ordered_json& support = verdict_of(entry, "support");
    Found out{state_of(support), state_of(support), {"on " + entry.at("case").get<std::string>(), message_of(support)}};
    out.lines.push_back(message_of(verdict_of(entry, "mean")));
    return out;
}

/// Compares chi-square with the other verdicts.
Found beside_chi_square(const ordered_json& entry) {
    const ordered_json& density = verdict_of(entry, "density");
    Found out{"right", "", {message_of(density)}};
    for (const auto& v : entry.at("verdicts")) {
        if (v.at("name").get<std::string>() == "density" || state_of(v) != "wrong") continue;
        out.answer = "wrong";
        out.lines.push_back(message_of(v));
    }
    out.kind = state_of(density) + "-" + out.answer;
    return out;
}

/// Compares a common t-test, on the weights used by `mean`, with the verdict `mean`.
Found beside_t_test(const ordered_json& entry) {
    const ordered_json& mean = verdict_of(entry, "mean");
    const ordered_json& e = mean.at("evidence");
    const double deviation = e.at("mean").get<double>() - e.at("quadrature").get<double>(),
                 t = deviation / e.at("standard_error").get<double>();
    const double p = student_p(t, e.at("draws").get<double>() - 1);
    const bool rejects = p < TestSettings{}.alpha;
    Found out{state_of(mean), (rejects ? "rejects-" : "passes-") + state_of(mean), {}};
    out.lines.push_back(fmt::format("The t-test: mean {} ± {}, integral {}, t = {}, p {} {}: it {}",
        figures(e.at("mean").get<double>()), figures(e.at("standard_error").get<double>(), 2),
        figures(e.at("quadrature").get<double>()), figures(t, 3), p < 1e-6 ? "<" : "=",
        p < 1e-6 ? "0.000001" : figures(p, 2), rejects ? "rejects" : "does not reject"));
    for (const char* name : {"support", "density", "tail", "mean"})
        out.lines.push_back(message_of(verdict_of(entry, name)));
    return out;
}

/// Returns which of several samplers has no fault.
Found which_is_right(const ordered_json& query) {
    Found out{"", "none"};
    std::size_t right_count = 0;
    for (std::size_t k = 0; k < query.at("of").size(); ++k) {
        const ordered_json& result = query.at("of").at(k);
        const std::string option = query.at("options").at(k).get<std::string>(),
                          name = result.at("name").get<std::string>();
        std::string first;
        for (const auto& v : result.at("cases").at(0).at("verdicts"))
            if (first.empty() && state_of(v) == "wrong") first = message_of(v);
        if (first.empty()) {
            out.answer = option;
            ++right_count;
        }
        out.lines.push_back(
            fmt::format("sampler {}, {}: {}", option, name, first.empty() ? "no verdict is wrong" : first));
    }
    if (right_count == 1) out.kind = "one";
    else out.answer = "none";
    return out;
}

Found concluded(const ordered_json& query) {
    const auto method = query.at("by").get<std::string>();
    if (method == "largest" || method == "smallest") return extreme(query);
    if (method == "factor") return factor(query);
    if (method == "spread") return spread_over_seeds(query);
    if (method == "which") return which_is_right(query);
    const ordered_json& entry = case_on(query.at("of").at(0), query.value("surface", ""));
    if (method == "support") return unbiased(entry);
    if (method == "chi-square") return beside_chi_square(entry);
    if (method == "t-test") return beside_t_test(entry);
    throw InputError({"lesson", 0, 0}, "no way to conclude by '" + method + "'");
}

}  // namespace

/// `{by, options, surface, of: [results of measure or checked], beside: [other results of measure]}` ->
/// {answer, kind, lines}.
CRESCENT_EXPORT(concluded)()->void {
    const Found conclusion = concluded(request());
    respond(ordered_json{{"answer", conclusion.answer}, {"kind", conclusion.kind}, {"lines", conclusion.lines}});
}

}  // namespace crescent::web
