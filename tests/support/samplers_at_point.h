// The films of arms compared with a reference film, for tests. Each pixel is compared with the arm of least variance
// there, as measured by draws of a double-precision estimator, which meet every lobe and every area light: an arm that
// misses a peak has a large variance, although its own few samples may not show it.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "render/estimator.h"
#include "render/pixel.h"
#include "render/reference/reference.h"
#include "tests/support/oracle.h"

namespace crescent::test {

inline constexpr std::uint64_t samples = 8192;
inline constexpr int moment_draws = 250;
/// The relative error allowed for an arm in single precision: as much as check allows for the density of one.
inline constexpr double single_precision = 1e-4;

inline constexpr double infinite = std::numeric_limits<double>::infinity();

/// Each built-in sampler at a pixel, measured by draws of the oracle: int F^2 / p, and the variance of X; F = f L cos.
/// Samplers of two techniques are omitted, except mis-balance.
class ArmsAtPixel {
public:
    ArmsAtPixel(const Scene& scene, const Hit& hit, int i, int j, std::uint32_t seed)
        : pixel_(scene, i, j), oracle_(scene, hit, seed) {
        for (const SamplerInfo& arm : sampler_infos())
            if (arm.techniques == 1) arms_.emplace_back(arm.name);
        arms_.emplace_back("mis-balance");
        for (std::size_t k = 0; k < oracle_.techniques(); ++k)
            for (int n = 0; n < moment_draws; ++n) add(oracle_.draw(k));
    }
    /// Returns the sampler of the smallest second moment, and so of the smallest variance, because all have the same
    /// mean. Empty if each has directions that it never draws.
    std::string best() const {
        std::string out;
        double least = infinite;
        for (std::size_t k = 0; k < arms_.size(); ++k) {
            double moment = 0;
            for (const Direction& d : drawn_) moment += d.F > 0 ? sqr(d.F) / (d.p[k] + d.other[k]) * d.share : 0;
            if (moment < least) {
                least = moment;
                out = arms_[k];
            }
        }
        return out;
    }
    /// Returns the variance of one X of a sampler whose films have this mean and this share of samples below the
    /// horizon, where X is 0. Computed about its mean, direction by direction, because a difference of moments would be
    /// imprecise for few draws.
    double variance(const std::string& arm, double mean, double under) const {
        const auto k = static_cast<std::size_t>(std::ranges::find(arms_, arm) - arms_.begin());
        double second = 0;  // contribution of the second of two techniques
        for (const Direction& d : drawn_)
            if (d.other[k] > 0) second += d.F / (d.p[k] + d.other[k]) * d.other[k] * d.share;
        double out = sqr(mean) * under;
        for (const Direction& d : drawn_) {
            const double all = d.p[k] + d.other[k], x = all > 0 ? d.F / all : 0;
            out += (sqr(x - (mean - second)) * d.p[k] + sqr(x - second) * d.other[k]) * d.share;
        }
        return out;
    }

private:
    /// `other`: the density of the second technique, 0 if a sampler has one.
    struct Direction {
        double F, share;
        std::vector<double> p, other;
    };
    void add(const Oracle::Direction& drawn) {
        if (!(drawn.density > 0)) return;
        Direction out = {
            drawn.worth + oracle_.lambert_under_fill() * drawn.wi.z, 1 / (drawn.density * moment_draws), {}, {}};
        for (const std::string& arm : arms_) {
            out.p.push_back(pixel_.pdf(arm, drawn.wi));
            out.other.push_back(arm == "mis-balance" ? pixel_.pdf("light-area", drawn.wi) : 0);
        }
        drawn_.push_back(std::move(out));
    }
    OpenPixel pixel_;
    Oracle oracle_;
    std::vector<std::string> arms_;
    std::vector<Direction> drawn_;
};

/// The comparison of the pixels of a scene: those that a sampler knows to 2 %, and the deviating ones among them.
struct Compared {
    int known = 0, off = 0, pixels = 0;
    std::string describe;
};

class ArmsOf {
public:
    explicit ArmsOf(const Scene& scene) : scene_(scene) {}
    const Film& film(const std::string& arm) {
        const auto found = films_.find(arm);
        if (found != films_.end()) return found->second;
        ProgressMonitor monitor;
        return films_.emplace(arm, estimate_films(scene_, arm, {samples}, 29, "", monitor)[0]).first->second;
    }

private:
    const Scene& scene_;
    std::map<std::string, Film> films_;
};

inline Compared compare_scene(const Scene& scene, const ReferenceFilm& reference, std::uint32_t seed) {
    Compared out;
    ArmsOf arms(scene);
    for (int j = 0; j < reference.height; ++j)
        for (int i = 0; i < reference.width; ++i) {
            const auto hit = scene.primary(i, j);
            if (!hit) continue;
            ++out.pixels;
            const auto at = static_cast<std::size_t>(j * reference.width + i);
            const double y = static_cast<double>(reference.y[at]), stated = static_cast<double>(reference.error[at]);
            const ArmsAtPixel known(scene, *hit, i, j, 100 * seed + static_cast<std::uint32_t>(at));
            const std::string best = known.best();
            if (best.empty()) continue;
            const Film& film = arms.film(best);
            const double mean = static_cast<double>(film.y[at]), n = static_cast<double>(samples);
            const double variance =
                std::max(static_cast<double>(film.var[at]), known.variance(best, mean, film.horizon[at] / n) / n);
            if (std::sqrt(variance) > 0.02 * std::max(mean, y)) continue;
            ++out.known;
            const double allowed = stated + 5 * std::sqrt(variance) + single_precision * y;
            if (std::fabs(y - mean) <= allowed) continue;
            ++out.off;
            out.describe += fmt::format(" ({}, {}) {}: reference {:.5g} +- {:.2g}, arm {:.5g} +- {:.2g};", i, j, best,
                y, stated, mean, std::sqrt(variance));
        }
    return out;
}

}  // namespace crescent::test
