// Correct samplers at random parameters, for measuring false positives of the check. Each is written in double from its
// source, with separate sample and pdf, as users write theirs; `crescent_calibration false-alarms` checks them.
#pragma once

#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "check/sources/check_case.h"

namespace crescent {

/// sample, pdf and f of one sampler; f is empty if no BRDF belongs to the density.
struct SyntheticSampler {
    std::string family, parameters;
    std::function<Draw(Vec3d wo, const PrimarySample& u)> sample;
    std::function<double(Vec3d wo, Vec3d wi)> pdf, f;
    Traits traits{};
    std::function<Vec3d(Vec3d wo, Vec3d wi)> f_channels{};  // in place of f, for three channels
};

/// Parameters drawn at random: a pure function of the seed, the same on every machine.
class Rng {
public:
    explicit Rng(std::uint64_t seed) : bits_(seed) {}
    double uniform(double low, double high) {
        return low + (high - low) * (static_cast<double>(bits_() >> 11) * 0x1p-53);
    }
    /// Uniform in the logarithm.
    double log(double low, double high);
    int whole(int low, int high) {
        return low + static_cast<int>(bits_() % static_cast<std::uint64_t>(high - low + 1));
    }
    Vec3d direction(double least_cos, double most_cos);

private:
    std::mt19937_64 bits_;
};

/// Returns the direction at `cos` from an axis, rotated by `turns` about it.
Vec3d about(Vec3d axis, double cos, double turns);
/// Returns the azimuth of w in turns, [0, 1).
double turns_of(Vec3d w);

using SamplerFamily = SyntheticSampler (*)(Rng&);
std::vector<SamplerFamily> microfacet_families();  // anisotropic GGX, Beckmann and Ward, in double and in float
std::vector<SamplerFamily> lobe_families();        // cosine powers, cones, bands, lights, phase functions, mixtures
std::vector<SamplerFamily> table_families();       // cells, texels and bilinear tables

/// Anisotropic GGX with visible normals at given roughness.
SyntheticSampler ggx_visible_at(double alpha_x, double alpha_y);

/// Returns a synthetic sampler as an adapter.
std::shared_ptr<const SamplerAdapter> make_adapter(SyntheticSampler recipe);

/// Returns sampler `index` of the study: the families alternate, and parameters follow from seed and index.
SyntheticSampler right_sampler(std::uint64_t index, std::uint32_t seed);
/// The same at its w_o: from the normal to 89 deg.
CheckCase correct_case(std::uint64_t index, std::uint32_t seed);

}  // namespace crescent
