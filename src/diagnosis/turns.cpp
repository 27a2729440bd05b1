// Frames that are taken for one another: what is drawn is pdf(w) of another w_o, another w_i or both.
#include <algorithm>
#include <cmath>

#include "diagnosis/diagnosis.h"
#include "trials/phase.h"
#include "trials/trial_context.h"
#include "warps/jacobian.h"

namespace crescent::inline diagnosis {

namespace {

constexpr double close_turn = 2e-3;  // relative
constexpr double most_points = 0.9;  // of all points

/// The frames that are taken for one another.
struct Turn {
    const char* name;
    Vec3d (*of)(Vec3d);
    bool of_media = false;   // of a phase function alone, where along an axis another turn is the same
    bool of_lights = false;  // where no n stands apart
};
constexpr Turn turns[] = {{"forward and back exchanged", [](Vec3d w) { return -w; }, true},
    {"x and y exchanged", [](Vec3d w) { return Vec3d{w.y, w.x, w.z}; }},
    {"the frame mirrored in x", [](Vec3d w) { return Vec3d{-w.x, w.y, w.z}; }},
    {"the frame mirrored in y", [](Vec3d w) { return Vec3d{w.x, -w.y, w.z}; }},
    {"the azimuth turned by 180 deg", [](Vec3d w) { return Vec3d{-w.x, -w.y, w.z}; }},
    {"the azimuth turned by 90 deg", [](Vec3d w) { return Vec3d{-w.y, w.x, w.z}; }},
    {"the azimuth turned by -90 deg", [](Vec3d w) { return Vec3d{w.y, -w.x, w.z}; }},
    {"above and below exchanged", [](Vec3d w) { return Vec3d{w.x, w.y, -w.z}; }},
    {"y and z exchanged", [](Vec3d w) { return Vec3d{w.x, w.z, w.y}; }, false, true},
    {"x and z exchanged", [](Vec3d w) { return Vec3d{w.z, w.y, w.x}; }, false, true},
    {"a turn by 90 deg about x", [](Vec3d w) { return Vec3d{w.x, -w.z, w.y}; }, false, true},
    {"a turn by -90 deg about x", [](Vec3d w) { return Vec3d{w.x, w.z, -w.y}; }, false, true},
    {"a turn by 90 deg about y", [](Vec3d w) { return Vec3d{w.z, w.y, -w.x}; }, false, true},
    {"a turn by -90 deg about y", [](Vec3d w) { return Vec3d{-w.z, w.y, w.x}; }, false, true},
    {"x, y, z taken for y, z, x", [](Vec3d w) { return Vec3d{w.y, w.z, w.x}; }, false, true},
    {"x, y, z taken for z, x, y", [](Vec3d w) { return Vec3d{w.z, w.x, w.y}; }, false, true}};

/// Below is there to be taken for above: w_o is answered for there, or w_i lies there.
bool can_be_turned(const TrialContext& work, const Turn& turn, int which) {
    if (turn.of_media && !is_phase_function(work)) return false;
    if (turn.of_lights) return work.traits.wo == Traits::Asked::none && which == 2;
    if (turn.of({0, 0, 1}).z > 0) return true;
    return (!(which & 1) || work.traits.wo == Traits::Asked::both) && (!(which & 2) || work.whole());
}

}  // namespace

std::optional<Diagnosis> turned(
    const TrialContext& work, int technique, std::span<const WarpPoint> points, std::span<const Ratio> as_it_is) {
    const std::size_t n = std::min<std::size_t>(points.size(), 256);
    if (n < 32 || mostly_one(as_it_is.first(n))) return {};
    const auto is_one = [](double off, double error) { return std::fabs(off - 1) <= close_turn + 2 * error; };
    std::size_t one = 0;  // as it is: a turn that leaves p alone explains none of the rest
    for (std::size_t i = 0; i < n; ++i) one += is_one(1 / as_it_is[i].value, points[i].error);
    if (2 * one >= n) return {};
    for (const Turn& turn : turns)
        for (int which = 1; which < 4; ++which) {
            if (!can_be_turned(work, turn, which)) continue;
            std::vector<Pair> at;
            for (std::size_t i = 0; i < n; ++i)
                at.push_back({which & 1 ? turn.of(work.trial.wo) : work.trial.wo,
                    which & 2 ? turn.of(points[i].wi) : points[i].wi});
            std::vector<double> p(n);
            work.subject.pdf(technique, at, p);
            std::size_t same = 0;
            for (std::size_t i = 0; i < n; ++i) same += is_one(p[i] * points[i].jacobian, points[i].error);
            if (static_cast<double>(same) < most_points * static_cast<double>(n)) continue;
            const char* of[] = {"", " for w_o", " for w_i", ""};
            const std::string name = std::string(turn.name) + of[which];
            return Diagnosis{name, 1, static_cast<double>(same) / static_cast<double>(n),
                "what is drawn is pdf(w) with " + name, {}};
        }
    return {};
}

}  // namespace crescent::inline diagnosis
