// Draws are gathered by direction and q, to 1e-4. A part's share of the draws is tested by chi-square against q; its
// light is q times the weight times the radiance along it.
#include "trials/delta.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "stats/p_values.h"

namespace crescent::inline trials {

namespace {

constexpr std::size_t most_parts = 16;

bool close(double a, double b) { return std::fabs(a - b) <= 1e-4 * std::max(std::fabs(a), std::fabs(b)); }
bool close(Vec3d a, Vec3d b) { return close(a.x, b.x) && close(a.y, b.y) && close(a.z, b.z); }

Vec3d weight_of(const Questions& work, const Draw& d) {
    const double w = d.weight.value_or(0);
    return work.traits.channels == 3 ? d.weights : Vec3d{w, w, w};
}

}  // namespace

double DeltaParts::q() const {
    double sum = 0;
    for (const DeltaPart& p : parts) sum += p.q;
    return sum;
}

Vec3d DeltaParts::energy(int side) const {
    Vec3d sum{};
    for (const DeltaPart& p : parts)
        if (side == 0 || (p.wi.z > 0) == (side > 0)) sum = sum + p.weight * p.q;
    return sum;
}

namespace {

/// The parts by direction and q, and by weight too where that is asked for.
DeltaParts parts_of(const Questions& work, const SampleBatch& b, bool by_weight) {
    DeltaParts out;
    out.of = b.draws.size();
    for (const Draw& d : b.draws) {
        if (!(d.delta > 0)) continue;
        const Vec3d w = weight_of(work, d);
        const auto same = [&](const DeltaPart& p) {
            return length(p.wi - d.wi) < 1e-4 && close(p.q, d.delta) && (!by_weight || close(p.weight, w));
        };
        const auto at = std::find_if(out.parts.begin(), out.parts.end(), same);
        if (at != out.parts.end()) {
            ++at->drawn;
            at->otherwise += !close(at->weight, w);
        } else if (out.parts.size() < most_parts) {
            out.parts.push_back({d.wi, d.delta, w, 1, 0});
        } else {
            out.scattered = true;
        }
    }
    return out;
}

/// Every part is drawn as often as q says, but for six standard deviations.
bool all_come_by_q(const DeltaParts& deltas) {
    const double n = static_cast<double>(deltas.of);
    return !deltas.scattered && std::all_of(deltas.parts.begin(), deltas.parts.end(), [n](const DeltaPart& p) {
        return std::fabs(static_cast<double>(p.drawn) - n * p.q) <= 6 * std::sqrt(n * p.q * (1 - p.q)) + 2;
    });
}

}  // namespace

/// One direction and one q with several weights are several parts where each comes as often as q says: along the
/// normal three indices refract three channels, chosen alike, to one direction.
DeltaParts delta_parts(const Questions& work, const SampleBatch& b) {
    DeltaParts out = parts_of(work, b, false);
    const bool uneven =
        std::any_of(out.parts.begin(), out.parts.end(), [](const DeltaPart& p) { return p.otherwise > 0; });
    if (!uneven) return out;
    DeltaParts apart = parts_of(work, b, true);
    return all_come_by_q(apart) ? apart : out;
}

double delta_share_p(const DeltaParts& deltas, const SampleBatch& b) {
    const double n = static_cast<double>(b.draws.size());
    double seen = 0, due = 0, statistic = 0, degrees = 0;
    const auto add = [&](double saw, double expected) {
        if (expected < 5) return;
        statistic += (saw - expected) * (saw - expected) / expected;
        ++degrees;
    };
    for (const DeltaPart& p : deltas.parts) {
        seen += static_cast<double>(p.drawn);
        due += n * p.q;
        add(static_cast<double>(p.drawn), n * p.q);
    }
    if (due > n * (1 + 1e-4)) return 0;  // more than certain
    add(n - seen, n - due);
    if (n - due < 5 && n - seen > 20) return 0;
    return chi_squared_p(statistic, degrees - 1);
}

std::string told(const DeltaParts& deltas) {
    if (deltas.parts.empty()) return "";
    std::string out = " Delta parts:";
    for (std::size_t i = 0; i < deltas.parts.size(); ++i) {
        const DeltaPart& p = deltas.parts[i];
        out += fmt::format("{} q = {:.4g} towards ({:.4g}, {:.4g}, {:.4g}), weight {:.4g}, drawn {:.4g} of the time",
            i ? ";" : "", p.q, p.wi.x, p.wi.y, p.wi.z, luminance(p.weight),
            static_cast<double>(p.drawn) / static_cast<double>(deltas.of));
    }
    return out + ".";
}

nlohmann::ordered_json evidence_of(const DeltaParts& deltas) {
    nlohmann::ordered_json out = nlohmann::ordered_json::array();
    for (const DeltaPart& p : deltas.parts)
        out.push_back({{"wi", {p.wi.x, p.wi.y, p.wi.z}}, {"q", p.q}, {"weight", {p.weight.x, p.weight.y, p.weight.z}},
            {"share_of_draws", static_cast<double>(p.drawn) / static_cast<double>(deltas.of)}});
    return out;
}

double delta_light(const Draws& work, bool even) {
    double sum = 0;
    for (const DeltaPart& p : delta_parts(work, work.first(0)).parts)
        if (work.counts(p.wi)) sum += p.q * luminance(p.weight) * (even ? 1 : work.light(p.wi));
    return sum;
}

Integral due_mean(const Integrals& work, bool even) {
    Integral out = work.incoming(Integrals::Where::reached, even);
    out.value += delta_light(work, even);
    return out;
}

}  // namespace crescent::inline trials
