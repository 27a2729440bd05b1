// A calibration sampler as a user's struct: its members take directions and const T* u in its own precision.
#include "tests/calibration/geometry.h"
#include "tests/calibration/sampler.h"
#include "check/user.h"

namespace crescent::calibration {

namespace {

/// `n` random numbers, with or without f.
template <class F, int n> struct AsStruct {
    static constexpr int numbers = n;
    Functions<F> functions;
    Traits known;
    Traits traits() const { return known; }
    Drawn<F> sample(Vec3<F> wo, const F* u) const { return functions.sample(wo, u); }
    F pdf(Vec3<F> wo, Vec3<F> wi) const { return functions.pdf(wo, wi); }
};
template <class F, int n> struct AsStructWithF : AsStruct<F, n> {
    F f(Vec3<F> wo, Vec3<F> wi) const { return this->functions.f(wo, wi); }
    Drawn<F> sample(Vec3<F> wo, const F* u) const { return this->functions.sample(wo, u); }
    F pdf(Vec3<F> wo, Vec3<F> wi) const { return this->functions.pdf(wo, wi); }
};

template <class F, int n>
std::shared_ptr<const SamplerAdapter> adapted(const std::string& name, const Functions<F>& s, const Traits& known) {
    if (s.f) return std::make_shared<UserSampler<AsStructWithF<F, n>>>(name, AsStructWithF<F, n>{{s, known}});
    return std::make_shared<UserSampler<AsStruct<F, n>>>(name, AsStruct<F, n>{s, known});
}

template <class F> std::shared_ptr<const SamplerAdapter> with_numbers(
    int n, const std::string& name, const Functions<F>& s, const Traits& known) {
    switch (n) {
        case 2: return adapted<F, 2>(name, s, known);
        case 3: return adapted<F, 3>(name, s, known);
        case 4: return adapted<F, 4>(name, s, known);
        case 5: return adapted<F, 5>(name, s, known);
    }
    throw std::invalid_argument("a calibration sampler takes 2 to 5 random numbers");
}

}  // namespace

std::shared_ptr<const SamplerAdapter> make_adapter(const Sampler& s) {
    if (s.given) return s.given;
    Traits known;
    known.wo = s.wo;
    known.reciprocal = s.reciprocal;
    if (s.eta) known.eta = Vec3d{*s.eta, *s.eta, *s.eta};
    const std::string name = s.family + " (" + s.parameters + ")";
    return std::visit(
        [&]<class F>(const Functions<F>& f) { return with_numbers<F>(s.numbers, name, f, known); }, s.functions);
}

Functions<float> rounded(Functions<double> exact) {
    const auto round = [](Vec3d v) { return Vec3f{float(v.x), float(v.y), float(v.z)}; };
    Functions<float> out;
    out.pdf = [exact](Vec3f wo, Vec3f wi) { return static_cast<float>(exact.pdf(widened(wo), widened(wi))); };
    if (exact.f) out.f = [exact](Vec3f wo, Vec3f wi) { return static_cast<float>(exact.f(widened(wo), widened(wi))); };
    out.sample = [exact, round](Vec3f wo, const float* u) {
        double wide[PrimarySample::most_numbers] = {};
        for (int k = 0; k < PrimarySample::most_numbers; ++k) wide[k] = static_cast<double>(u[k]);
        const Drawn<double> d = exact.sample(widened(wo), wide);
        const Vec3f wi = round(d.wi);
        return Drawn<float>{wi, d.pdf > 0 ? static_cast<float>(exact.pdf(widened(wo), widened(wi))) : 0.0f};
    };
    return out;
}

}  // namespace crescent::calibration
