// Right samplers that are difficult to check: singular, thin, tiny and discontinuous densities, large skies in single
// precision, needles. Parameters vary slightly with the seed, within the difficult range.
#include <fmt/format.h>

#include "tests/calibration/axial.h"
#include "tests/calibration/cases.h"
#include "tests/calibration/microfacets.h"
#include "tests/calibration/skies.h"

namespace crescent::calibration {

namespace {

using Wo = Traits::WoDomain;
using Profiled = Profile<double>;

Sampler without_wo(
    std::string name, std::string text, int numbers, std::variant<Functions<double>, Functions<float>> f) {
    Sampler s;
    s.family = std::move(name);
    s.parameters = std::move(text);
    s.numbers = numbers;
    s.wo = Wo::none;
    s.functions = std::move(f);
    return s;
}
/// +z, -z or any direction.
Vec3d some_axis(Rng& d) {
    const int k = d.whole(0, 3);
    return k == 0 ? Vec3d{0, 0, 1} : k == 1 ? Vec3d{0, 0, -1} : d.direction(-1, 1);
}
Sampler lobe(Rng& d, std::string name, std::string text, Profiled profile) {
    const Vec3d axis = some_axis(d);
    return without_wo(std::move(name), text + fmt::format(", axis z {:.3f}", axis.z), 2,
        single<double>(fixed<double>(axis), profile));
}

/// p ~ t^-e, integrable at the axis.
Sampler pole_of_density(Rng& d) {
    const double e = d.uniform(0.4, 0.9);
    return lobe(d, "t^-e", fmt::format("e {:.3f}", e),
        {[e](double u) { return 2 * std::pow(u, 1 / (1 - e)); },
            [e](double t) {
                return (1 - e) * std::pow(std::max(t, 1e-300), -e) / (2 * pi_of<double> * std::pow(2, 1 - e));
            }});
}
/// Uniform in theta.
Sampler uniform_theta(Rng& d) {
    return lobe(d, "uniform in theta", "-",
        {[](double u) { return 2 * sqr(std::sin(pi_of<double> * u / 2)); },
            [](double t) { return 1 / (2 * sqr(pi_of<double>) * std::sqrt(std::max(t * (2 - t), 1e-300))); }});
}
Sampler thin_ring(Rng& d) {
    const double low = d.uniform(0.1, 0.8), wide = d.log(3e-5, 1e-3);
    return lobe(d, "thin ring", fmt::format("width {:.2g}", wide),
        {[=](double u) { return low + wide * u; },
            [=](double t) {
                return t >= low - 1e-14 && t <= low + wide + 1e-14 ? 1 / (2 * pi_of<double> * wide) : 0.0;
            }});
}
Sampler needle(Rng& d) {
    const double gap = d.log(1e-8, 1e-5);
    return lobe(d, "needle", fmt::format("1 - cos {:.2g}", gap), cone_profile<double>(gap));
}
/// (1 + t / b)^-g, which has no second moment.
Sampler heavy_tail(Rng& d) {
    const double g = d.uniform(1.05, 1.5), b = d.log(1e-7, 1e-4), whole = -std::expm1((1 - g) * std::log1p(2 / b));
    return lobe(d, "heavy tail", fmt::format("power {:.3f}, scale {:.2g}", g, b),
        {[=](double u) { return std::min(2.0, b * std::expm1(std::log1p(-u * whole) / (1 - g))); },
            [=](double t) { return (g - 1) / b * std::pow(1 + t / b, -g) / whole / (2 * pi_of<double>); }});
}
Sampler forward_scattering(Rng& d) {
    const double g = 1 - d.log(1e-3, 2e-2);
    return lobe(d, "forward scattering", fmt::format("g {:.5f}", g), greenstein_profile<double>(g));
}
/// The neighbourhood of a great circle: a normal distribution of the height above a tilted plane, truncated at 1.
Sampler band(Rng& d) {
    const double sd = d.log(1e-4, 1e-2);
    const Vec3d axis = d.direction(-1, 1);
    const Frame<double> frame = frame_about(axis);
    Functions<double> f;
    f.pdf = [=](Vec3d, Vec3d w) {
        const double z = dot(axis, w) / sd;
        return std::exp(-z * z / 2) / (std::sqrt(2 * pi_of<double>) * sd) / (2 * pi_of<double>);
    };
    f.sample = [=, pdf = f.pdf](Vec3d o, const double* u) {
        const double z = sd * std::sqrt(-2 * std::log1p(-u[0])) * std::cos(2 * pi_of<double> * u[1]);
        const double s = std::sqrt(std::max(0.0, 1 - z * z)), phi = 2 * pi_of<double> * u[2];
        const Vec3d w = frame.to_world(Vec3d{s * std::cos(phi), s * std::sin(phi), z});
        return Drawn<double>{w, pdf(o, w)};
    };
    return without_wo("band", fmt::format("sd {:.2g}", sd), 3, f);
}
Sampler rare_spike(Rng& d) {
    const double share = d.log(1e-4, 1e-2), k = d.log(1e6, 1e8);
    return without_wo("rare spike", fmt::format("share {:.2g}, kappa {:.2g}", share, k), 3,
        mixture<double>({{1 - share, fixed<double>({0, 0, 1}), power_profile<double>(1)},
                            {share, fixed<double>(d.direction(0, 1)), fisher_profile<double>(k)}},
            Broken::none));
}
Sampler many_disks(Rng& d) {
    struct One {
        Vec3d axis;
        double gap;
    };
    auto all = std::make_shared<std::vector<One>>();
    for (int k = 0; k < 1000; ++k) {
        const double gap = d.log(1e-7, 1e-3);
        all->push_back({d.direction(-1, 1), gap});
    }
    Functions<double> f;
    f.pdf = [all](Vec3d, Vec3d w) {
        double p = 0;
        for (const One& o : *all) p += versine(o.axis, w) <= o.gap * (1 + 1e-12) + 1e-20 ? 1 / o.gap : 0;
        return p / (2 * pi_of<double> * 1000);
    };
    f.sample = [all, pdf = f.pdf](Vec3d o, const double* u) {
        const One& one = (*all)[std::min<std::size_t>(999, std::size_t(u[2] * 1000))];
        const Vec3d w = off_axis(one.axis, one.gap * u[0], u[1]);
        return Drawn<double>{w, pdf(o, w)};
    };
    return without_wo("1000 disks", "1 - cos 1e-7 to 1e-3", 3, f);
}

/// Constant in cells of t x phi that no dyadic cut aligns with.
Sampler cells(std::string name, int columns, int rows, const std::function<double(int x, int y)>& value) {
    auto mass = std::make_shared<std::vector<double>>(), sums = std::make_shared<std::vector<double>>(1, 0.0);
    for (int k = 0; k < columns * rows; ++k) {
        mass->push_back(value(k % columns, k / columns));
        sums->push_back(sums->back() + mass->back());
    }
    Functions<double> f;
    const double all = sums->back(), per_sr = columns * rows / (4 * pi_of<double> * all);
    f.pdf = [=](Vec3d, Vec3d w) {
        const double t = w.z > 0 ? (w.x * w.x + w.y * w.y) / (1 + w.z) : 1 - w.z;
        const int x = std::min(columns - 1, int(turns_of(w) * columns)), y = std::clamp(int(t / 2 * rows), 0, rows - 1);
        return (*mass)[std::size_t(y * columns + x)] * per_sr;
    };
    f.sample = [=, pdf = f.pdf](Vec3d o, const double* u) {
        const double at = u[0] * all;
        const auto k = std::size_t(std::clamp<std::ptrdiff_t>(
            std::upper_bound(sums->begin(), sums->end(), at) - sums->begin() - 1, 0, columns * rows - 1));
        const double part = std::min((at - (*sums)[k]) / (*mass)[k], 1 - 1e-15);
        const double y = double(k / std::size_t(columns)) + part, x = double(k % std::size_t(columns)) + u[1];
        const double t = 2 * y / rows, s = std::sqrt(std::max(t * (2 - t), 0.0)), phi = 2 * pi_of<double> * x / columns;
        const Vec3d w{s * std::cos(phi), s * std::sin(phi), 1 - t};
        return Drawn<double>{w, pdf(o, w)};
    };
    return without_wo(std::move(name), fmt::format("{} x {} cells", columns, rows), 2, f);
}
Sampler chequers(Rng& d) {
    const int columns = d.whole(60, 140);
    return cells("chequers", columns, columns * 37 / 100, [](int x, int y) { return (x + y) % 2 ? 1.9 : 0.1; });
}
Sampler fine_chequers(Rng& d) {
    const int columns = d.whole(800, 1200);
    return cells("fine chequers", columns, columns * 37 / 100, [](int x, int y) { return (x + y) % 2 ? 1.9 : 0.1; });
}
Sampler lognormal(Rng& d) {
    const double sigma = d.uniform(2, 3);
    return cells("lognormal cells", d.whole(60, 300), d.whole(60, 200), [&](int, int) {
        double sum = -2;
        for (int k = 0; k < 4; ++k) sum += d.uniform(0, 1);
        return std::exp(sigma * std::sqrt(3.0) * sum);
    });
}
Sampler cascade(Rng&) {
    return cells("cascade", 243, 243, [](int x, int y) {
        constexpr double weight[3] = {0.2, 1.7, 1.1};
        double m = 1;
        for (int k = 0; k < 5; ++k) {
            m *= weight[x % 3] * weight[(y + x) % 3];
            x /= 3;
            y /= 3;
        }
        return m;
    });
}
/// Most draws return no sample: a cosine lobe that is drawn once in a thousand.
Sampler mostly_nothing(Rng& d) {
    const double share = d.log(1e-3, 1e-2);
    Functions<double> f;
    f.pdf = [share](Vec3d, Vec3d w) { return share * std::max(w.z, 0.0) / pi_of<double>; };
    f.sample = [share, pdf = f.pdf](Vec3d o, const double* u) {
        if (u[2] >= share) return Drawn<double>{{0, 0, 1}, 0};
        const Vec3d w = cosine_weighted(u[0], u[1]);
        return Drawn<double>{w, pdf(o, w)};
    };
    return without_wo("mostly nothing", fmt::format("share {:.2g}", share), 3, f);
}
Sampler many_lobes(Rng& d) {
    std::vector<Lobe<double>> lobes;
    const double k = d.whole(0, 1) ? 5e3 : 2e5;
    for (int i = 0; i < 300; ++i) lobes.push_back({1, fixed<double>(d.direction(-1, 1)), fisher_profile<double>(k)});
    return without_wo("300 lobes", fmt::format("kappa {:.2g}", k), 3, mixture<double>(std::move(lobes), Broken::none));
}

Sampler sharp_ggx(Rng& d) {
    const float alpha = static_cast<float>(d.log(1e-3, 0.02));
    Sampler s = without_wo("sharp GGX", fmt::format("alpha {:.4g}", alpha), 2, Ggx2<float>{alpha, alpha}.visible());
    s.wo = Wo::upper;
    return s;
}
Sampler ggx_003(Rng&) {
    Sampler s = without_wo("sharp GGX", "alpha 0.003", 2, Ggx2<float>{0.003f, 0.003f}.visible());
    s.wo = Wo::upper;
    return s;
}
/// A lobe about the far pole in single precision.
Sampler far_pole(Rng& d) {
    const double k = d.log(100, 1e5);
    const bool cone = d.whole(0, 1) == 1;
    const auto axis = fixed<float>({0, 0, -1});
    return without_wo("far pole", fmt::format("{} {:.3g}", cone ? "cone 1 - cos" : "kappa", cone ? 1 / k : k), 2,
        single<float>(axis, cone ? cone_profile<float>(float(1 / k)) : fisher_profile<float>(float(k))));
}
/// A sphere light in single precision: the intersection test of w uses the rounded direction, without a margin.
Sampler sphere_rim(Rng& d) {
    const float ratio = static_cast<float>(d.log(0.02, 0.9)), s2 = ratio * ratio;
    const float gap = s2 / (1 + std::sqrt(1 - s2)), density = 1 / (2 * pi_of<float> * gap);
    Functions<float> f = single<float>(fixed<float>(d.direction(-1, 1)),
        {[gap](float u) { return gap * u; }, [gap, density](float t) { return t <= gap ? density : 0.0f; }});
    f.sample = [sample = f.sample, density](Vec3f o, const float* u) { return Drawn<float>{sample(o, u).wi, density}; };
    return without_wo("sphere light at its rim", fmt::format("radius / distance {:.3f}", ratio), 2, f);
}

/// 2048 x 1024 texels in single precision, with a sun of 5 x 5 texels 20,000 times as bright.
Sampler large_sky(Rng& d, bool noise, bool alias) {
    constexpr int rows = 1024, columns = 2048;
    std::vector<double> radiance;
    const int sun_row = d.whole(100, 900), sun_column = d.whole(0, columns - 6);
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) {
            const double theta = pi_of<double> * (i + 0.5) / rows;
            double v = 0.5 + (i < rows / 2 ? std::exp(-3 * std::cos(theta)) : 0) +
                0.2 * std::sin(6 * pi_of<double> * j / columns);
            if (noise) v *= std::exp(2 * (d.uniform(0, 1) + d.uniform(0, 1) + d.uniform(0, 1) - 1.5));
            if (i >= sun_row && i < sun_row + 5 && j >= sun_column && j < sun_column + 5) v += 2e4;
            radiance.push_back(v);
        }
    return sky_sampler(fmt::format("large sky{}{}", noise ? ", noise" : "", alias ? ", alias table" : ""), rows,
        columns, radiance, alias, Real::f32);
}
template <bool noise, bool alias> Sampler sky(Rng& d) { return large_sky(d, noise, alias); }

/// p linear in theta between 181 rows, drawn by the exact CDF.
Sampler rows_181(Rng& d) {
    auto value = std::make_shared<std::vector<double>>(), sums = std::make_shared<std::vector<double>>(1, 0.0);
    constexpr double h = pi_of<double> / 180;
    for (int i = 0; i <= 181; ++i) value->push_back(0.2 + std::exp(-sqr((i - 35) / 14.0)) + 0.3 * d.uniform(0, 1));
    // Integral of (a + b x) sin(i h + x) up to x.
    const auto part = [value](std::size_t i, double x) {
        const double a = (*value)[i], b = ((*value)[i + 1] - a) / h, t = double(i) * h;
        return a * (std::cos(t) - std::cos(t + x)) + b * (std::sin(t + x) - std::sin(t) - x * std::cos(t + x));
    };
    for (std::size_t i = 0; i < 180; ++i) sums->push_back(sums->back() + part(i, h));
    const double all = 2 * pi_of<double> * sums->back();
    Functions<double> f;
    f.pdf = [=](Vec3d, Vec3d w) {
        const double theta = std::atan2(std::hypot(w.x, w.y), w.z) / h;
        const auto i = std::min<std::size_t>(179, std::size_t(theta));
        return ((*value)[i] + ((*value)[i + 1] - (*value)[i]) * (theta - double(i))) / all;
    };
    f.sample = [=, pdf = f.pdf](Vec3d o, const double* u) {
        const double y = u[0] * sums->back();
        const auto i = std::size_t(
            std::clamp<std::ptrdiff_t>(std::upper_bound(sums->begin(), sums->end(), y) - sums->begin() - 1, 0, 179));
        double low = 0, high = h;
        for (int k = 0; k < 50; ++k) {
            const double middle = (low + high) / 2;
            (part(i, middle) < y - (*sums)[i] ? low : high) = middle;
        }
        const double theta = double(i) * h + low, phi = 2 * pi_of<double> * u[1];
        const Vec3d w{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
        return Drawn<double>{w, pdf(o, w)};
    };
    return without_wo("181 rows", "linear in theta", 2, f);
}

constexpr Sampler (*makers[])(Rng&) = {pole_of_density, uniform_theta, thin_ring, needle, heavy_tail,
    forward_scattering, band, rare_spike, many_disks, chequers, fine_chequers, lognormal, cascade, mostly_nothing,
    many_lobes, sharp_ggx, ggx_003, far_pole, sphere_rim, sky<false, false>, sky<true, false>, sky<false, true>,
    sky<true, true>, rows_181};
constexpr std::uint64_t variants = 3;

}  // namespace

std::uint64_t count_hard() { return variants * std::size(makers); }

Case make_hard(const CaseKey& key) {
    Rng d = rng_of({key.set, key.seed, key.index, "parameters"});
    return case_of(makers[key.index % std::size(makers)](d), key, State::right, "right");
}

}  // namespace crescent::calibration
