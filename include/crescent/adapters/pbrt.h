// Checks a class with pbrt-v4's interface: crescent::check_sampler("mine", crescent::adapters::Pbrt(bxdf)).
//
//   f(wo, wi, mode)                -> a spectrum, 1/sr, without the cosine
//   Sample_f(wo, uc, u, mode, ...) -> an optional of something with .f, .wi, .pdf, .flags or IsSpecular()
//   PDF(wo, wi, mode, ...)         -> 1/sr
//
// Local frame, n = +z; Vector3f and Point2f are built from floats, a spectrum has Average() or is a number. What else
// is known goes into Traits, here and in the other adapters: Pbrt(glass, {.wo = Traits::Asked::both, .eta = ...}), or
// {.own_random = true} of a layered one. Nothing of pbrt is included: types follow from the class.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <tuple>

#include "check/user.h"

namespace crescent::adapters {

/// A draw, as every adapter returns it.
struct Drawn {
    std::array<double, 3> wi{};
    double pdf = 0;
    double weight = 0;  // f |cos| / pdf
    bool delta = false;
};

template <class Spectrum> double average_of(const Spectrum& f) {
    if constexpr (requires { f.Average(); }) return static_cast<double>(f.Average());
    else return static_cast<double>(f);
}

template <class BxDF> class Pbrt {
    using Parameters = typename user::Signature<decltype(&BxDF::Sample_f)>::Parameters;
    template <std::size_t i> using Parameter = std::remove_cvref_t<std::tuple_element_t<i, Parameters>>;
    using Vector = Parameter<0>;
    using Point = Parameter<2>;
    using Mode = Parameter<3>;
    using Direction = std::array<double, 3>;

public:
    explicit Pbrt(BxDF bxdf, Traits known = {}) : bxdf_(std::move(bxdf)), known_(known) {}
    Traits traits() const { return known_; }

    std::optional<Drawn> sample(Direction wo, double uc, std::array<double, 2> u) const {
        const auto s = sampled(vector(wo), static_cast<float>(uc), Point{float(u[0]), float(u[1])});
        if (!s) return {};
        const double cosine = std::fabs(static_cast<double>(s->wi.z));
        double pdf = static_cast<double>(s->pdf);
        const double weight = pdf > 0 ? average_of(s->f) * cosine / pdf : 0;
        if constexpr (requires { s->pdfIsProportional; })  // only f / pdf is valid; pdf alone is not a density
            if (s->pdfIsProportional && pdf > 0) pdf = this->pdf(wo, {s->wi.x, s->wi.y, s->wi.z});
        return Drawn{{s->wi.x, s->wi.y, s->wi.z}, pdf, weight, s->IsSpecular()};
    }
    double pdf(Direction wo, Direction wi) const {
        if constexpr (requires { bxdf_.PDF(vector(wo), vector(wi), Mode{}); })
            return bxdf_.PDF(vector(wo), vector(wi), Mode{});
        else return bxdf_.PDF(vector(wo), vector(wi), Mode{}, everything<Parameter<4>>);
    }
    double f(Direction wo, Direction wi) const { return average_of(bxdf_.f(vector(wo), vector(wi), Mode{})); }

private:
    BxDF bxdf_;
    Traits known_;
    /// Some classes have no default for the last parameter, the requested part: 1 reflection, 2 transmission.
    template <class Flags> static constexpr Flags everything = static_cast<Flags>(3);
    auto sampled(Vector wo, float uc, Point u) const {
        if constexpr (requires { bxdf_.Sample_f(wo, uc, u, Mode{}); }) return bxdf_.Sample_f(wo, uc, u, Mode{});
        else return bxdf_.Sample_f(wo, uc, u, Mode{}, everything<Parameter<4>>);
    }
    static Vector vector(Direction w) { return Vector{float(w[0]), float(w[1]), float(w[2])}; }
};

}  // namespace crescent::adapters
