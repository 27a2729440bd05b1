// A fault wraps the functions of a right sampler. Shares that need a random number use an additional one after those of
// the sampler. Caps have their mass from 2^18 draws: a relative error of 1 / sqrt(2^18 size).
#include "tests/calibration/faults.h"

#include <cstring>
#include <map>

#include "tests/calibration/geometry.h"
#include "tests/calibration/measures.h"

namespace crescent::calibration {

namespace {

constexpr int draws_for_places = 1 << 18;

Vec3d turned(Vec3d w, Vec3d axis, double angle) {  // Rodrigues
    const double c = std::cos(angle), s = std::sin(angle);
    return w * c + cross(axis, w) * s + axis * (dot(axis, w) * (1 - c));
}

const PlaceOfFault& nearest(const std::vector<PlaceOfFault>& all, Vec3d wo) {
    return *std::ranges::max_element(all, {}, [&](const PlaceOfFault& p) { return dot(p.wo, wo); });
}

/// Other numbers, a function of these and of the attempt: splitmix64 over their bits, 24 bits each.
template <class F> std::array<F, PrimarySample::most_numbers> others(const F* u, std::uint64_t attempt) {
    std::uint64_t h = attempt;
    const auto mixed = [](std::uint64_t x) {
        x += 0x9e3779b97f4a7c15u;
        x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
        x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
        return x ^ (x >> 31);
    };
    for (int k = 0; k < PrimarySample::most_numbers; ++k) {
        const double v = static_cast<double>(u[k]);
        std::uint64_t bits = 0;
        std::memcpy(&bits, &v, sizeof v);
        h = mixed(h ^ bits);
    }
    std::array<F, PrimarySample::most_numbers> out{};
    for (F& v : out) {
        h = mixed(h);
        v = F(h >> 40) * F(0x1p-24);
    }
    return out;
}

template <class F> Vec3<F> uniform(Domain domain, F u1, F u2) {
    return off_axis(Vec3<F>{0, 0, 1}, (domain == Domain::sphere ? 2 : 1) * u1, u2);
}

/// The claimed pdf of a pair, given p.
template <class F> F claimed(const Fault& fault, Vec3<F> wo, Vec3<F> wi, F p) {
    const auto m = [&] { return unit(wo + wi); };
    switch (fault.kind) {
        case FaultKind::constant: return p * F(1 + fault.size);
        case FaultKind::factor: return p * F(fault.size);
        case FaultKind::cos_missing: return wi.z != 0 ? p / std::fabs(wi.z) : F(0);
        case FaultKind::cos_twice: return p * std::fabs(wi.z);
        case FaultKind::sin_missing: return p * std::hypot(wi.x, wi.y);
        case FaultKind::jacobian_missing: return p * 4 * std::fabs(dot(wo, m()));
        case FaultKind::normal_missing: return p > 0 ? p / std::max(std::fabs(m().z), F(1e-6)) : F(0);
        default: return p;
    }
}

/// Applies a fault to the draw; only for the selected share of the draws.
template <class F> void apply_to_draw(const Fault& fault, Drawn<F>& d) {
    if (fault.kind == FaultKind::nan) d.pdf = std::numeric_limits<F>::quiet_NaN();
    if (fault.kind == FaultKind::negative) d.pdf = -d.pdf;
    if (fault.kind == FaultKind::length) d.wi = d.wi * F(1.01);
}

bool needs_number(FaultKind kind) {
    return kind == FaultKind::leak || kind == FaultKind::nan || kind == FaultKind::negative ||
        kind == FaultKind::length;
}

template <class F> struct FaultInjection {
    Functions<F> draws, claims;  // functions with the changed parameter, and functions of the pdf
    Fault fault;
    std::vector<PlaceOfFault> places;
    Domain domain;
    int numbers;

    bool in_cap(const PlaceOfFault& at, Vec3<F> w) const { return versine(at.cap, unit(widened(w))) < at.gap; }
    F pdf(Vec3<F> wo, Vec3<F> wi) const {
        if (fault.kind == FaultKind::blind && in_cap(nearest(places, widened(wo)), wi)) return 0;
        if (fault.kind == FaultKind::nan_at_horizon && wi.z == 0) return std::numeric_limits<F>::quiet_NaN();
        return claimed(fault, wo, wi, claims.pdf(wo, wi));
    }
    /// Whether the fault occurs at this single w_o or u.
    bool breaks_at(Vec3<F> wo, const F* u) const {
        const F sin = std::hypot(wo.x, wo.y);
        return (fault.kind == FaultKind::nan_in_plane && wo.z == 0) ||
            (fault.kind == FaultKind::nan_near_pole && sin > 0 && sin < F(1e-3) && wo.z > 0) ||
            (fault.kind == FaultKind::nan_at_zero && u[0] == 0);
    }
    /// The direction; pdf 0 for no sample.
    Drawn<F> direction(Vec3<F> wo, std::array<F, PrimarySample::most_numbers> u) const {
        if (fault.kind == FaultKind::one_number) u[1] = u[0];
        if (fault.kind == FaultKind::no_azimuth) u[1] = F(0.3125);
        if (fault.kind == FaultKind::leak && u[std::size_t(numbers)] < F(fault.size))
            return {uniform<F>(domain, u[0], u[1]), 1};
        if (fault.kind == FaultKind::frame_mirrored) return draws.sample({wo.x, -wo.y, wo.z}, u.data());
        Drawn<F> d = draws.sample(wo, u.data());
        if (!(d.pdf > 0)) return d;
        if (fault.kind == FaultKind::rotation)
            d.wi = cast<F>(turned(widened(d.wi), nearest(places, widened(wo)).turn, fault.size));
        if (fault.kind == FaultKind::hole) {
            const PlaceOfFault& at = nearest(places, widened(wo));
            for (std::uint64_t k = 1; k < 64 && d.pdf > 0 && in_cap(at, d.wi); ++k)
                d = draws.sample(wo, others(u.data(), k).data());
        }
        if (fault.kind == FaultKind::exponent) {
            const double high = nearest(places, widened(wo)).high;
            for (std::uint64_t k = 1; k < 64 && d.pdf > 0; ++k) {
                const auto fresh = others(u.data(), k);
                if (fresh.back() < std::pow(std::min(double(d.pdf) / high, 1.0), fault.size)) break;
                d = draws.sample(wo, fresh.data());
            }
        }
        return d;
    }
    Drawn<F> sample(Vec3<F> wo, const F* u) const {
        std::array<F, PrimarySample::most_numbers> v;
        std::copy_n(u, v.size(), v.begin());
        Drawn<F> d = direction(wo, v);
        constexpr F nan = std::numeric_limits<F>::quiet_NaN();
        if (breaks_at(wo, u)) return {{nan, nan, nan}, d.pdf};
        if (!(d.pdf > 0)) return {d.wi, 0};
        d.pdf = fault.kind == FaultKind::blind ? claims.pdf(wo, d.wi) : pdf(wo, d.wi);
        const bool share = needs_number(fault.kind) && u[numbers] < F(fault.size);
        if (share && fault.kind != FaultKind::leak) apply_to_draw(fault, d);
        return d;
    }
};

template <class F> Functions<F> injected(FaultInjection<F> injection) {
    Functions<F> out;
    out.f = injection.claims.f;
    const auto all = std::make_shared<const FaultInjection<F>>(std::move(injection));
    out.pdf = [all](Vec3<F> wo, Vec3<F> wi) { return all->pdf(wo, wi); };
    out.sample = [all](Vec3<F> wo, const F* u) { return all->sample(wo, u); };
    return out;
}

template <class F> std::vector<Vec3d> drawn_at(const Functions<F>& s, Vec3d wo, Rng& rng, int count) {
    std::vector<Vec3d> out;
    for (int k = 0; k < count; ++k) {
        F u[PrimarySample::most_numbers];
        for (F& v : u) v = F(std::floor(rng.uniform(0, 0x1p24)) * 0x1p-24);
        const Drawn<F> d = s.sample(cast<F>(wo), u);
        if (d.pdf > 0) out.push_back(unit(widened(d.wi)));
    }
    return out;
}

PlaceOfFault place_at(const std::vector<Vec3d>& draws, Vec3d wo, const Fault& fault, Rng& rng) {
    const Vec3d any = rng.direction(-1, 1);
    PlaceOfFault at{wo, any, {0, 0, 1}};
    if (draws.empty()) return at;
    Vec3d mean{0, 0, 0};
    for (Vec3d w : draws) mean = mean + w * (1 / static_cast<double>(draws.size()));
    if (dot(mean, mean) > 1e-4) at.turn = unit(cross(unit(mean), any));
    at.cap = draws[static_cast<std::size_t>(rng.uniform(0, static_cast<double>(draws.size())))];
    std::vector<double> gaps;
    for (Vec3d w : draws) gaps.push_back(versine(at.cap, w));
    const auto k = static_cast<std::size_t>(fault.size * draws_for_places);
    if (k >= gaps.size()) return at;
    std::nth_element(gaps.begin(), gaps.begin() + static_cast<std::ptrdiff_t>(k), gaps.end());
    at.gap = gaps[k];
    return at;
}

}  // namespace

std::vector<PlaceOfFault> places_of(
    const Sampler& right, const Fault& fault, std::span<const Vec3d> wo, const StreamKey& key) {
    const bool capped = fault.kind == FaultKind::hole || fault.kind == FaultKind::blind;
    const bool tempered = fault.kind == FaultKind::exponent;
    if (!capped && !tempered && fault.kind != FaultKind::rotation) return {};
    Rng rng = rng_of(key);
    std::vector<PlaceOfFault> out;
    const std::vector<Vec3d> only = {{0, 0, 1}};
    for (Vec3d o : right.wo == Traits::WoDomain::none ? std::span<const Vec3d>(only) : wo) {
        out.push_back(std::visit(
            [&](const auto& f) {
                return place_at(drawn_at(f, o, rng, capped ? draws_for_places : 4096), o, fault, rng);
            },
            right.functions));
        if (!tempered) continue;
        std::vector<double> p = draws_of(right, o, 4096, key.seed).pdf;
        const auto high = p.begin() + static_cast<std::ptrdiff_t>(p.size() * 999 / 1000);
        std::nth_element(p.begin(), high, p.end());
        out.back().high = *high;
    }
    return out;
}

Sampler faulty(const Family& family, const Member& member, Real real, const Fault& fault, std::span<const Vec3d> wo,
    const StreamKey& key) {
    Sampler right = sampler_of(family, member, real);
    if (fault.kind == FaultKind::none) return right;
    const bool mismatch = fault.kind == FaultKind::mismatch;
    const Sampler other = sampler_of(family, member, real, mismatch ? 1 + fault.size : 1);
    const Sampler claims = sampler_of(family, member, real, 1, fault.inner);
    const std::vector<PlaceOfFault> places = places_of(right, fault, wo, key);
    std::visit(
        [&]<class F>(const Functions<F>& draws) {
            right.functions = injected(FaultInjection<F>{
                draws, std::get<Functions<F>>(claims.functions), fault, places, family.domain, family.numbers});
        },
        other.functions);
    if (needs_number(fault.kind)) ++right.numbers;
    return right;
}

std::string_view word(const Fault& fault) {
    constexpr std::array words = {"right", "constant", "leak", "hole", "blind", "rotation", "exponent", "mismatch",
        "nan", "negative", "length", "factor", "cosine missing", "cosine twice", "sine missing", "Jacobian missing",
        "n.m missing", "one number twice", "azimuth unused", "frame mirrored", "NaN for w_o in the plane",
        "NaN for w_o next to n", "NaN for w_i in the plane", "NaN at u = 0"};
    constexpr std::array inner = {
        "right", "lobe's pdf", "equal weights", "no weights", "transposed table", "shifted table", "mirrored table"};
    return fault.kind == FaultKind::broken ? inner[std::size_t(fault.inner)] : words[std::size_t(fault.kind)];
}

std::string_view cause_of(const Fault& fault) {
    switch (fault.kind) {
        case FaultKind::constant:
        case FaultKind::factor: return "constant";
        case FaultKind::cos_missing:
        case FaultKind::cos_twice: return "cos_i";
        case FaultKind::sin_missing: return "sin_i";
        case FaultKind::jacobian_missing: return "half_vector_jacobian";
        case FaultKind::normal_missing: return "half_vector_cosine";
        case FaultKind::frame_mirrored: return "mirrored";
        case FaultKind::no_azimuth: return "curve";
        case FaultKind::broken: break;
        default: return "";
    }
    switch (fault.inner) {
        case Broken::equal_weights:
        case Broken::no_weights: return "chooser";
        case Broken::transposed_table: return "transposed";
        case Broken::shifted_table: return "shifted";
        case Broken::mirrored_table: return "mirrored";
        default: return "";
    }
}

bool is_true_of(std::string_view kind, std::string_view family, std::string_view text) {
    static const std::map<std::string_view, std::vector<std::string_view>> words = {
        {"leak", {"spread evenly", "does not have one of the lobes", "the chooser's probability"}},
        {"rotation", {"turned by"}}, {"mismatch", {"An exponent or a roughness differs", "Across the surface p is"}},
        {"exponent", {"An exponent or a roughness differs"}}, {"hole", {"positive where no draw falls"}},
        {"one number twice", {"lie on a curve"}}, {"lobe's pdf", {"the chooser's probability"}},
        {"one u used twice", {"lie on a curve"}}, {"axis about n but pdf about R", {"turned by"}},
        {"second light forgotten in the pdf", {"the chooser's probability of that one lobe"}},
        {"sqrt forgotten on the disk", {"a square root is missing"}},
        {"texel centre for texel", {"have one direction, w_i"}},
        {"pdf of the next texel", {"a shift of a table's columns"}},
        {"delta part told as a density", {"must declare it (delta)"}}};
    const bool bounded = family == "cone" || family == "ring" || family.find(" light ") != family.npos ||
        family == "textured disk" || family == "projected solid angle of a rectangle";
    if (bounded && (kind == "leak" || kind == "mismatch") && text.find("p is a constant") != text.npos) return true;
    const auto at = words.find(kind);
    if (at == words.end()) return false;
    return std::ranges::any_of(at->second, [&](std::string_view w) { return text.find(w) != text.npos; });
}

bool names_cause(std::string_view cause, const std::vector<std::string>& texts) {
    // A text names a cause if it contains one of the words of the cause.
    static const std::map<std::string_view, std::vector<std::string_view>> words = {{"constant", {"constant"}},
        {"cos_i", {"cos theta_i"}}, {"sin_i", {"sin theta"}}, {"half_vector_jacobian", {"w_o.m"}},
        {"half_vector_cosine", {"n.m"}}, {"mirrored", {"mirror", "reflection in"}},
        {"curve", {"curve", "on a line", "u2", "no effect"}},
        {"chooser", {"chooser", "weight of a lobe", "lobe weight"}}, {"transposed", {"transposed", "rows and columns"}},
        {"shifted", {"shift", "rotat", "turned", "texel"}}};
    if (cause.empty()) return false;
    const auto at = words.find(cause);
    const std::vector<std::string_view> itself = {cause};
    for (const std::string& text : texts)
        for (const std::string_view w : at == words.end() ? itself : at->second)
            if (text.find(w) != std::string::npos) return true;
    return false;
}

}  // namespace crescent::calibration
