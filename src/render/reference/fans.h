// A disk light's part of the reflected radiance in polar coordinates of directions about an axis. Each fan has its
// unoccluded parts found exactly; across the fans, adaptive Gauss-Kronrod runs between the azimuths where bodies begin
// and end. If the lobe is sharp, the axis is the lobe's, so that no rule can miss its peak; else it is the direction to
// the disk's centre.
#pragma once

#include <span>
#include <vector>

#include "math/functions.h"
#include "render/reference/disk_quadrature.h"
#include "render/reference/reference.h"
#include "scene/body.h"
#include "scene/scene_data.h"
#include "scene/shadow.h"

namespace crescent {

// ---- One fan of directions from a surface point: the half-plane that ends in an axis, and the line in which it cuts a
// light. Directions in it are cos(al) axis + sin(al) side, al in [0, pi]; double precision.

/// sin(al), cos(al), al.
struct Direction {
    double sin, cos, al;
};

struct Fan {
    Vec3d axis, side;
    Vec3d to0{}, step{};  // from the point to the start of the light, and from there to its end
    bool empty = true;

    Fan(const DiskPoint& point, const Figure& light, const Frame<double>& frame, const math::SinCos& azimuth);
    /// Returns the direction to the light's point at fraction v between its start and its end.
    Direction at(double v) const;
    /// Keeps the part that is above the surface's horizon; to.al < from.al if there is none.
    void rise_above(const DiskPoint& point, Direction& from, Direction& to) const;
    /// Returns the integral of cos(theta_i) sin(al) over a part that is above the horizon, in closed form.
    double lambert(const DiskPoint& point, const Direction& from, const Direction& to) const;
};

// ---- All fans from a surface point that meet a light, each with the exact unoccluded parts of its line, and the
// azimuths between which their sum is smooth. Radians, double precision.

/// The number of unoccluded parts of a fan, and which of their ends are the light's: this changes where a shadow's edge
/// meets the light's.
using FanEdges = unsigned;

/// Where panels must end; `root`: a round body begins or ends there, and its shadow opens like a root.
struct FanCut {
    double tau;
    bool root;
};

/// What is visible of the light in a fan, for any lobe.
struct OpenFan {
    Vec3d axis, side;    // like Fan, in the surface's frame
    double cos_azimuth;  // about the lobe's axis: from the plane of incidence
    double slope;        // d azimuth / d tau
    double diffuse = 0;  // Lambert's part without rho_d
    FanEdges edges = 1;
    std::size_t first_part = 0, parts = 0;  // in the list for all fans
};

/// By a parameter tau in which the fans' integral is smooth if the light is a disk and unoccluded: the azimuth itself
/// if the axis meets the disk; else middle + half sin(tau), because chords grow from a tangent like a root. For one
/// thread.
class AllFans {
public:
    /// About the lobe's axis or the light's middle; `at_horizon`: part of the light may be below the surface's horizon.
    /// All arguments must outlive this object.
    AllFans(const DiskPoint& point, const Figure& light, const std::vector<const Blocker*>& bodies, bool about_lobe,
        bool at_horizon);

    const Figure& light() const { return figure_; }
    std::size_t bodies() const { return bodies_.size(); }
    bool about_lobe() const { return about_lobe_; }
    /// Returns the cuts in order, from the first fan to the last.
    const std::vector<FanCut>& cuts() const { return cuts_; }
    /// Selects the bodies that fans between two tau may meet; the next calls test only these.
    void look_between(double lo, double hi);
    /// Returns one fan, valid until the next call.
    const OpenFan& operator()(double tau);
    FanEdges edges_at(double tau);
    /// Returns the unoccluded parts of a fan: al from and to.
    std::span<const Interval> parts(const OpenFan& fan) const { return {parts_.data() + fan.first_part, fan.parts}; }
    /// Restarts for another lobe; fans already computed are reused.
    void rewind() {
        fans_.rewind();
        edges_.rewind();
    }

private:
    struct Body {
        const Blocker* blocker;
        Azimuths azimuths;
    };
    /// Calls f with each unoccluded part of the fan's line.
    template <class F> FanEdges each_open(const Fan& fan, F&& f);
    OpenFan look_at(double tau);
    double last() const { return light_.whole() ? pi : pi / 2; }  // tau runs from -last() to last()
    double azimuth_of(Vec3d d) const;
    /// Returns the azimuth at tau, and d azimuth / d tau.
    struct Turn {
        double azimuth, slope;
    };
    Turn turn(double tau) const;
    void cut(double phi, bool root);
    void add_cuts(const Body& body);
    void add_all_cuts();

    const DiskPoint& point_;
    const Figure& figure_;
    Frame<double> frame_;
    bool about_lobe_, at_horizon_;
    Azimuths light_;
    std::vector<Body> bodies_;
    std::vector<const Blocker*> blockers_;
    std::vector<FanCut> cuts_;
    std::vector<Interval> hidden_, parts_;
    Replay<OpenFan> fans_;
    Replay<FanEdges> edges_;
};

/// Integrates at the point of the fans, with this or another exponent of its lobe.
DiskIntegral fan_by_fan(const DiskPoint& point, AllFans& fans);

}  // namespace crescent
