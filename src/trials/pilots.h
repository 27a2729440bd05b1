// Where the lobes of a trial stand, and where the rim of what is drawn runs: cubatures begin with finer cells there.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "trials/draws.h"

namespace crescent::inline trials {

/// The layer of a trial that says where to look.
class Pilots : public Draws {
public:
    using Draws::Draws;
    std::span<const Vec3d> pilot_directions() const { return pilot_directions_; }

protected:
    void find_pilot_directions();
    std::vector<Vec3d> pilot_directions_, support_boundary_;
    std::size_t drawn_pilots_ = 0;  // the first of the pilot directions
    std::optional<Vec3d> circle_;   // the axis of a rim that is a circle
    std::optional<double> pole_;    // 1 - cos of that rim, where p has a pole along it

private:
    void find_support_boundary(int technique);
    bool has_pole_at(const SphereMap& map, double height) const;
};

}  // namespace crescent::inline trials
