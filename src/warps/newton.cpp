// Derivatives are one-sided differences, towards the middle of the square; the step is the least-squares one of a
// direction, three numbers, by two.
#include "warps/newton.h"

#include <algorithm>
#include <cmath>

namespace crescent::inline warps {

std::vector<NewtonMove> newton_moves(const TrialContext& work, int technique, std::span<const Numbers> from,
    std::span<const Vec3d> to, const NewtonStep& step) {
    const double h = step.difference;
    std::vector<Numbers> u;
    for (const Numbers& at : from) {
        u.insert(u.end(), 3, at);
        u[u.size() - 2].x += at.x < 0.5 ? h : -h, u[u.size() - 1].y += at.y < 0.5 ? h : -h;
    }
    std::vector<Draw> w(u.size());
    work.subject.sample(technique, work.trial.wo, u, w);
    std::vector<NewtonMove> out(from.size());
    for (std::size_t i = 0; i < from.size(); ++i) {
        const Vec3d x = (w[3 * i + 1].wi - w[3 * i].wi) * (1 / (u[3 * i + 1].x - from[i].x)),
                    y = (w[3 * i + 2].wi - w[3 * i].wi) * (1 / (u[3 * i + 2].y - from[i].y)), r = to[i] - w[3 * i].wi;
        const double xx = dot(x, x), xy = dot(x, y), yy = dot(y, y), det = xx * yy - xy * xy;
        const double due = step.near * (std::sqrt(xx) + std::sqrt(yy)) + 16 * work.direction_resolution();
        out[i].arrived = w[3 * i].pdf > 0 && length(r) <= due;
        out[i].moves = !out[i].arrived && det > 1e-12 * xx * yy;
        if (!out[i].moves) continue;
        const double dx = (yy * dot(x, r) - xy * dot(y, r)) / det, dy = (xx * dot(y, r) - xy * dot(x, r)) / det;
        const double shorter = step.longest / std::max({step.longest, std::fabs(dx), std::fabs(dy)});
        out[i].dx = shorter * dx, out[i].dy = shorter * dy;
    }
    return out;
}

}  // namespace crescent::inline warps
