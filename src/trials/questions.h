// What a sampler is asked at one w_o, and what may still be asked: pdf and f in batches, within a budget.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cubature/cubature.h"
#include "subjects/subject.h"
#include "trials/settings.h"

namespace crescent::inline trials {

/// The first of the layers of which a trial under way is made; each uses those before it: Questions, Draws, Pilots,
/// Integrals, Densities, TrialContext.
class Questions {
public:
    /// `index` tells this trial's random numbers from those of others. The trial outlives it.
    Questions(const Trial& trial, const TestSettings& settings, std::uint32_t index);

    const Trial& trial;
    const TestSettings& settings;
    const JudgedSampler& subject;
    const Traits traits;

    /// So many of the wanted questions as a limited sampler may still be asked here, `keep` of them left for later;
    /// 2000 at least.
    std::size_t affordable(std::size_t wanted, std::size_t keep = 0) const;
    /// Questions that may still be asked at this w_o.
    std::size_t left() const;
    /// A limited sampler is asked no more than its answers are worth: integrals are known to a fifth of what the tests
    /// grant.
    bool thrifty() const { return subject.limited() && !settings.full; }
    double tolerance() const { return thrifty() ? 2e-5 : 5e-6; }
    /// The error of a mass that is looked at no further.
    double enough() const { return thrifty() ? 8e-5 : 5e-5; }

    /// 1/sr, of one technique; exact: not what the sampler's own arithmetic makes of it.
    std::vector<double> pdf(int technique, std::span<const Vec3d> wi, bool exact = false) const;
    /// Sum over techniques.
    std::vector<double> any_pdf(std::span<const Vec3d> wi) const;
    /// The mean of several answers beside each direction, where p is a random estimate.
    std::vector<double> mean_pdf(std::span<const Vec3d> wi, int answers) const;
    /// 1/sr, luminance; truth: of the BRDF itself, not as the sampler says it.
    std::vector<double> f(std::span<const Vec3d> wi, bool truth = false) const;
    std::vector<Vec3d> f_channels(std::span<const Vec3d> wi) const;
    std::vector<double> f_of_channel(std::span<const Vec3d> wi, int channel) const;
    /// Of the keys of what is measured of each technique: "_1", "_2"; "" where there is one alone.
    std::string suffix(int technique) const {
        return subject.techniques() > 1 ? "_" + std::to_string(technique + 1) : "";
    }

protected:
    std::uint32_t index_;
    /// Questions for the verdicts after the density and its confirmation.
    std::size_t for_later() const;
    /// Sixteen more answers beside each direction at which f, `value`, is not 0 and p came out as 0.
    void ask_again_at_zeros(std::span<const Vec3d> wi, std::span<const double> value, std::span<double> p) const;

private:
    std::uint64_t asked_before_ = 0;  // when this trial began
};

/// By cubature, or by points at random where the integrand is made of estimates.
Integral integral_of(std::vector<Rect> cells, int bins, const Batch& g, const Effort& effort, bool estimates,
    const SamplesPerBin* samples = nullptr);

}  // namespace crescent::inline trials
