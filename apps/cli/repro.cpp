// The fault is measured again, by means over one set of random directions and draws or at a single one, since a short
// script can do no more. w_o, u and w are then replaced by rounder ones as long as the fault keeps half of its size.
#include "repro.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <regex>
#include <sstream>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "repro_points.h"
#include "repro_numbers.h"
#include "repro_reach.h"

namespace crescent::cli {

namespace {

constexpr std::size_t evaluations = 1u << 16;  // the longest block of docs/samplers.md
constexpr double clear_errors = 6;             // standard errors: several hundred means are compared
constexpr double kept_size = 0.5;              // of the fault at the worst w_o, at a rounder one
constexpr double rounding = 1e-3;              // relative: a difference that single precision does not explain
constexpr double degree = pi / 180;

/// A direction by its angles in degrees, as the script writes it.
struct Angles {
    double theta = 0, phi = 0;
    Vec3d direction() const {
        const double sine = std::sin(theta * degree);
        return {sine * std::cos(phi * degree), sine * std::sin(phi * degree), std::cos(theta * degree)};
    }
};

Angles angles_of(Vec3d w) {
    const double phi = std::atan2(w.y, w.x) / degree;
    return {std::acos(std::clamp(w.z, -1.0, 1.0)) / degree, phi < 0 ? phi + 360 : phi};
}

/// A rectangle of cos theta and phi, degrees.
struct Cell {
    double from_cos = 0, to_cos = 0, from_phi = 0, to_phi = 0;
};

/// A fault that a script shows: its kind, its size, and where.
struct ShownFault {
    enum class Kind { bad_draw, bad_pdf, bad_f, dark, integral, cell, two_pdfs, energy, not_reciprocal, mean, weights };
    Kind kind = Kind::integral;
    double size = 0;
    PrimarySample u{};
    Angles a{}, b{};
    Cell cell{};
    int channel = 0;
};

/// Mean and standard error of values.
struct Mean {
    double value = 0, error = 0;
    explicit Mean(std::span<const double> x) {
        const auto n = static_cast<double>(x.size());
        double square = 0;
        for (const double v : x) value += v / n;
        for (const double v : x) square += sqr(v - value) / n;
        error = std::sqrt(square / n);
    }
};

bool differ(double a, double b, double error) { return std::fabs(a - b) > clear_errors * error; }
bool usable(double x) { return std::isfinite(x) && x >= 0; }
bool usable(const Draw& d) { return usable(d.pdf) && (d.pdf == 0 || std::fabs(length(d.wi) - 1) < rounding); }

/// One sampler at one w_o, with the same random numbers at each.
class Bench {
public:
    Bench(const SamplerAdapter& sampler, bool hemisphere, Vec3d wo)
        : sampler_(sampler), traits_(sampler.traits()), hemisphere_(hemisphere), wo_(wo) {}

    /// The fault that the verdict names, if it shows here.
    std::optional<ShownFault> find(std::string_view verdict) const {
        if (verdict == "valid") return find_unusable();
        if (verdict == "support") return find_dark();
        if (verdict == "normalised") return find_integral();
        if (verdict == "density") return find_cell();
        if (verdict == "identity") return find_two_pdfs();
        if (verdict == "physics") return find_physics();
        if (verdict == "mean") return find_mean();
        return {};
    }

private:
    using Kind = ShownFault::Kind;

    std::vector<PrimarySample> numbers() const {
        RandomBits random(1);
        std::vector<PrimarySample> out(evaluations);
        for (PrimarySample& u : out) u = random_numbers(random, traits_.numbers);
        return out;
    }
    double lowest() const { return hemisphere_ ? 0 : -1; }
    /// Uniform over the domain.
    std::vector<Vec3d> directions() const {
        RandomBits random(2);
        std::vector<Vec3d> out;
        while (out.size() < evaluations) {
            const double z = lowest() + (1 - lowest()) * uniform(random);
            const double phi = 2 * pi * uniform(random), r = std::sqrt(1 - z * z);
            out.push_back({r * std::cos(phi), r * std::sin(phi), z});
        }
        return out;
    }
    double solid_angle() const { return 2 * pi * (1 - lowest()); }
    /// Of the upper hemisphere, with the density cos / pi or uniform.
    static std::vector<Vec3d> upper(bool is_cosine) {
        RandomBits random(3);
        std::vector<Vec3d> out;
        while (out.size() < evaluations) {
            const double u = uniform(random), z = is_cosine ? std::sqrt(1 - u) : u;
            const double phi = 2 * pi * uniform(random), r = std::sqrt(1 - z * z);
            out.push_back({r * std::cos(phi), r * std::sin(phi), z});
        }
        return out;
    }
    /// The integral of g over the domain, from directions above the surface and their images below it.
    Mean integrate(bool is_cosine, const std::function<std::vector<double>(std::span<const Vec3d>)>& g) const {
        std::vector<Vec3d> w = upper(is_cosine);
        std::vector<double> out = g(w);
        for (Vec3d& v : w) v.z = -v.z;
        if (!hemisphere_) {
            const std::vector<double> lower_values = g(w);
            for (std::size_t i = 0; i < out.size(); ++i) out[i] += lower_values[i];
        }
        for (double& x : out) x *= is_cosine ? pi : 2 * pi;
        return Mean(out);
    }
    /// The integral of f cos.
    Mean power(int channel) const {
        return integrate(true, [&](std::span<const Vec3d> w) {
            std::vector<double> out;
            for (const Vec3d v : f(w)) out.push_back(channel_of(v, channel));
            return out;
        });
    }
    std::vector<Draw> draw(std::span<const PrimarySample> u) const {
        std::vector<Draw> out(u.size());
        sampler_.sample(0, wo_, u, out);
        return out;
    }
    std::vector<double> pdf(std::span<const Vec3d> w) const {
        std::vector<Pair> pairs;
        for (const Vec3d v : w) pairs.push_back({wo_, v});
        std::vector<double> out(w.size());
        sampler_.pdf(0, pairs, out);
        return out;
    }
    std::vector<Vec3d> f(std::span<const Pair> pairs) const {
        std::vector<Vec3d> out(pairs.size());
        sampler_.f_channels(pairs, out);
        return out;
    }
    std::vector<Vec3d> f(std::span<const Vec3d> w) const {
        std::vector<Pair> pairs;
        for (const Vec3d v : w) pairs.push_back({wo_, v});
        return f(pairs);
    }

    /// The first u for which the predicate holds, with as few digits as it needs.
    std::optional<PrimarySample> shortest_u(
        std::span<const PrimarySample> u, const std::function<bool(const Draw&)>& holds) const {
        const std::vector<Draw> draws = draw(u);
        const auto match = std::ranges::find_if(draws, holds);
        if (match == draws.end()) return {};
        return with_few_digits(
            sampler_, wo_, u[static_cast<std::size_t>(match - draws.begin())], traits_.numbers, holds);
    }
    /// Angles of as few digits as the predicate allows, near those of w.
    static Angles shortest_angles(Vec3d w, const std::function<bool(Vec3d)>& holds) {
        const Angles angles = angles_of(w);
        for (const double step : {15.0, 5.0, 1.0, 0.1, 0.01, 1e-4}) {
            const Angles round{std::round(angles.theta / step) * step, std::round(angles.phi / step) * step};
            if (holds(round.direction())) return round;
        }
        return angles;
    }

    std::optional<ShownFault> find_unusable() const {
        std::vector<PrimarySample> u;
        for (int corner = 0; corner < 1 << traits_.numbers; ++corner) {
            PrimarySample vertex;
            for (int k = 0; k < traits_.numbers; ++k) vertex[k] = corner >> k & 1 ? below_one : 0;
            u.push_back(vertex);
        }
        const std::vector<PrimarySample> random_u = numbers();
        u.insert(u.end(), random_u.begin(), random_u.end());
        if (const auto bad_u = shortest_u(u, [](const Draw& d) { return !usable(d) && !(d.delta > 0); }))
            return ShownFault{.kind = Kind::bad_draw, .size = 1, .u = *bad_u};
        const std::vector<Vec3d> w = directions();
        const auto is_bad = [this](Vec3d v) { return !usable(pdf(std::span(&v, 1))[0]); };
        if (traits_.has_pdf) {
            const std::vector<double> p = pdf(w);
            const auto bad_p = std::ranges::find_if_not(p, [](double v) { return usable(v); });
            if (bad_p != p.end())
                return ShownFault{.kind = Kind::bad_pdf,
                    .size = 1,
                    .a = shortest_angles(w[static_cast<std::size_t>(bad_p - p.begin())], is_bad)};
        }
        if (!sampler_.has_f()) return {};
        const std::vector<Vec3d> values = f(w);
        for (int c = 0; c < traits_.channels; ++c) {
            const auto bad_value = std::ranges::find_if_not(values, [c](Vec3d v) { return usable(channel_of(v, c)); });
            if (bad_value == values.end()) continue;
            const auto is_bad_f = [this, c](Vec3d v) { return !usable(channel_of(f(std::span(&v, 1))[0], c)); };
            return ShownFault{.kind = Kind::bad_f,
                .size = 1,
                .a = shortest_angles(w[static_cast<std::size_t>(bad_value - values.begin())], is_bad_f),
                .channel = c};
        }
        return {};
    }
    std::optional<ShownFault> find_dark() const {
        if (!traits_.has_pdf || !sampler_.has_f()) return {};
        const std::vector<Vec3d> w = directions(), f_values = f(w);
        const std::vector<double> p = pdf(w);
        std::optional<std::size_t> best;
        double lost_power = 0;
        for (std::size_t i = 0; i < w.size(); ++i) {
            const double f_cos = p[i] == 0 ? f_values[i].x * std::fabs(w[i].z) : 0;
            if (f_cos > 0) lost_power += f_cos * solid_angle() / static_cast<double>(w.size());
            if (f_cos > 0 && (!best || f_cos > f_values[*best].x * std::fabs(w[*best].z))) best = i;
        }
        if (!best) return {};
        const auto is_dark = [this](Vec3d v) {
            return pdf(std::span(&v, 1))[0] == 0 && f(std::span(&v, 1))[0].x * std::fabs(v.z) > 0;
        };
        return ShownFault{.kind = Kind::dark, .size = lost_power, .a = shortest_angles(w[*best], is_dark)};
    }
    /// The part of the draws that are directions.
    Mean drawn_share() const {
        std::vector<double> indicators;
        for (const Draw& d : draw(numbers())) indicators.push_back(d.pdf > 0 ? 1 : 0);
        return Mean(indicators);
    }
    std::optional<ShownFault> find_integral() const {
        if (!traits_.has_pdf) return {};
        const Mean integral = integrate(false, [&](std::span<const Vec3d> w) { return pdf(w); }), share = drawn_share();
        const double size = std::fabs(integral.value - share.value);
        if (!differ(integral.value, share.value, std::hypot(integral.error, 0.5 / std::sqrt(evaluations)))) return {};
        return ShownFault{.kind = Kind::integral, .size = size};
    }
    /// Bands of cos theta, sectors of phi, and their intersections, an eighth of the domain each way.
    std::optional<ShownFault> find_cell() const {
        if (!traits_.has_pdf) return {};
        constexpr std::size_t parts = 8;
        std::array<std::array<double, parts>, parts> draw_counts{}, pdf_sums{}, pdf_squares{};
        const auto part_of = [&](Vec3d w) {
            const double height = (w.z - lowest()) / (1 - lowest()) * parts, turn = angles_of(w).phi / 360 * parts;
            const auto index = [](double x) {
                return static_cast<std::size_t>(std::clamp(x, 0.0, static_cast<double>(parts) - 1));
            };
            return std::pair(index(height), index(turn));
        };
        const std::vector<Vec3d> w = directions();
        const std::vector<double> p = pdf(w);
        double draws = 0, pdf_total = 0;
        for (const Draw& d : draw(numbers()))
            if (d.pdf > 0 && (!hemisphere_ || d.wi.z > 0)) {
                const auto [i, j] = part_of(d.wi);
                draw_counts[i][j] += 1;
                draws += 1;
            }
        for (std::size_t k = 0; k < w.size(); ++k) {
            const auto [i, j] = part_of(w[k]);
            pdf_sums[i][j] += p[k];
            pdf_squares[i][j] += p[k] * p[k];
            pdf_total += p[k];
        }
        if (!(draws > 0 && pdf_total > 0)) return {};
        ShownFault best{.kind = Kind::cell};
        const auto try_cell = [&](std::size_t i0, std::size_t i1, std::size_t j0, std::size_t j1) {
            double s = 0, q = 0, variance = 0;
            for (std::size_t i = i0; i < i1; ++i)
                for (std::size_t j = j0; j < j1; ++j) {
                    s += draw_counts[i][j] / draws;
                    q += pdf_sums[i][j] / pdf_total;
                    variance += pdf_squares[i][j] / (pdf_total * pdf_total);
                }
            const double error = std::sqrt(std::max(s, 1 / draws) / draws + variance);
            if (!differ(s, q, error) || std::fabs(s - q) <= best.size) return;
            const auto cosine = [&](std::size_t i) {
                return lowest() + (1 - lowest()) * static_cast<double>(i) / static_cast<double>(parts);
            };
            const double sector = 360.0 / parts;
            best.size = std::fabs(s - q);
            best.cell = {.from_cos = cosine(i0),
                .to_cos = cosine(i1),
                .from_phi = static_cast<double>(j0) * sector,
                .to_phi = static_cast<double>(j1) * sector};
        };
        for (std::size_t i = 0; i < parts; ++i) {
            try_cell(i, i + 1, 0, parts);
            try_cell(0, parts, i, i + 1);
            for (std::size_t j = 0; j < parts; ++j) try_cell(i, i + 1, j, j + 1);
        }
        return best.size > 0 ? std::optional(best) : std::nullopt;
    }
    std::optional<ShownFault> find_two_pdfs() const {
        if (!traits_.has_pdf) return {};
        double size = 0;
        const auto has_two_pdfs = [&](const Draw& d) {
            if (!(d.pdf > 0) || !usable(d)) return false;
            const double p = pdf(std::span(&d.wi, 1))[0];
            size = std::fabs(p - d.pdf) / d.pdf;
            return size > rounding;
        };
        const std::vector<PrimarySample> u = numbers();
        const auto match = shortest_u(std::span(u).first(1024), has_two_pdfs);
        if (!match) return {};
        return ShownFault{.kind = Kind::two_pdfs, .size = size, .u = *match};
    }
    std::optional<ShownFault> find_physics() const {
        if (!sampler_.has_f()) return {};
        for (int c = 0; c < traits_.channels; ++c) {
            const Mean reflected = power(c);
            if (!traits_.eta && reflected.value - 1 > clear_errors * reflected.error)
                return ShownFault{.kind = Kind::energy, .size = reflected.value - 1, .channel = c};
        }
        if (!traits_.reciprocal) return {};
        const std::vector<Vec3d> w = directions();
        std::vector<Pair> pairs, swapped_pairs;
        for (std::size_t i = 0; i + 1 < w.size(); i += 2)
            if (w[i].z > 0.05 && w[i + 1].z > 0.05) {
                pairs.push_back({w[i], w[i + 1]});
                swapped_pairs.push_back({w[i + 1], w[i]});
            }
        const std::vector<Vec3d> values = f(pairs), swapped_values = f(swapped_pairs);
        std::optional<ShownFault> best;
        for (std::size_t i = 0; i < pairs.size(); ++i)
            for (int c = 0; c < traits_.channels; ++c) {
                const double a = channel_of(values[i], c), b = channel_of(swapped_values[i], c);
                const double size = std::fabs(a - b) / std::max({std::fabs(a), std::fabs(b), 1e-6});
                if (size < 10 * rounding || (best && size <= best->size)) continue;
                best = {.kind = Kind::not_reciprocal,
                    .size = size,
                    .a = angles_of(pairs[i].wo),
                    .b = angles_of(pairs[i].wi),
                    .channel = c};
            }
        if (!best) return {};
        for (const double step : {15.0, 5.0, 1.0, 0.1}) {
            const auto round = [step](double x) { return std::round(x / step) * step; };
            const Angles a{round(best->a.theta), round(best->a.phi)}, b{round(best->b.theta), round(best->b.phi)};
            const Pair pair{a.direction(), b.direction()}, swapped_pair{b.direction(), a.direction()};
            const double x = channel_of(f(std::span(&pair, 1))[0], best->channel),
                         y = channel_of(f(std::span(&swapped_pair, 1))[0], best->channel);
            if (std::fabs(x - y) < kept_size * best->size * std::max(std::fabs(x), std::fabs(y)) || a.theta >= 90 ||
                b.theta >= 90 || x == y)
                continue;
            best->a = a;
            best->b = b;
            break;
        }
        return best;
    }
    std::optional<ShownFault> find_mean() const {
        if (!sampler_.has_f() || traits_.delta) return {};
        std::optional<ShownFault> fault;
        if (traits_.has_pdf && !traits_.reciprocal_weight) fault = find_mean_by_pdf();
        return fault ? fault : find_mean_of_weights();
    }
    std::optional<ShownFault> find_mean_by_pdf() const {
        std::vector<double> weights;
        std::vector<Vec3d> wi;
        const std::vector<Draw> draws = draw(numbers());
        for (const Draw& d : draws) wi.push_back(d.pdf > 0 ? d.wi : Vec3d{0, 0, 1});
        const std::vector<Vec3d> f_values = f(wi);
        for (std::size_t i = 0; i < wi.size(); ++i)
            weights.push_back(draws[i].pdf > 0 ? f_values[i].x * std::fabs(wi[i].z) / draws[i].pdf : 0);
        const Mean integral = power(0), mean(weights);
        if (!differ(integral.value, mean.value, std::hypot(integral.error, mean.error))) return {};
        return ShownFault{.kind = Kind::mean, .size = std::fabs(integral.value - mean.value)};
    }
    /// The weights of the draws against the integral of f cos; W times the target against the integral of the target.
    std::optional<ShownFault> find_mean_of_weights() const {
        const std::vector<Draw> draws = draw(numbers());
        if (std::ranges::none_of(draws, [](const Draw& d) { return d.weight.has_value(); })) return {};
        std::vector<Pair> pairs;
        for (const Draw& d : draws) pairs.push_back({wo_, d.pdf > 0 ? d.wi : Vec3d{0, 0, 1}});
        std::vector<double> factors(pairs.size(), 1);
        if (traits_.reciprocal_weight) {
            // The adapter returns W times a bounded function of the target, which is its f.
            std::vector<double> bounded(pairs.size());
            sampler_.target(pairs, factors);
            sampler_.f(pairs, bounded);
            for (std::size_t i = 0; i < factors.size(); ++i) factors[i] = bounded[i] > 0 ? factors[i] / bounded[i] : 0;
        }
        std::vector<double> values(pairs.size());
        for (std::size_t i = 0; i < values.size(); ++i)
            if (draws[i].pdf > 0 && draws[i].weight)
                values[i] = factors[i] * (traits_.channels == 3 ? draws[i].weights.x : *draws[i].weight);
        const auto evaluate_target = [&](std::span<const Vec3d> w) {
            std::vector<Pair> target_pairs;
            for (const Vec3d v : w) target_pairs.push_back({wo_, v});
            std::vector<double> out(w.size());
            sampler_.target(target_pairs, out);
            return out;
        };
        const Mean integral = traits_.reciprocal_weight ? integrate(false, evaluate_target) : power(0), mean(values);
        if (!differ(integral.value, mean.value, std::hypot(integral.error, mean.error))) return {};
        return ShownFault{.kind = Kind::weights, .size = std::fabs(integral.value - mean.value)};
    }

    const SamplerAdapter& sampler_;
    Traits traits_;
    bool hemisphere_;
    Vec3d wo_;
};

/// Rounder angles of the same side of the surface, the roundest first; then the given ones.
std::vector<Angles> rounder(Angles worst) {
    std::vector<Angles> out;
    for (const double step : {90.0, 45.0, 30.0, 15.0, 10.0, 5.0, 1.0})
        for (const double phi_step : {360.0, 90.0, 45.0, 10.0, 1.0}) {
            const Angles a{
                std::round(worst.theta / step) * step, std::fmod(std::round(worst.phi / phi_step) * phi_step, 360.0)};
            if (std::fabs(a.theta - 90) >= 1 && (a.theta < 90) == (worst.theta < 90)) out.push_back(a);
        }
    out.push_back(worst);
    return out;
}

Reach reach_program(const std::string& program) {
    const Handshake hello = handshake_with(program);
    Reach out{.hemisphere = hello.hemisphere, .lines = {}};
    out.is_reservoir = hello.traits.reciprocal_weight;
    out.lines = ask_lines(hello, program, 4 + (hello.weight && !out.is_reservoir ? 1 : 0));
    const auto verb = [&](const char* line, const char* block) { return hello.blocks() ? block : line; };
    out.lines += fmt::format(
        "\n\ndef sample(wo, u): a = ask('{}', wo, u); return a[:, :3], a[:, 3]\n"
        "def pdf(wo, wi): return ask('{}', wo, wi)[:, 0]\n"
        "def f(wo, wi): return ask('{}', wo, wi){}\n",
        verb("sample", "smpl"), verb("pdf", "pdf_"), verb("f", "f___"), hello.f_cos ? " / np.abs(wi[:, 2:])" : "");
    out.lines +=
        fmt::format(fmt::runtime(out.is_reservoir
                            ? "def target(wo, wi): return ask('{1}', wo, wi)[:, 0]\n"
                              "def weigh(wo, u): a = ask('{0}', wo, u); return a[:, 3] * target(wo, a[:, :3])\n"
                            : "def weigh(wo, u): a = ask('{0}', wo, u); return np.where(a[:, 3] > 0, a[:, 4], 0)\n"),
            verb("sample", "smpl"), verb("target", "trgt"));
    return out;
}

/// `word`: FILE.py, FILE.py:NAME or module:NAME.
Reach reach_python(const std::string& word, const Traits& traits) {
    Reach out{.is_reservoir = traits.reciprocal_weight, .lines = import_lines(word)};
    const char* wo_argument = traits.wo == Traits::WoDomain::none ? "" : "wo, ";
    out.lines += fmt::format(
        "\n\ndef sample(wo, u): return sampler.sample({0}u)[:2]\n"
        "def pdf(wo, wi): return sampler.pdf({0}wi)\n"
        "def f(wo, wi): return np.reshape(sampler.f({0}wi), (len(wi), -1))\n",
        wo_argument);
    out.lines += fmt::format(
        fmt::runtime(out.is_reservoir ? "def target(wo, wi): return sampler.target({0}wi)\n"
                                        "def weigh(wo, u): wi, w = sampler.sample({0}u); return w * target(wo, wi)\n"
                                      : "def weigh(wo, u): _, p, w = sampler.sample({0}u); "
                                        "return np.where(p > 0, w.reshape(len(u), -1)[:, 0], 0)\n"),
        wo_argument);
    return out;
}

std::string at_text(Angles a) { return fmt::format("at({:.9g}, {:.9g})", a.theta, a.phi); }

/// The lines that show the fault: they print what was expected and what is, and set `wrong`.
std::string lines_of(const ShownFault& fault, const Reach& reach, int numbers) {
    using Kind = ShownFault::Kind;
    std::string u = "np.array([[";
    for (int k = 0; k < numbers; ++k) u += fmt::format("{}{:.9g}", k > 0 ? ", " : "", fault.u[k]);
    u += "]])";
    const auto directions = [](const char* z) {
        return fmt::format(
            "z, phi = {}, rng.uniform(0, 2 * np.pi, n)\n"
            "w = np.stack([np.sqrt(1 - z**2) * np.cos(phi), np.sqrt(1 - z**2) * np.sin(phi), z], -1)\n",
            z);
    };
    const std::string uniform = directions("rng.random(n)"), cosine = directions("np.sqrt(rng.random(n))");
    // The sum over both sides of the surface, or one side alone.
    const auto sum_sides = [&](const std::string& value) {
        return reach.hemisphere
            ? fmt::format(fmt::runtime(value), "w")
            : "sum(" + fmt::format(fmt::runtime(value), "w * [1, 1, side]") + " for side in (1, -1))";
    };
    const std::string power =
        fmt::format("x = np.pi * {}\n", sum_sides(fmt::format("f(wo, {{}})[:, {}]", fault.channel)));
    const std::string setup =
        fmt::format("n, rng = {}, np.random.default_rng(1)\nwo = np.repeat(wo, n, 0)\n", evaluations);
    const std::string draws = fmt::format("wi, p = sample(wo, rng.random((n, {}), np.float32).astype(float))\n{}",
        numbers, reach.hemisphere ? "p = np.where(wi[:, 2] > 0, p, 0)\n" : "");
    switch (fault.kind) {
        case Kind::bad_draw:
            return fmt::format(
                "wi, p = sample(wo, {})\n"
                "print('w_i', wi[0], 'of length', np.linalg.norm(wi[0]), 'pdf', p[0])\n"
                "wrong = not (0 <= p[0] < np.inf and abs(np.linalg.norm(wi[0]) - 1) < {:g})\n",
                u, rounding);
        case Kind::bad_pdf:
            return fmt::format(
                "p = pdf(wo, {})[0]\nprint('pdf', p, 'expected a number >= 0')\nwrong = not 0 <= p < np.inf\n",
                at_text(fault.a));
        case Kind::bad_f:
            return fmt::format(
                "x = f(wo, {})[0, {}]\nprint('f', x, 'expected a number >= 0')\nwrong = not 0 <= x < np.inf\n",
                at_text(fault.a), fault.channel);
        case Kind::dark:
            return fmt::format(
                "w = {}\nprint('f cos', f(wo, w)[0] * abs(w[0, 2]), 'and pdf', pdf(wo, w)[0])\n"
                "wrong = pdf(wo, w)[0] == 0 and f(wo, w)[0, 0] > 0\n",
                at_text(fault.a));
        case Kind::two_pdfs:
            return fmt::format(
                "wi, p = sample(wo, {})\nq = pdf(wo, wi)\n"
                "print('pdf of the draw', p[0], 'and pdf(w_i)', q[0], 'expected the same')\n"
                "wrong = abs(p[0] - q[0]) > {:g} * p[0]\n",
                u, rounding);
        case Kind::not_reciprocal:
            return fmt::format(
                "a, b = {}, {}\nx, y = f(a, b)[0, {}], f(b, a)[0, {}]\n"
                "print('f(a, b)', x, 'and f(b, a)', y, 'expected the same')\n"
                "wrong = abs(x - y) > {:g} * max(abs(x), abs(y))\n",
                at_text(fault.a), at_text(fault.b), fault.channel, fault.channel, rounding);
        case Kind::integral:
            return setup + uniform + draws +
                fmt::format(
                    "x = 2 * np.pi * {}\n"
                    "error = np.hypot(x.std(), 0.5) / n**0.5\n"
                    "print('pdf integrates to', x.mean(), '+-', error)\n"
                    "print('samples that draw a direction:', np.mean(p > 0))\n"
                    "wrong = abs(x.mean() - np.mean(p > 0)) > 5 * error\n",
                    sum_sides("pdf(wo, {})"));
        case Kind::cell:
            return setup + uniform + (reach.hemisphere ? "" : "w[:, 2] *= rng.choice([-1, 1], n)\n") + draws +
                fmt::format(
                    "def inside(w):\n"
                    "    phi = np.degrees(np.arctan2(w[:, 1], w[:, 0])) % 360\n"
                    "    return (w[:, 2] >= {:g}) & (w[:, 2] <= {:g}) & (phi >= {:g}) & (phi <= {:g})\n"
                    "q = pdf(wo, w) / np.sum(pdf(wo, w))\n"
                    "x, y = np.mean(inside(wi[p > 0])), np.sum(q * inside(w))\n"
                    "print('in this part: of the draws', x, 'and of pdf', y)\n"
                    "wrong = abs(x - y) > 5 * np.hypot((max(x, 1 / n) / n)**0.5, np.sum((q * inside(w))**2)**0.5)\n",
                    fault.cell.from_cos, fault.cell.to_cos, fault.cell.from_phi, fault.cell.to_phi);
        case Kind::energy:
            return setup + cosine + power +
                "print('reflects', x.mean(), '+-', x.std() / n**0.5, 'expected at most 1')\n"
                "wrong = x.mean() - 1 > 5 * x.std() / n**0.5\n";
        case Kind::mean:
            return setup + cosine + draws + power +
                "wi = np.where(p[:, None] > 0, wi, [0, 0, 1])\n"
                "y = np.where(p > 0, f(wo, wi)[:, 0] * np.abs(wi[:, 2]) / np.where(p > 0, p, 1), 0)\n"
                "print('integral of f cos', x.mean(), 'and mean of the weights', y.mean())\n"
                "wrong = abs(x.mean() - y.mean()) > 5 * np.hypot(x.std(), y.std()) / n**0.5\n";
        case Kind::weights:
            return setup + (reach.is_reservoir ? uniform : cosine) +
                (reach.is_reservoir ? fmt::format("x = 2 * np.pi * {}\n", sum_sides("target(wo, {})")) : power) +
                fmt::format(
                    "y = weigh(wo, rng.random((n, {}), np.float32).astype(float))\n"
                    "print('integral of {}', x.mean(), 'and mean of the weights', y.mean())\n"
                    "wrong = abs(x.mean() - y.mean()) > 5 * np.hypot(x.std(), y.std()) / n**0.5\n",
                    numbers, reach.is_reservoir ? "the target" : "f cos");
    }
    return "";
}

}  // namespace

std::optional<std::string> repro_script(
    const CheckFlags& flags, std::span<const CheckCase> check_cases, const CheckResult& result) {
    if (!check_cases.empty() && check_cases[0].adapter->traits().number)
        return script_of_number(flags, *check_cases[0].adapter, result);
    std::optional<Reach> reach;
    for (const Finding& finding : findings_of(result)) {
        if (finding.state != State::wrong) continue;
        const auto worst = std::ranges::find(check_cases, finding.worst->check_case, &CheckCase::text);
        if (worst == check_cases.end()) continue;
        const SamplerAdapter& sampler = *worst->adapter;
        const Traits traits = sampler.traits();
        if (traits.neighbours > 0) continue;  // a script has no neighbours
        if (traits.domain) {
            if (std::optional<std::string> script = script_of_points(flags, *worst, finding)) return script;
            continue;
        }
        if (!reach) reach = flags.exec().empty() ? reach_python(flags.arm, traits) : reach_program(flags.exec());
        const auto fault = Bench(sampler, reach->hemisphere, worst->wo).find(finding.name);
        if (!fault) continue;
        Angles wo = angles_of(worst->wo);
        ShownFault shown_fault = *fault;
        for (const Angles& angles : rounder(wo)) {
            const auto round_fault = Bench(sampler, reach->hemisphere, angles.direction()).find(finding.name);
            if (!round_fault || round_fault->size < kept_size * fault->size) continue;
            wo = angles;
            shown_fault = *round_fault;
            break;
        }
        const std::string script = lines_of(shown_fault, *reach, traits.numbers);
        return fmt::format(
            "# {}: {}\n{}\n\n"
            "def at(theta, phi):  # degrees from n = +z, and about it from x\n"
            "    t, p = np.radians([theta, phi])\n"
            "    return np.array([[np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), np.cos(t)]])\n\n\n"
            "wo = {}\n{}sys.exit('wrong' if wrong else 0)\n",
            finding.name, printable(finding.worst->first_sentence()), without_unused(reach->lines, script), at_text(wo),
            script);
    }
    return {};
}

namespace {

std::string why_not_shown(const CheckFlags& flags, const Traits& traits, std::string_view verdict) {
    const bool uses_draws_alone = verdict == "valid" || verdict == "physics";
    if (traits.number && verdict == "mean" && flags.estimates.empty())
        return "a script compares with a known value (--estimates), not with another estimator";
    if (traits.neighbours > 0)
        return fmt::format(
            "a draw merges the reservoirs of {} neighbours, which a script cannot supply", traits.neighbours);
    if (traits.reciprocal_weight && traits.domain)
        return "the weight of a draw is random and estimates 1/p; a script compares such weights of directions only";
    if (!traits.has_pdf && !uses_draws_alone && (verdict != "mean" || traits.domain))
        return "the sampler has no pdf that a script could compare the draws with";
    if (traits.delta && verdict == "mean") return "some draws belong to delta parts, which a script does not weigh";
    return "it does not show in 65,536 draws and points";
}

}  // namespace

std::string why_no_repro(const CheckFlags& flags, std::span<const CheckCase> check_cases, const CheckResult& result) {
    std::vector<std::pair<std::string, std::string>> reasons;  // verdicts in a row with the same reason
    for (const Finding& finding : findings_of(result)) {
        if (finding.state != State::wrong) continue;
        const auto worst = std::ranges::find(check_cases, finding.worst->check_case, &CheckCase::text);
        std::string reason = worst == check_cases.end() ? "it is a result of all w_o together, and a script has one"
                                                        : why_not_shown(flags, worst->adapter->traits(), finding.name);
        if (!reasons.empty() && reasons.back().second == reason) reasons.back().first += ", " + finding.name;
        else reasons.emplace_back(finding.name, std::move(reason));
    }
    std::string out;
    for (const auto& [names, reason] : reasons) out += fmt::format("{}{}: {}", out.empty() ? "" : "; ", names, reason);
    return out.empty() ? "no verdict is wrong" : out;
}

}  // namespace crescent::cli
