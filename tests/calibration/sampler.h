// A sampler of the calibration: sample, pdf and f as functions in single or double precision, and the families from
// which samplers with random parameters are made. Densities in 1/sr; f without the cosine, in 1/sr.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "tests/known_samplers/correct/right.h"

namespace crescent::calibration {

/// A direction and its density; pdf 0: no sample.
template <class F> struct Drawn {
    Vec3<F> wi;
    F pdf;
};

template <class F> struct Functions {
    std::function<Drawn<F>(Vec3<F> wo, const F* u)> sample;
    std::function<F(Vec3<F> wo, Vec3<F> wi)> pdf;
    std::function<F(Vec3<F> wo, Vec3<F> wi)> f{};  // empty: no BRDF
};

/// The whole sphere, or the half above the surface: the domain of uniform draws of a leak.
enum class Domain { sphere, hemisphere };
enum class Real { f32, f64 };

/// Faults inside a family, besides those that any sampler can have.
enum class Broken {
    none,
    lobe_pdf,          // the draw and pdf have the largest density of a single lobe
    equal_weights,     // lobes are drawn by their weights; pdf weights them equally
    no_weights,        // pdf is the sum of the lobes' densities without their weights
    transposed_table,  // rows and columns of the table are exchanged in pdf
    shifted_table,     // pdf reads the next column
    mirrored_table,    // pdf reads the columns in reverse
};

/// A sampler with the properties that the adapter and the faults need.
struct Sampler {
    std::string family, parameters;
    int numbers = 2;  // random numbers of a sample
    Traits::WoDomain wo = Traits::WoDomain::upper;
    Domain domain = Domain::sphere;
    std::optional<double> eta{};  // index below over above
    bool reciprocal = true;
    std::variant<Functions<double>, Functions<float>> functions;
    std::shared_ptr<const SamplerAdapter> given{};  // in place of the functions, for draws with a weight
    Real real() const { return functions.index() == 0 ? Real::f64 : Real::f32; }
};

/// One member of a family, with fixed parameters. `stretch` multiplies the family's mismatch parameter.
struct Member {
    std::string text;
    std::function<Functions<double>(double stretch, Broken)> in_double;
    std::function<Functions<float>(double stretch, Broken)> in_float;
    std::optional<double> eta{};
};

struct Family {
    std::string name;
    std::string parameter;  // multiplied by a mismatch; "" if there is none
    bool held_out = false;  // never used for tuning
    int numbers = 2;
    Traits::WoDomain wo = Traits::WoDomain::none;
    Domain domain = Domain::sphere;
    std::vector<Broken> breaks;
    bool halfway = false;  // drawn through a half vector, with the Jacobian 1 / (4 w_o.m)
    bool reciprocal = true;
    Member (*member)(Rng&) = nullptr;
};

/// The families, in a fixed order; those for tuning first.
const std::vector<Family>& families();
const Family& family_named(std::string_view name);

/// The right sampler of a member.
Sampler sampler_of(const Family& family, const Member& member, Real real, double stretch = 1, Broken broken = {});

/// The same functions with inputs, directions and densities rounded to single precision.
Functions<float> rounded(Functions<double> exact);

/// The adapter of a user's struct, through UserSampler, with the same number of random numbers, and f if there is one.
std::shared_ptr<const SamplerAdapter> make_adapter(const Sampler& sampler);

/// The declaration of a family's struct. `drawn` chooses the parameters, `stretched` multiplies the named one.
template <class T> Member member_of(Rng& rng) {
    const T chosen = T::drawn(rng);
    Member m;
    m.text = chosen.text();
    m.in_double = [chosen](double by, Broken b) { return chosen.stretched(by).template in<double>(b); };
    m.in_float = [chosen](double by, Broken b) { return chosen.stretched(by).template in<float>(b); };
    if constexpr (requires { chosen.eta; }) m.eta = chosen.eta;
    return m;
}
template <class T> Family family_of() {
    Family f;
    f.name = T::name;
    f.parameter = T::parameter;
    f.wo = T::wo;
    f.domain = T::domain;
    if constexpr (requires { T::numbers; }) f.numbers = T::numbers;
    if constexpr (requires { T::breaks; }) f.breaks.assign(std::begin(T::breaks), std::end(T::breaks));
    if constexpr (requires { T::halfway; }) f.halfway = T::halfway;
    if constexpr (requires { T::reciprocal; }) f.reciprocal = T::reciprocal;
    f.member = &member_of<T>;
    return f;
}

std::vector<Family> lobe_families();        // about fixed axes and about the mirror direction
std::vector<Family> phase_families();       // of media, about the direction of w_o
std::vector<Family> light_families();       // by area and by solid angle
std::vector<Family> microfacet_families();  // through half vectors
std::vector<Family> table_families();       // skies, tables, portals
std::vector<Family> held_out_families();    // for measurements, not for tuning

}  // namespace crescent::calibration
