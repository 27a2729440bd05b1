// All fans (fan.h) from a surface point that meet a light, each with the parts of its line that no body hides found
// exactly; and the azimuths between which what they add up to is smooth. Radians, double precision.
#pragma once

#include <vector>

#include "reference/disk_point.h"
#include "reference/disk_quadrature.h"
#include "reference/fan.h"
#include "reference/lobe_along.h"
#include "scene/azimuth.h"

namespace crescent::inline reference {

/// What fans add up to: both parts, and the error of the lobe's rule along them.
struct FanSum {
    double diffuse = 0, lobe = 0, inner = 0;
    friend FanSum operator+(FanSum a, FanSum b) { return {a.diffuse + b.diffuse, a.lobe + b.lobe, a.inner + b.inner}; }
    friend FanSum operator-(FanSum a, FanSum b) { return {a.diffuse - b.diffuse, a.lobe - b.lobe, a.inner - b.inner}; }
    friend FanSum operator*(double k, FanSum a) { return {k * a.diffuse, k * a.lobe, k * a.inner}; }
};

/// How many parts of a fan are open, and which of their ends are the light's: what changes where a shadow's edge meets
/// the light's.
using FanEdges = unsigned;

/// Where panels must end; `root`: a round body begins or ends there, and its shadow opens like a root.
struct FanCut {
    double tau;
    bool root;
};

/// By a parameter tau in which the fans' integral is smooth where the light is a disk and open: the azimuth itself
/// where the axis meets it; else middle + half sin(tau), as chords grow from a tangent like a root. For one thread.
class AllFans {
public:
    /// About the lobe's axis, or the light's middle; `at_horizon`: part of the light may lie under the surface's
    /// horizon. All of it must outlive this.
    AllFans(const DiskPoint& point, const Figure& light, const std::vector<const Blocker*>& bodies, bool about_lobe,
        bool at_horizon);

    /// In order, from the first fan to the last.
    std::vector<FanCut> cuts() const;
    /// The bodies that fans between two tau may meet: the next calls look at no others.
    void look_between(double lo, double hi);
    /// One fan, times what turns d tau into an azimuth.
    FanSum operator()(double tau);
    /// Of the fan that was integrated last, and of any.
    FanEdges edges() const { return edges_; }
    FanEdges edges_at(double tau);

private:
    struct Body {
        const Blocker* blocker;
        Azimuths azimuths;
    };
    /// Calls f with each part of the fan's line that nothing hides, and notes the edges.
    template <class F> void each_open(const Fan& fan, F&& f);
    double last() const { return light_.whole() ? pi : pi / 2; }  // tau runs from -last() to last()
    double azimuth_of(Vec3d d) const;
    double azimuth(double tau) const;
    void cut(double phi, bool root, std::vector<FanCut>& at) const;
    void add_cuts(const Body& body, std::vector<FanCut>& at) const;

    const DiskPoint& point_;
    const Figure& figure_;
    Frame<double> about_;
    LobeShape shape_;
    bool about_lobe_, at_horizon_;
    Azimuths light_;
    std::vector<Body> bodies_;
    std::vector<const Blocker*> near_;
    std::vector<Interval> hidden_;
    FanEdges edges_ = 1;
};

}  // namespace crescent::inline reference
