// Draws of delta parts: mirrors and smooth refractions, which have no density. Each comes with the probability q with
// which its part was chosen and with the weight f |cos| / q.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "trials/integrals.h"

namespace crescent::inline trials {

struct DeltaPart {
    Vec3d wi;
    double q = 0;                          // as the draws say
    Vec3d weight;                          // by channel; of one channel all alike
    std::size_t drawn = 0, otherwise = 0;  // draws of it, and those with another weight
};

struct DeltaParts {
    std::vector<DeltaPart> parts;
    bool scattered = false;  // more directions than a surface has delta parts
    std::size_t of = 0;      // draws in all
    double q() const;
    /// Sum of q w over parts above (+1) or below (-1) the surface; 0: both.
    Vec3d energy(int side) const;
};

/// What the draws of one batch say of the delta parts.
DeltaParts delta_parts(const Questions& work, const SampleBatch& b);
/// p-value of the shares with which the parts were drawn, against their q.
double delta_share_p(const DeltaParts& parts, const SampleBatch& b);
/// "Delta parts: 0.25 of the draws towards (0, 0, 1), each of weight 1"; "" where there are none.
std::string told(const DeltaParts& parts);
nlohmann::ordered_json evidence_of(const DeltaParts& parts);
/// What delta parts add to the mean of f L cos / p: sum of q w L, luminance.
double delta_light(const Draws& work, bool even);
/// What the mean of f L cos / p ought to be: the integral where p is not 0, and the delta parts.
Integral due_mean(const Integrals& work, bool even);

}  // namespace crescent::inline trials
