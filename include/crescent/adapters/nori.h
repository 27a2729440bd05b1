// Checks a class with Nori's interface: crescent::check_sampler("mine", crescent::adapters::Nori(bsdf)).
//
//   Color3f sample(BSDFQueryRecord& r, const Point2f& u) const   writes r.wo, gives f cos / pdf; 0: nothing drawn
//   Color3f eval(const BSDFQueryRecord& r) const                 f, 1/sr, without the cosine
//   float pdf(const BSDFQueryRecord& r) const                    1/sr
//
// Nori's wi is the given direction and its wo the drawn one. A record is made of wi, or of wi, wo and a measure, whose
// values are 1 for solid angle and 2 for discrete. Colours are indexed; channels are averaged. Nothing of Nori is
// included: types follow from the class.
#pragma once

#include "crescent/adapters/pbrt.h"

namespace crescent::adapters {

template <class Bsdf> class Nori {
    using Parameters = typename user::Signature<decltype(&Bsdf::sample)>::Parameters;
    using Record = std::remove_cvref_t<std::tuple_element_t<0, Parameters>>;
    using Point = std::remove_cvref_t<std::tuple_element_t<1, Parameters>>;
    using Vector = std::remove_cvref_t<decltype(std::declval<Record>().wo)>;
    using Measure = std::remove_cvref_t<decltype(std::declval<Record>().measure)>;
    using Direction = std::array<double, 3>;

public:
    explicit Nori(Bsdf bsdf, Traits known = {}) : bsdf_(std::move(bsdf)), known_(known) {}
    Traits traits() const { return known_; }

    std::optional<Drawn> sample(Direction wo, std::array<double, 2> u) const {
        Record r(vector(wo));
        const double weight = mean(bsdf_.sample(r, Point(float(u[0]), float(u[1]))));
        if (!(weight > 0)) return {};
        const bool delta = static_cast<int>(r.measure) == 2;
        return Drawn{{r.wo[0], r.wo[1], r.wo[2]}, delta ? 1.0 : static_cast<double>(bsdf_.pdf(r)), weight, delta};
    }
    double pdf(Direction wo, Direction wi) const { return bsdf_.pdf(record(wo, wi)); }
    double f(Direction wo, Direction wi) const { return mean(bsdf_.eval(record(wo, wi))); }

private:
    Bsdf bsdf_;
    Traits known_;
    static Vector vector(Direction w) { return Vector(float(w[0]), float(w[1]), float(w[2])); }
    static Record record(Direction wo, Direction wi) { return Record(vector(wo), vector(wi), static_cast<Measure>(1)); }
    template <class Color> static double mean(const Color& c) {
        return (static_cast<double>(c[0]) + static_cast<double>(c[1]) + static_cast<double>(c[2])) / 3;
    }
};

}  // namespace crescent::adapters
