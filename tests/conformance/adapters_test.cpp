// Adapters on small classes with the interfaces of pbrt-v4, Nori and OpenPBR: correct ones pass, and a pdf that is 3 %
// off is found through each.
#include <gtest/gtest.h>

#include "check/report/summary.h"
#include "crescent/adapters/nori.h"
#include "crescent/adapters/openpbr.h"

namespace {

constexpr float inverse_pi = 0.31830987f;

struct Vec {
    float x = 0, y = 0, z = 0;
    Vec() = default;
    Vec(float a, float b, float c) : x(a), y(b), z(c) {}
    float operator[](int k) const { return k == 0 ? x : k == 1 ? y : z; }
};
struct Point {
    float x = 0, y = 0;
    Point(float a, float b) : x(a), y(b) {}
};

Vec by_cosine(float u1, float u2) {
    const float r = std::sqrt(u1), phi = 6.2831853f * u2;
    return {r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - u1)};
}
float cosine_pdf(Vec wi) { return wi.z > 0 ? wi.z * inverse_pi : 0; }

// --- of pbrt's shape ---------------------------------------------------------------------------------------------
enum class Mode { radiance, importance };
struct Spectrum {
    float v[4] = {};
    float Average() const { return (v[0] + v[1] + v[2] + v[3]) / 4; }
};
struct Sample {
    Spectrum f;
    Vec wi;
    float pdf = 0;
    bool mirror = false;
    bool IsSpecular() const { return mirror; }
};

/// A mirror of 0.3 chosen a quarter of the time, and Lambert of 0.5.
struct PbrtLike {
    float off = 1;
    Spectrum f(Vec wo, Vec wi, Mode) const {
        const float value = wo.z > 0 && wi.z > 0 ? 0.5f * inverse_pi : 0;
        return {{value, value, value, value}};
    }
    std::optional<Sample> Sample_f(Vec wo, float uc, Point u, Mode mode) const {
        if (wo.z <= 0) return {};
        if (uc < 0.25f) {
            const float f = 0.3f / wo.z;
            return Sample{{{f, f, f, f}}, {-wo.x, -wo.y, wo.z}, 0.25f, true};
        }
        const Vec wi = by_cosine(u.x, u.y);
        return Sample{f(wo, wi, mode), wi, PDF(wo, wi, mode), false};
    }
    float PDF(Vec wo, Vec wi, Mode) const { return wo.z > 0 ? 0.75f * off * cosine_pdf(wi) : 0; }
};

/// Like some classes of pbrt: the requested part is the last argument, without a default.
enum class WoDomain { none, reflection, transmission, all };
struct FlaggedPbrtLike : PbrtLike {
    std::optional<Sample> Sample_f(Vec wo, float uc, Point u, Mode mode, WoDomain asked) const {
        return asked == WoDomain::all ? PbrtLike::Sample_f(wo, uc, u, mode) : std::nullopt;
    }
    float PDF(Vec wo, Vec wi, Mode mode, WoDomain asked) const {
        return asked == WoDomain::all ? PbrtLike::PDF(wo, wi, mode) : 0;
    }
};

// --- of Nori's shape ---------------------------------------------------------------------------------------------
enum Measure { unknown = 0, solid_angle, discrete };
struct Record {
    Vec wi, wo;
    Measure measure = unknown;
    explicit Record(Vec given) : wi(given) {}
    Record(Vec given, Vec drawn, Measure m) : wi(given), wo(drawn), measure(m) {}
};
struct NoriLike {
    float off = 1;
    Vec sample(Record& r, const Point& u) const {
        if (r.wi.z <= 0) return {};
        r.measure = solid_angle;
        r.wo = by_cosine(u.x, u.y);
        return {0.5f, 0.5f, 0.5f};
    }
    Vec eval(const Record& r) const {
        const float f = r.measure == solid_angle && r.wi.z > 0 && r.wo.z > 0 ? 0.5f * inverse_pi : 0;
        return {f, f, f};
    }
    float pdf(const Record& r) const { return r.wi.z > 0 ? off * cosine_pdf(r.wo) : 0; }
};

}  // namespace

// --- of OpenPBR's shape ------------------------------------------------------------------------------------------
namespace openpbr_like {

struct Prepared {
    Vec wo;
    float off = 1;
};
struct Value {
    Vec diffuse, specular;
};

inline Value openpbr_eval(const Prepared& at, Vec wi) {
    const float c = at.wo.z > 0 && wi.z > 0 ? wi.z * inverse_pi : 0;
    return {{0.6f * c, 0.4f * c, 0.2f * c}, {0.1f * c, 0.1f * c, 0.1f * c}};
}
inline float openpbr_pdf(const Prepared& at, Vec wi) { return at.wo.z > 0 ? at.off * cosine_pdf(wi) : 0; }
inline void openpbr_sample(const Prepared& at, Vec u, Vec& wi, Value& weight, float& pdf, std::uint32_t& /*type*/) {
    wi = by_cosine(u.x, u.y);
    pdf = openpbr_pdf(at, wi);
    weight = {{0.6f, 0.4f, 0.2f}, {0.1f, 0.1f, 0.1f}};
}
inline Vec openpbr_get_sum_of_diffuse_specular(const Value& v) {
    return {v.diffuse.x + v.specular.x, v.diffuse.y + v.specular.y, v.diffuse.z + v.specular.z};
}

}  // namespace openpbr_like

namespace {

crescent::TestSettings few() {
    crescent::TestSettings settings;
    settings.wo = {{30, 0}, {75, 310}};
    return settings;
}

template <class Sampler> void expect(const Sampler& sampler, crescent::State state) {
    const crescent::CheckResult j = crescent::check_sampler("adapted", sampler, few());
    EXPECT_EQ(j.state, state) << crescent::what_is_wrong(j);
}

TEST(Adapters, PbrtClassIsCheckedWithItsDeltaPart) {
    expect(crescent::adapters::Pbrt(PbrtLike{}), crescent::State::right);
    expect(crescent::adapters::Pbrt(PbrtLike{1.03f}), crescent::State::wrong);
    expect(crescent::adapters::Pbrt(FlaggedPbrtLike{}), crescent::State::right);
}

TEST(Adapters, AreToldWhatElseIsKnown) {
    const crescent::Traits both{.wo = crescent::Traits::WoDomain::both, .reciprocal = false};
    const crescent::adapters::Nori known(NoriLike{}, both);
    EXPECT_EQ(crescent::user::traits_of(known).wo, crescent::Traits::WoDomain::both);
    EXPECT_FALSE(crescent::user::traits_of(crescent::adapters::Pbrt(PbrtLike{}, both)).reciprocal);
}

TEST(Adapters, AClassOfNorisShapeIsJudged) {
    expect(crescent::adapters::Nori(NoriLike{}), crescent::State::right);
    expect(crescent::adapters::Nori(NoriLike{1.03f}), crescent::State::wrong);
}

TEST(Adapters, OpenPbrFunctionsAreCheckedInColour) {
    const auto of = [](float off) {
        return crescent::adapters::OpenPbr<Vec>([off](Vec wo) { return openpbr_like::Prepared{wo, off}; });
    };
    expect(of(1), crescent::State::right);
    expect(of(1.03f), crescent::State::wrong);
}

}  // namespace
