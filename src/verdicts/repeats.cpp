// Draws beside one another: the same u asked again, the same direction met twice, the same delta part with another
// weight.
#include "verdicts/repeats.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>

#include "subjects/numbers.h"
#include "trials/delta.h"
#include "trials/trial_context.h"

namespace crescent::inline verdicts {

namespace {

/// Draws that are equal to one that stands before them.
struct Met {
    std::size_t count = 0;
    std::size_t most = 0, first = 0;  // of one direction, and which draw was the first to go there
};

Met met_before(const std::vector<std::array<double, 3>>& all) {
    const std::size_t places = std::bit_ceil(2 * all.size());
    std::vector<std::uint32_t> at(places, 0), times(places, 0);  // at: one more than the index; 0: free
    Met out;
    for (std::size_t i = 0; i < all.size(); ++i) {
        std::uint64_t key = 0;
        for (double v : all[i]) {  // -0 is 0
            key = (key ^ std::bit_cast<std::uint64_t>(v + 0.0)) * 0x9e3779b97f4a7c15u;
            key ^= key >> 32;
        }
        for (std::size_t k = key & (places - 1);; k = (k + 1) & (places - 1)) {
            if (at[k] == 0) {
                at[k] = static_cast<std::uint32_t>(i + 1);
                break;
            }
            if (all[at[k] - 1] == all[i]) {
                ++out.count;
                if (++times[k] > out.most) out.most = times[k], out.first = at[k] - 1;
                break;
            }
        }
    }
    return out;
}

}  // namespace

namespace {

/// The solid angle that may become one direction. In single precision a half vector's cosine rounds to 1 where its
/// angle is up to some 4e-4 and the sine by sqrt(1 - cos^2) to 0; the direction turns by twice that angle.
double solid_angle_of_one(const TrialContext& work) {
    constexpr double single = 0x1p-24, roundings = 4;
    const bool by_cosine = work.direction_resolution() >= single && work.direction_resolution() < 4 * single;
    return 20 * 16 * sqr(work.direction_resolution()) + (by_cosine ? 2 * pi * 4 * roundings * single : 0);
}

/// Draws with the very direction of another, where that is no chance: rounding brings together as many pairs as N^2 / 2
/// times the mean of p times the solid angle of a rounding, and N p times that about one direction.
struct RepeatedDirections {
    std::size_t grid = 0, atom = 0;  // of many directions; of one: 0 where none are worth telling
    Vec3d at{};                      // that one
};

RepeatedDirections repeated_directions(const TrialContext& work, const SampleBatch& b) {
    std::vector<std::array<double, 3>> all;
    std::vector<double> density;
    double p = 0;
    for (std::size_t i = 0; i < b.draws.size(); ++i) {
        const Draw& d = b.draws[i];
        if (!(d.pdf > 0)) continue;
        all.push_back({d.wi.x, d.wi.y, d.wi.z});
        density.push_back(b.pdf[i]);
        p += b.pdf[i];
    }
    RepeatedDirections out;
    if (all.empty() || !work.traits.has_pdf || !work.subject.draws_at_will()) return out;
    const double n = static_cast<double>(all.size()), rounding = 16 * sqr(work.direction_resolution());
    const Met met = met_before(all);
    const auto of_one = static_cast<double>(met.most), all_met = static_cast<double>(met.count),
               may_be_one = n * density[met.first] * solid_angle_of_one(work);
    constexpr double least = 2e-4;  // of the draws: a few steps of u that lead to one place are no atom
    if (of_one > std::max(8.0, least * n) + may_be_one && 2 * met.most > met.count) {
        const auto& [x, y, z] = all[met.first];
        out.atom = met.most + 1, out.at = {x, y, z};
    } else if (all_met - std::min(of_one, may_be_one) > std::max(64.0, 20 * 0.5 * n * p * rounding + 1e-3 * n)) {
        out.grid = met.count;
    }
    return out;
}

/// Loops over packs treat the last few of a block by other instructions: last bits may differ, and what hangs on them.
/// Estimates may hang on these by a hash of the directions; `estimates`: the densities are not compared.
bool same_answer(const Draw& x, const Draw& y, bool estimates) {
    constexpr double apart = 0x1p-20, relative = 1e-3;
    const auto close = [](double a, double b) {
        return a == b || std::fabs(a - b) <= relative * std::max(std::fabs(a), std::fabs(b));
    };
    if (!estimates && (!close(x.delta, y.delta) || !close(x.pdf, y.pdf))) return false;
    const bool nothing = !(x.pdf > 0) && x.delta == 0;
    return nothing || length(x.wi - y.wi) <= apart;
}

/// Answers to the same u that differ.
struct Repeated {
    std::size_t tried = 0, other = 0;
    Numbers u{};
    Vec3d first{}, again{};
};

/// The same u in the opposite order: answers that differ by more than rounding come from something else than wo and u.
Repeated ask_again(const TrialContext& work, int technique) {
    Repeated out;
    if (!work.subject.draws_at_will() || work.traits.own_random) return out;
    const SampleBatch& b = work.first(technique);
    out.tried = std::min<std::size_t>(b.u.size(), 256);
    std::vector<Numbers> u(b.u.begin(), b.u.begin() + static_cast<std::ptrdiff_t>(out.tried));
    std::reverse(u.begin(), u.end());
    std::vector<Draw> again(out.tried);
    work.subject.sample(technique, work.trial.wo, u, again);
    for (std::size_t i = 0; i < out.tried; ++i) {
        const Draw &x = b.draws[i], &y = again[out.tried - 1 - i];
        if (same_answer(x, y, work.scatter().any()) || out.other++ > 0) continue;
        out.u = b.u[i];
        out.first = x.wi;
        out.again = y.wi;
    }
    return out;
}

}  // namespace

bool answers_otherwise(const TrialContext& work, int technique, Verdict& v) {
    const Repeated r = ask_again(work, technique);
    if (r.other == 0) return false;
    v.state = State::wrong;
    v.evidence["asked_again"] = r.tried;
    v.evidence["answered_otherwise"] = r.other;
    v.say = fmt::format(
        "The same u gives another answer when it is asked again, {} of {} times; at {} first ({:.6g}, {:.6g}, {:.6g}), "
        "then ({:.6g}, {:.6g}, {:.6g}). The sampler is no function of w_o and u: it keeps a state, draws random "
        "numbers of its own (a sampler that says so, random=own, is judged without what needs u), or answers out of "
        "turn.",
        r.other, r.tried, told(r.u, work.traits.numbers), r.first.x, r.first.y, r.first.z, r.again.x, r.again.y,
        r.again.z);
    return true;
}

bool repeats_directions(const TrialContext& work, const SampleBatch& b, Verdict& v) {
    const RepeatedDirections r = repeated_directions(work, b);
    if (r.atom + r.grid == 0) return false;
    v.state = State::wrong;
    v.evidence["repeated_directions"] = r.atom + r.grid;
    v.say = r.atom > 0
        ? fmt::format(
              "{} of {} draws go to the very direction ({:.6g}, {:.6g}, {:.6g}): a part of what is drawn has no "
              "density, and p says nothing of it.",
              r.atom, b.draws.size(), r.at.x, r.at.y, r.at.z)
        : fmt::format(
              "{} of {} draws have the very direction of another draw: points or lines are drawn, and p "
              "is a density of solid angle.",
              r.grid, b.draws.size());
    return true;
}

bool has_uneven_deltas(const TrialContext& work, const SampleBatch& b, Verdict& v) {
    std::size_t uneven = 0;
    for (const DeltaPart& p : delta_parts(work, b).parts) uneven += p.otherwise;
    if (uneven == 0) return false;
    v.state = State::wrong;
    v.evidence["uneven_deltas"] = uneven;
    v.say = fmt::format("{} draws of a delta part come with another weight than the first of that part.", uneven);
    return true;
}

}  // namespace crescent::inline verdicts
