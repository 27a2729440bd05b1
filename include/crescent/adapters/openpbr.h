// Checks functions with the interface of Adobe's openpbr-bsdf:
//
//   check_sampler("mine", crescent::adapters::OpenPbr<vec3>([&](vec3 wo) { return openpbr_prepare(inputs, ..., wo);
//   }));
//
//   openpbr_sample(prepared, rand, wi&, weight&, pdf&, type&)   weight: f |cos| / pdf; pdf 0: nothing drawn
//   openpbr_eval(prepared, wi)                                  f |cos|
//   openpbr_pdf(prepared, wi)                                   1/sr
//   openpbr_get_sum_of_diffuse_specular(weight)                 a colour
//
// They are found by the type that `prepare` returns. Its frame is the default one: n = +z. Nothing of OpenPBR is
// included.
#pragma once

#include <cstdint>

#include "crescent/adapters/pbrt.h"

namespace crescent::adapters {

/// A draw of three channels.
struct ColouredDraw {
    std::array<double, 3> wi{};
    double pdf = 0;
    std::array<double, 3> weight{};
};

template <class Vec3, class Prepare> class OpenPbrSampler {
    using Prepared = std::invoke_result_t<const Prepare&, Vec3>;
    using Direction = std::array<double, 3>;

public:
    explicit OpenPbrSampler(Prepare prepare, Traits known = {}) : prepare_(std::move(prepare)), known_(known) {}
    Traits traits() const { return known_; }

    std::optional<ColouredDraw> sample(Direction wo, std::array<double, 3> u) const {
        const Prepared at = prepare_(vector(wo));
        Vec3 wi{};
        decltype(openpbr_eval(at, wi)) weight{};
        float pdf = 0;
        std::uint32_t type = 0;
        openpbr_sample(at, vector(u), wi, weight, pdf, type);
        if (!(pdf > 0)) return {};
        return ColouredDraw{{wi.x, wi.y, wi.z}, pdf, colour(weight)};
    }
    double pdf(Direction wo, Direction wi) const { return openpbr_pdf(prepare_(vector(wo)), vector(wi)); }
    Direction f(Direction wo, Direction wi) const {
        Direction out = colour(openpbr_eval(prepare_(vector(wo)), vector(wi)));
        for (double& channel : out) channel = wi[2] != 0 ? channel / std::fabs(wi[2]) : 0;
        return out;
    }

private:
    Prepare prepare_;
    Traits known_;
    static Vec3 vector(Direction w) { return Vec3{float(w[0]), float(w[1]), float(w[2])}; }
    template <class Weight> static Direction colour(const Weight& weight) {
        const auto sum = openpbr_get_sum_of_diffuse_specular(weight);
        return {sum.x, sum.y, sum.z};
    }
};

template <class Vec3, class Prepare> OpenPbrSampler<Vec3, Prepare> OpenPbr(Prepare prepare, Traits known = {}) {
    return OpenPbrSampler<Vec3, Prepare>(std::move(prepare), known);
}

}  // namespace crescent::adapters
