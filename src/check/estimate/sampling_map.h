// The map of a technique from random numbers u to a direction w, probed at chosen u.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "check/estimate/source.h"

namespace crescent::check {

/// u with number k moved by this distance, inwards from the nearer end of [0, 1).
inline PrimarySample moved(PrimarySample u, int k, double distance) {
    u[k] += u[k] < 0.5 ? distance : -distance;
    return u;
}
inline std::vector<PrimarySample> moved(std::vector<PrimarySample> u, int k, double distance) {
    for (PrimarySample& x : u) x = moved(x, k, distance);
    return u;
}

constexpr double no_chord = 4;  // longer than any chord
/// The chord between the directions of two draws; 0 if neither has one, `no_chord` if one has.
inline double chord(const Draw& a, const Draw& b) {
    if (has_direction(a) != has_direction(b)) return no_chord;
    return has_direction(a) ? length(b.wi - a.wi) : 0;
}

/// A step of the direction in single precision: a cosine next to 1 takes few values, so that draws lie on rings about
/// an axis. The next change of w(u), for a draw that does not change while one of its numbers moves by an ulp.
struct LocalStep {
    double jump = 0;  // an angle; 0 if there is none, or if single precision does not explain it
    Vec3d next{};
};
/// w: the draws at u. Returns steps for all of them, or for the first ones only.
std::vector<LocalStep> local_steps(Source& source, const std::vector<PrimarySample>& u, const std::vector<Vec3d>& w);

}  // namespace crescent::check
