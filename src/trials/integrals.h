// What arrives at the surface of a trial: int f L |cos| over what counts, where p is (not) 0, and where no draw went.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>

#include "trials/pilots.h"

namespace crescent::inline trials {

/// Light in directions whose weight X = f L cos / p is larger than any that was drawn; see unmet.cpp.
struct Unmet {
    double largest = 0, mean = 0;  // of the drawn weights
    double mass = 0, error = 0;    // int f L cos there
    double chance = 0;             // int p there: of one draw to meet it
    double variance = 0;           // of the weights up to the largest, by quadrature
    bool heavy = false;            // it explains what the mean lacks, and so many draws need not have met it
};

/// The layer of a trial that integrates light.
class Integrals : public Pilots {
public:
    using Pilots::Pilots;
    /// int f L |cos| over what counts, or only where any_pdf is (not) positive; even: L = 1. bins: the upper and the
    /// lower half of the fill's part.
    enum class Where { everywhere, reached, lost };
    const Integral& incoming(Where where, bool even) const;
    /// int g L over what counts, g = f |cos| or what goes with it at each direction; even: L = 1.
    using OfLight = std::function<void(std::span<const Vec3d>, std::span<double>)>;
    Integral integrate_light(const OfLight& g, bool even) const;
    /// What the screening draws did not meet of the light; looked for once.
    const Unmet& unmet(bool even) const;
    /// int f |cos| of one channel over what counts.
    Integral albedo_of(int channel) const;

protected:
    void redraw(std::uint32_t seed);

private:
    mutable std::array<std::optional<Integral>, 6> incoming_;  // by Where and even
    mutable std::array<std::optional<Unmet>, 2> unmet_;        // by even
    Integral integrate_incoming(Where where, bool even, int channel = -1) const;
};

}  // namespace crescent::inline trials
