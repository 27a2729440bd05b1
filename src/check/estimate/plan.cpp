// The pilot draws shape the tree and have no other use, so that the choice of the tree causes no bias.
#include "check/estimate/plan.h"

#include <algorithm>
#include <cmath>

#include "check/constants.h"
#include "check/estimate/scatter.h"

namespace crescent::check {

double step_of(std::vector<double> v) {
    if (v.size() < 64) return 0;
    std::sort(v.begin(), v.end());
    for (std::size_t k = 0; k + 1 < v.size(); ++k) v[k] = v[k + 1] - v[k];
    v.pop_back();
    std::sort(v.begin(), v.end());
    const auto equal = static_cast<std::size_t>(std::upper_bound(v.begin(), v.end(), 0.0) - v.begin());
    const std::size_t n = v.size(), within = std::min(n - 1, 2 * equal + n / 16);
    if (equal < 3 || equal == n) return 0;
    return std::min(2 * v[within] * static_cast<double>(equal) / static_cast<double>(within), v[(equal + n) / 2]);
}

double step_of_directions(std::span<const Vec3d> directions) {
    std::vector<double> xyz[3];
    for (Vec3d w : directions) xyz[0].push_back(w.x), xyz[1].push_back(w.y), xyz[2].push_back(w.z);
    double step = 0;
    for (auto& v : xyz) step = std::max(step, step_of(std::move(v)));
    return angle_per_step * std::min(step, coarsest_step);
}

namespace {

struct Pilot {
    std::vector<DensityPoint> points;
    std::vector<Vec3d> directions;
    std::vector<PrimarySample> u;  // of the first of them
    std::array<double, 3> weight{};
    std::uint32_t of = 0;
};

Pilot draw_pilot(Source& source, const CheckBudget& budget, const StreamKey& key) {
    Pilot out;
    std::vector<PrimarySample> u;
    std::vector<Draw> draws;
    std::vector<Vec3d> w;
    std::vector<double> p;
    out.of = source.available(key, budget.pilot());
    for (std::uint32_t from = 0; from < out.of; from += batch_size) {
        const std::uint32_t n = std::min(batch_size, out.of - from);
        u.resize(n), draws.assign(n, {});
        source.draw(key, from, u, draws);
        w.clear();
        std::vector<const Draw*> of;
        for (const Draw& d : draws) {
            if (d.delta != 0 || !(d.pdf > 0) || !std::isfinite(d.wi.x + d.wi.y + d.wi.z) || !std::isfinite(d.pdf))
                continue;
            if (!(dot(d.wi, d.wi) > 0)) continue;
            w.push_back(d.wi), of.push_back(&d);
        }
        p.resize(w.size());
        source.density(w, p);
        for (std::size_t i = 0; i < w.size(); ++i) {
            if (!is_direction(*of[i], p[i])) continue;
            out.points.push_back({to_chart(w[i]), p[i]});
            out.directions.push_back(w[i]);
            if (out.u.size() < budget.of_steps()) out.u.push_back(u[static_cast<std::size_t>(of[i] - draws.data())]);
            if (!of[i]->weight) continue;
            const Vec3d x =
                source.channels() == 3 ? of[i]->weights : Vec3d{*of[i]->weight, *of[i]->weight, *of[i]->weight};
            for (int c = 0; c < 3; ++c)
                if (std::isfinite(channel_of(x, c)))
                    out.weight[static_cast<std::size_t>(c)] += channel_of(x, c) / out.of;
        }
    }
    return out;
}

Values change_per_step(Source& source, const Plan& plan, const Pilot& pilot, const std::vector<LocalStep>& steps) {
    std::vector<std::size_t> which;
    std::vector<Vec3d> next;
    for (std::size_t i = 0; i < steps.size(); ++i)
        if (steps[i].jump > 0) which.push_back(i), next.push_back(steps[i].next);
    std::vector<double> p(next.size());
    source.density(next, p);
    Values out{};
    for (std::size_t k = 0; k < which.size(); ++k) {
        if (!(p[k] > 0)) continue;
        const auto at = [&](Vec3d w, double density) {
            return plan.values(plan.tree.leaves()[plan.tree.find(to_chart(w))], w, density);
        };
        const std::size_t i = which[k];
        const Values here = at(pilot.directions[i], pilot.points[i].p), there = at(next[k], p[k]);
        for (std::size_t q = 0; q < integrands; ++q)
            out[q] += std::fabs(there[q] - here[q]) / static_cast<double>(steps.size());
    }
    return out;
}

}  // namespace

Plan make_plan(Source& source, const CheckBudget& budget, StreamKey key, std::vector<DensityPoint> hints) {
    key.purpose = Purpose::pilot;
    Pilot pilot = draw_pilot(source, budget, key);
    std::vector<double> log_p;
    for (const DensityPoint& e : pilot.points)
        if (e.p > 0) log_p.push_back(e.p);
    const auto drawn = static_cast<std::uint32_t>(pilot.points.size());
    Vec3d middle{};
    for (Vec3d w : pilot.directions) middle = middle + w * (1.0 / drawn);
    const double step = step_of_directions(pilot.directions);
    const std::vector<LocalStep> steps =
        local_steps(source, pilot.u, {pilot.directions.begin(), pilot.directions.begin() + std::ssize(pilot.u)});
    for (std::size_t i = 0; i < steps.size(); ++i) pilot.points[i].step = steps[i].jump;
    double median = 0;
    if (!log_p.empty()) {
        const auto at = log_p.begin() + static_cast<std::ptrdiff_t>(log_p.size() / 2);
        std::nth_element(log_p.begin(), at, log_p.end());
        median = math::log(*at);
    }
    key.purpose = Purpose::tree;
    Plan plan{Tree(source, pilot.points, pilot.of, std::move(hints), step, budget, key), step, median, middle,
        pilot.weight, {}, source.estimates || !source.has_density(), drawn, pilot.of};
    if (!plan.estimates) plan.per_step = change_per_step(source, plan, pilot, steps);
    return plan;
}

}  // namespace crescent::check
