// Read off the evidence: implied_rings and implied_peak of density (check/report/implied.cpp), not_looked_at of
// physics. Rings of 15 degrees are means of the evidence's own, by solid angle.
#include "judgements/told_last.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <vector>

#include "base/vec.h"
#include "math/functions.h"
#include "simd/scalar.h"

namespace crescent::inline judgements {

namespace {

constexpr double edges[] = {0, 15, 30, 45, 60, 75, 90, 180};  // degrees
constexpr std::size_t rings = std::size(edges) - 1, most_lines = 16;

/// "2.61 +- 0.02", to the first digit of the error; "0" where nothing was drawn.
std::string with_error(double v, double se) {
    if (!(v > 0)) return "0";
    if (!(se > 0)) return fmt::format("{:.4g}", v);
    const int digits = static_cast<int>(std::floor(math::log10(se)));
    if (digits > 0 || digits < -6) return fmt::format("{:.3g} +- {:.1g}", v, se);
    return fmt::format("{:.{}f} +- {:.{}f}", v, -digits, se, -digits);
}

/// The mean over the rows between two angles.
std::string ring_told(const nlohmann::ordered_json& rows, double from, double to) {
    double sum = 0, square = 0, whole = 0;
    for (const auto& row : rows) {
        const double low = row[0].get<double>(), high = row[1].get<double>();
        if (low < from || high > to) continue;
        const double angle = math::cos(low * pi / 180) - math::cos(high * pi / 180);
        sum += row[2].get<double>() * angle, square += sqr(row[3].get<double>() * angle);
        whole += angle;
    }
    if (to > 90) whole = 1;  // rows end where the draws do
    return whole > 0 ? with_error(sum / whole, std::sqrt(square) / whole) : "-";
}

std::string line_of(const Verdict& v, const std::string& name) {
    const nlohmann::ordered_json &rows = v.evidence["implied_rings"]["rows"], &peak = v.evidence["implied_peak"];
    std::string out = fmt::format("{:<20}", name);
    for (std::size_t k = 0; k < rings; ++k) out += fmt::format(" {:<15}", ring_told(rows, edges[k], edges[k + 1]));
    return out + " " + with_error(peak["pdf"].get<double>(), peak["standard_error"].get<double>()) + "\n";
}

}  // namespace

std::string implied_told(const Judgement& j) {
    std::vector<const Verdict*> all;
    bool one_arm = true;
    for (const Verdict& v : j.verdicts)
        if (v.evidence.contains("implied_rings")) {
            all.push_back(&v);
            one_arm = one_arm && v.arm == all[0]->arm;
        }
    if (all.empty()) return "";
    std::string out = fmt::format("{:<20}", "degrees from n");
    for (std::size_t k = 0; k < rings; ++k)
        out += fmt::format(" {:<15}", fmt::format("{:g} to {:g}", edges[k], edges[k + 1]));
    out += " highest\n";
    for (std::size_t i = 0; i < std::min(all.size(), most_lines); ++i)
        out += line_of(*all[i], one_arm ? all[i]->trial : all[i]->arm + " " + all[i]->trial);
    if (all.size() > most_lines) out += fmt::format("and {} more\n", all.size() - most_lines);
    return "The density that the draws imply, there being no pdf(w): 1/sr, the mean over each ring and one standard "
           "error.\n" +
        out + "Finer in the JSON: implied_rings, implied_bins.";
}

std::string not_looked_at_told(const Judgement& j) {
    if (j.state == State::error) return "";
    std::vector<std::string> all;
    for (const Verdict& v : j.verdicts) {
        const auto at = v.evidence.find("not_looked_at");
        if (at == v.evidence.end()) continue;
        const std::string what = at->get<std::string>();
        if (std::find(all.begin(), all.end(), what) == all.end()) all.push_back(what);
    }
    return all.empty() ? "" : fmt::format("Not looked at: {}.", fmt::join(all, "; "));
}

}  // namespace crescent::inline judgements
