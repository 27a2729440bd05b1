// As for directions, the fault is measured again by means over random points of the domain and draws, or at a single
// draw. Points of an infinite line are far from its end by t / (1 - t) times the median distance of the draws.
#include "repro_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "check.h"
#include "repro_numbers.h"
#include "repro_reach.h"

namespace crescent::cli {

namespace {
namespace of_points {

using Kind = DomainPart::Kind;
using Point = std::array<double, Domain::most_coordinates>;
constexpr std::size_t count = 1u << 16;  // draws, and points
constexpr double clear_errors = 6;       // standard errors: hundreds of shares are compared
constexpr double rounding = 1e-3;        // relative: a difference that single precision does not explain

/// The place and the scale of the draws on an infinite line.
struct LineScale {
    double origin = 0, scale = 1;
};

/// Points of one part of a domain with the reciprocal of their density, here and as Python.
struct UniformPart {
    DomainPart part;
    LineScale line;

    /// Appends the coordinates of a point; returns 1 / density.
    double add(RandomBits& random, std::span<double> to) const {
        const double u = uniform(random);
        const auto direction = [&](double z) {
            const double phi = 2 * pi * uniform(random), r = std::sqrt(1 - z * z);
            to[0] = r * std::cos(phi);
            to[1] = r * std::sin(phi);
            to[2] = z;
        };
        switch (part.kind) {
            case Kind::hemisphere: direction(u); return 2 * pi;
            case Kind::sphere: direction(2 * u - 1); return 4 * pi;
            case Kind::disk: {
                const double r = std::sqrt(u), phi = 2 * pi * uniform(random);
                to[0] = r * std::cos(phi);
                to[1] = r * std::sin(phi);
                return pi;
            }
            case Kind::square:
            case Kind::cube:
                for (std::size_t k = 0; k < part.coordinates(); ++k) to[k] = uniform(random);
                return 1;
            case Kind::triangle: {
                const double s = std::sqrt(u);
                to[0] = 1 - s;
                to[1] = s * uniform(random);
                return 0.5;
            }
            case Kind::set: to[0] = std::min(std::floor(u * part.count), part.count - 1.0); return part.count;
            case Kind::line: break;
        }
        if (!part.is_infinite()) {
            to[0] = part.from + (part.to - part.from) * u;
            return part.to - part.from;
        }
        if (std::isfinite(part.from) || std::isfinite(part.to)) {
            const double distance = line.scale * u / (1 - u);
            to[0] = std::isfinite(part.from) ? part.from + distance : part.to - distance;
            return line.scale / ((1 - u) * (1 - u));
        }
        const double t = std::tan(pi * (u - 0.5));
        to[0] = line.origin + line.scale * t;
        return line.scale * pi * (1 + t * t);
    }

    /// Statements that set names ending with this suffix; then the columns of the points, and 1 / density.
    struct Lines {
        std::string statements, columns, weight;
    };
    Lines lines(const std::string& suffix) const {
        const auto name = [&](const char* letter) { return letter + suffix; };
        const std::string r = name("r"), t = name("t"), z = name("z"), angle = "2 * np.pi * rng.random(n)";
        const auto direction = [&](const std::string& heights, const char* area) {
            return Lines{fmt::format("{}, {} = {}, {}\n{} = np.sqrt(1 - {}**2)\n", z, t, heights, angle, r, z),
                fmt::format("{0} * np.cos({1}), {0} * np.sin({1}), {2}", r, t, z), area};
        };
        switch (part.kind) {
            case Kind::hemisphere: return direction("rng.random(n)", "2 * np.pi");
            case Kind::sphere: return direction("rng.uniform(-1, 1, n)", "4 * np.pi");
            case Kind::disk:
                return {fmt::format("{}, {} = np.sqrt(rng.random(n)), {}\n", r, t, angle),
                    fmt::format("{0} * np.cos({1}), {0} * np.sin({1})", r, t), "np.pi"};
            case Kind::square: return {"", "rng.random(n), rng.random(n)", "1"};
            case Kind::cube: return {"", "rng.random(n), rng.random(n), rng.random(n)", "1"};
            case Kind::triangle:
                return {fmt::format("{} = np.sqrt(rng.random(n))\n", r), fmt::format("1 - {0}, {0} * rng.random(n)", r),
                    "0.5"};
            case Kind::set:
                return {"", fmt::format("rng.integers({}, size=n)", part.count), std::to_string(part.count)};
            case Kind::line: break;
        }
        if (!part.is_infinite())
            return {
                "", fmt::format("rng.uniform({}, {}, n)", part.from, part.to), fmt::format("{}", part.to - part.from)};
        if (std::isfinite(part.from) || std::isfinite(part.to))
            return {fmt::format("{} = rng.random(n)\n", t),
                std::isfinite(part.from)
                    ? fmt::format("{} + {} * {t} / (1 - {t})", part.from, line.scale, fmt::arg("t", t))
                    : fmt::format("{} - {} * {t} / (1 - {t})", part.to, line.scale, fmt::arg("t", t)),
                fmt::format("{} / (1 - {})**2", line.scale, t)};
        return {fmt::format("{} = np.tan(np.pi * (rng.random(n) - 0.5))\n", t),
            fmt::format("{} + {} * {}", line.origin, line.scale, t),
            fmt::format("{} * np.pi * (1 + {}**2)", line.scale, t)};
    }
};

/// An interval of one coordinate.
struct Band {
    std::size_t coordinate = 0;
    double from = 0, to = 0;
    bool has(const Point& x) const { return x[coordinate] >= from && x[coordinate] <= to; }
};

/// Draws and points of a sampler at one w_o.
class PointBench {
public:
    PointBench(const SamplerAdapter& sampler, Vec3d wo)
        : sampler_(sampler), traits_(sampler.traits()), chart_(*traits_.domain), wo_(wo) {
        draw();
        make_points();
    }

    /// The lines that show the fault of a verdict; "" if it does not show.
    std::string lines(const std::string& verdict) const {
        if (verdict == "valid") return lines_of_invalid();
        if (!traits_.has_pdf) return "";
        if (verdict == "normalised") return lines_of_integral();
        if (verdict == "identity") return lines_of_two_pdfs();
        if (verdict == "density") return lines_of_bands();
        if (verdict == "support") return lines_of_dark();
        if (verdict == "mean") return lines_of_mean();
        return "";
    }

private:
    const SamplerAdapter& sampler_;
    Traits traits_;
    const DomainChart& chart_;
    Vec3d wo_;
    std::vector<PrimarySample> u_;
    std::vector<Draw> draws_;
    std::vector<Point> draw_points_, points_;  // of the draws that are points; random ones
    std::vector<double> p_of_draws_;           // of the draws, with them
    std::vector<double> p_, reciprocal_;       // p of the points, and 1 / their own density
    std::vector<UniformPart> parts_;

    std::size_t coordinates() const { return chart_.domain().coordinates(); }
    std::span<const double> coordinates_of(const Point& x) const { return std::span(x).first(coordinates()); }
    const char* wo_argument() const { return traits_.wo == Traits::WoDomain::none ? "" : "wo, "; }
    const char* repeated_wo() const { return traits_.wo == Traits::WoDomain::none ? "" : "wo.repeat(n, 0), "; }

    void draw() {
        RandomBits random(1);
        u_.resize(count);
        for (PrimarySample& u : u_) u = random_numbers(random, traits_.numbers);
        draws_.resize(count);
        sampler_.sample(0, wo_, u_, draws_);
        for (const Draw& d : draws_) {
            if (!(d.pdf > 0) || !std::isfinite(d.pdf + dot(d.wi, d.wi))) continue;
            draw_points_.emplace_back();
            const double factor = chart_.point(d.wi, std::span(draw_points_.back()).first(coordinates()));
            p_of_draws_.push_back(d.pdf / factor);
        }
    }
    void make_points() {
        std::size_t coordinate = 0;
        for (const DomainPart& part : chart_.domain().parts()) {
            parts_.push_back({part, part.is_infinite() ? scale_of(part, coordinate) : LineScale{}});
            coordinate += part.coordinates();
        }
        RandomBits random(2);
        points_.resize(count);
        reciprocal_.assign(count, 1);
        for (std::size_t i = 0; i < count; ++i) {
            coordinate = 0;
            for (const UniformPart& part : parts_) {
                reciprocal_[i] *= part.add(random, std::span(points_[i]).subspan(coordinate, part.part.coordinates()));
                coordinate += part.part.coordinates();
            }
        }
        p_ = densities(points_);
    }
    /// To two digits, for the script.
    LineScale scale_of(const DomainPart& part, std::size_t coordinate) const {
        std::vector<double> x;
        for (const Point& point : draw_points_) x.push_back(point[coordinate]);
        if (x.empty()) return {};
        const auto median = [&] {
            const auto middle = x.begin() + std::ssize(x) / 2;
            std::nth_element(x.begin(), middle, x.end());
            return *middle;
        };
        const auto round_digits = [](double v) { return v == 0 ? 0 : std::stod(fmt::format("{:.2g}", v)); };
        LineScale out;
        out.origin = std::isfinite(part.from) ? part.from : std::isfinite(part.to) ? part.to : round_digits(median());
        for (double& v : x) v = std::fabs(v - out.origin);
        out.scale = round_digits(median());
        if (!(out.scale > 0)) out.scale = 1;
        return out;
    }
    /// Calls a density or an integrand of directions at points of the domain.
    template <class Call> std::vector<double> over_points(std::span<const Point> points, const Call& call) const {
        constexpr std::array<double, Domain::most_dimensions + 1> middle = {0.5, 0.5, 0.5, 0.5, 0.5};
        std::vector<Pair> pairs;
        std::vector<double> factors, out(points.size());
        for (const Point& x : points) {
            const Vec3d w = chart_.direction(coordinates_of(x), std::span(middle).first(chart_.spreads()));
            Point image{};
            factors.push_back(chart_.point(w, std::span(image).first(coordinates())));
            pairs.push_back({wo_, w});
        }
        call(pairs, out);
        for (std::size_t i = 0; i < out.size(); ++i) out[i] /= factors[i];
        return out;
    }
    std::vector<double> densities(std::span<const Point> points) const {
        if (!traits_.has_pdf) return std::vector<double>(points.size());
        return over_points(points, [&](const auto& pairs, std::span<double> out) { sampler_.pdf(0, pairs, out); });
    }
    std::vector<double> integrands(std::span<const Point> points) const {
        return over_points(points, [&](const auto& pairs, std::span<double> out) { sampler_.f(pairs, out); });
    }

    std::string text_of_u(const PrimarySample& u) const {
        std::string out;
        for (int k = 0; k < traits_.own_numbers(); ++k) out += fmt::format("{}{:.9g}", k > 0 ? ", " : "", u[k]);
        return "np.array([[" + out + "]])";
    }
    PrimarySample shortest(const PrimarySample& u, const std::function<bool(const Draw&)>& holds) const {
        return with_few_digits(sampler_, wo_, u, traits_.own_numbers(), holds);
    }

    // ---- Lines of the script.

    std::string lines_of_draws() const {
        return fmt::format("n, rng = {}, np.random.default_rng(1)\nx, p = sample({}rng.random((n, {}){}))\n", count,
            repeated_wo(), traits_.own_numbers(), traits_.u_bits == 53 ? "" : ", np.float32).astype(float");
    }
    /// Random points y, and 1 / their density.
    std::string lines_of_points() const {
        std::string statements, columns, weight;
        for (std::size_t k = 0; k < parts_.size(); ++k) {
            const UniformPart::Lines part = parts_[k].lines(k > 0 ? std::to_string(k + 1) : "");
            statements += part.statements;
            columns += (k > 0 ? ", " : "") + part.columns;
            weight += (k > 0 ? " * " : "") + part.weight;
        }
        return statements + fmt::format("y, size = np.stack([{}], -1), {}\n", columns, weight);
    }
    /// A condition of Python that the points `x` are in the domain.
    std::string inside_domain() const {
        std::string out;
        std::size_t c = 0;
        for (const DomainPart& part : chart_.domain().parts()) {
            const std::string columns = fmt::format("x[:, {}:{}]", c, c + part.coordinates());
            out += out.empty() ? "" : " & ";
            switch (part.kind) {
                case Kind::hemisphere:
                case Kind::sphere: out += fmt::format("(abs(np.sum({}**2, 1) - 1) < 1e-4)", columns); break;
                case Kind::disk: out += fmt::format("(np.sum({}**2, 1) <= 1.00001)", columns); break;
                case Kind::triangle:
                    out += fmt::format("np.all({0} >= -1e-5, 1) & (np.sum({0}, 1) <= 1.00001)", columns);
                    break;
                case Kind::set:
                    out += fmt::format(
                        "np.all(({0} == np.floor({0})) & ({0} >= 0) & ({0} < {1}), 1)", columns, part.count);
                    break;
                case Kind::square:
                case Kind::cube: out += fmt::format("np.all(abs({} - 0.5) <= 0.50001, 1)", columns); break;
                case Kind::line: {
                    const auto end = [](double x) {
                        return std::isfinite(x) ? fmt::format("{}", x) : x < 0 ? "-np.inf" : "np.inf";
                    };
                    out += fmt::format("np.all(({0} >= {1}) & ({0} <= {2}), 1)", columns, end(part.from), end(part.to));
                }
            }
            c += part.coordinates();
        }
        return out;
    }
    std::string lines_of_invalid() const {
        const auto is_bad = [](const Draw& d) {
            return !(d.pdf >= 0) || !std::isfinite(d.pdf) || (d.pdf > 0 && !std::isfinite(dot(d.wi, d.wi)));
        };
        const auto bad_draw = std::ranges::find_if(draws_, is_bad);
        if (bad_draw != draws_.end()) {
            const PrimarySample u = shortest(u_[static_cast<std::size_t>(bad_draw - draws_.begin())], is_bad);
            return fmt::format(
                "x, p = sample({}{})\n"
                "print('the point', x[0], 'with the density', p[0])\n"
                "inside = {}\n"
                "wrong = not (0 <= p[0] < np.inf and (inside[0] or p[0] == 0))\n",
                wo_argument(), text_of_u(u), inside_domain());
        }
        const auto value = std::ranges::find_if(p_, [](double p) { return !(p >= 0) || !std::isfinite(p); });
        if (value == p_.end()) return "";
        const Point& x = points_[static_cast<std::size_t>(value - p_.begin())];
        return fmt::format(
            "p = pdf({}np.array([[{:.17g}]]))[0]\nprint('pdf', p, 'expected a number >= 0')\n"
            "wrong = not 0 <= p < np.inf\n",
            wo_argument(), fmt::join(coordinates_of(x), ", "));
    }
    std::string lines_of_integral() const {
        std::vector<double> x(count);
        for (std::size_t i = 0; i < count; ++i) x[i] = p_[i] * reciprocal_[i];
        const double share = static_cast<double>(draw_points_.size()) / static_cast<double>(count);
        const auto [mean, error] = mean_of(x);
        if (!(std::fabs(mean - share) > clear_errors * std::hypot(error, 0.5 / std::sqrt(static_cast<double>(count)))))
            return "";
        return lines_of_draws() + lines_of_points() +
            fmt::format(
                "q = pdf({}y) * size\nerror = np.hypot(q.std(), 0.5) / n**0.5\n"
                "print('pdf integrates to', q.mean(), '+-', error)\n"
                "print('samples that draw a point:', np.mean(p > 0))\n"
                "wrong = abs(q.mean() - np.mean(p > 0)) > 5 * error\n",
                repeated_wo());
    }
    std::string lines_of_two_pdfs() const {
        const std::size_t draw_count = std::min<std::size_t>(draws_.size(), 1024);
        const auto differs = [&](const Draw& d) {
            if (!(d.pdf > 0) || !std::isfinite(d.pdf + dot(d.wi, d.wi))) return false;
            const Pair pair{wo_, d.wi};
            double p = 0;
            sampler_.pdf(0, {&pair, 1}, {&p, 1});
            return std::fabs(p - d.pdf) > rounding * d.pdf;
        };
        for (std::size_t i = 0; i < draw_count; ++i)
            if (differs(draws_[i]))
                return fmt::format(
                    "x, p = sample({0}{1})\nq = pdf({0}x)\n"
                    "print('pdf of the draw', p[0], 'and pdf(x)', q[0], 'expected the same')\n"
                    "wrong = abs(p[0] - q[0]) > {2:g} * p[0]\n",
                    wo_argument(), text_of_u(shortest(u_[i], differs)), rounding);
        return "";
    }
    /// Entries of a set, or intervals with equal shares of the draws.
    std::vector<Band> bands_of(std::size_t coordinate, bool set, std::size_t parts) const {
        std::vector<Band> out;
        std::vector<double> x;
        for (const Point& point : draw_points_) x.push_back(point[coordinate]);
        std::ranges::sort(x);
        constexpr std::size_t most_entries = 4096;
        if (set) {
            for (std::size_t i = 0; i < x.size() && out.size() < most_entries; ++i)
                if (i == 0 || x[i] != x[i - 1]) out.push_back({coordinate, x[i], x[i]});
            return out;
        }
        const auto quantile = [&](std::size_t k) {
            return std::stod(fmt::format("{:.3g}", x[std::min(k * x.size() / parts, x.size() - 1)]));
        };
        for (std::size_t k = 0; k < parts && !x.empty(); ++k)
            if (const Band band{coordinate, quantile(k), quantile(k + 1)}; band.from < band.to) out.push_back(band);
        return out;
    }
    struct Shares {
        double draw_share = 0, pdf_share = 0, error = 0;
        double size() const { return std::fabs(draw_share - pdf_share); }
    };
    template <class Has> Shares shares(const Has& has) const {
        double draw_count = 0, sum = 0, total = 0, squares = 0;
        for (const Point& x : draw_points_) draw_count += has(x);
        for (std::size_t i = 0; i < count; ++i) {
            const double q = p_[i] * reciprocal_[i];
            total += q;
            if (has(points_[i])) {
                sum += q;
                squares += q * q;
            }
        }
        const auto n = static_cast<double>(draw_points_.size());
        if (!(n > 0 && total > 0)) return {};
        const double draw_share = draw_count / n, pdf_share = sum / total;
        return {
            draw_share, pdf_share, std::sqrt(std::max({draw_share, pdf_share, 1 / n}) / n + squares / (total * total))};
    }
    std::string lines_of_bands() const {
        std::vector<std::vector<Band>> single, coarse;
        std::size_t c = 0;
        for (const DomainPart& part : chart_.domain().parts())
            for (std::size_t k = 0; k < part.coordinates(); ++k, ++c) {
                single.push_back(bands_of(c, part.kind == Kind::set, 16));
                coarse.push_back(bands_of(c, part.kind == Kind::set && part.count <= 16, 4));
            }
        std::vector<Band> best;
        double size = 0;
        const auto try_bands = [&](std::vector<Band> bands) {
            const Shares s = shares(
                [&](const Point& x) { return std::ranges::all_of(bands, [&](const Band& b) { return b.has(x); }); });
            if (s.size() < size || !(s.size() > clear_errors * s.error)) return;
            size = s.size();
            best = std::move(bands);
        };
        for (const auto& bands : single)
            for (const Band& band : bands) try_bands({band});
        for (std::size_t i = 0; i < coarse.size() && best.empty(); ++i)
            for (std::size_t j = i + 1; j < coarse.size(); ++j)
                for (const Band& a : coarse[i])
                    for (const Band& b : coarse[j]) try_bands({a, b});
        if (best.empty()) return "";
        std::string condition;
        for (const Band& b : best)
            condition += (condition.empty() ? "" : " & ") +
                (b.from == b.to ? fmt::format("(x[:, {}] == {})", b.coordinate, b.from)
                                : fmt::format("(x[:, {0}] >= {1}) & (x[:, {0}] <= {2})", b.coordinate, b.from, b.to));
        return lines_of_draws() + lines_of_points() +
            fmt::format(
                "inside = lambda x: {}\n"
                "q = pdf({}y) * size\nq /= q.sum()\n"
                "a, b = np.mean(inside(x[p > 0])), np.sum(q * inside(y))\n"
                "print('in this part: of the draws', a, 'and of pdf', b)\n"
                "wrong = abs(a - b) > 5 * np.hypot((max(a, b, 1 / n) / n)**0.5, np.sum((q * inside(y))**2)**0.5)\n",
                condition, repeated_wo());
    }
    std::string lines_of_dark() const {
        if (!sampler_.has_f()) return "";
        const std::vector<double> f = integrands(points_);
        for (std::size_t i = 0; i < count; ++i)
            if (p_[i] == 0 && f[i] > 0)
                return fmt::format(
                    "x = np.array([[{1:.6g}]])\nprint('f', f({0}x)[0], 'and pdf', pdf({0}x)[0])\n"
                    "wrong = pdf({0}x)[0] == 0 and f({0}x)[0] > 0\n",
                    wo_argument(), fmt::join(coordinates_of(points_[i]), ", "));
        return "";
    }
    static std::pair<double, double> mean_of(std::span<const double> x) {
        const auto n = static_cast<double>(x.size());
        double mean = 0, square = 0;
        for (const double v : x) mean += v / n;
        for (const double v : x) square += (v - mean) * (v - mean) / n;
        return {mean, std::sqrt(square / n)};
    }
    std::string lines_of_mean() const {
        if (!sampler_.has_f()) return "";
        std::vector<double> integral = integrands(points_), weights = integrands(draw_points_);
        for (std::size_t i = 0; i < count; ++i) integral[i] *= reciprocal_[i];
        for (std::size_t i = 0; i < weights.size(); ++i) weights[i] /= p_of_draws_[i];
        weights.resize(count);
        const auto [expected, error] = mean_of(integral);
        const auto [mean, error_of_mean] = mean_of(weights);
        if (!(std::fabs(mean - expected) > clear_errors * std::hypot(error, error_of_mean))) return "";
        return lines_of_draws() + lines_of_points() +
            fmt::format(
                "a, b = f({0}y) * size, np.zeros(n)\n"
                "b[p > 0] = (f({0}x) / p)[p > 0]\n"
                "print('integral of f', a.mean(), 'and mean of f / pdf', b.mean())\n"
                "wrong = abs(a.mean() - b.mean()) > 5 * np.hypot(a.std(), b.std()) / n**0.5\n",
                repeated_wo());
    }
};

std::string reach_lines(const CheckFlags& flags, const Traits& traits, std::size_t coordinates) {
    const char* wo_argument = traits.wo == Traits::WoDomain::none ? "" : "wo, ";
    if (flags.exec().empty())
        return import_lines(flags.arm) +
            fmt::format(
                "\n\ndef sample({0}u): x, p = sampler.sample({0}u)[:2]; return np.reshape(x, (len(u), -1)), "
                "np.broadcast_to(p, len(u))\n"
                "def pdf({0}x): return np.broadcast_to(sampler.pdf({0}x{1}), len(x))\n"
                "def f({0}x): return np.reshape(sampler.f({0}x{1}), (len(x), -1))[:, 0]\n",
                wo_argument, coordinates == 1 ? "[:, 0]" : "");
    const Handshake hello = handshake_with(flags.exec());
    const auto verb = [&](const char* line, const char* block) { return hello.blocks() ? block : line; };
    return ask_lines(hello, flags.exec(), coordinates + 1) +
        fmt::format(
            "\n\ndef sample({0}u): a = ask('{1}', {0}u); return a[:, :{2}], a[:, {2}]\n"
            "def pdf({0}x): return ask('{3}', {0}x)[:, 0]\n"
            "def f({0}x): return ask('{4}', {0}x)[:, 0]\n",
            wo_argument, verb("sample", "smpl"), coordinates, verb("pdf", "pdf_"), verb("f", "f___"));
}

std::string script_of(const Finding& finding, const std::string& reach, const std::string& lines) {
    return fmt::format("# {}: {}\n{}\n\n{}sys.exit('wrong' if wrong else 0)\n", finding.name,
        printable(finding.worst->first_sentence()), without_unused(reach, lines), lines);
}

}  // namespace of_points
}  // namespace

std::optional<std::string> script_of_points(
    const CheckFlags& flags, const CheckCase& check_case, const Finding& finding) {
    const Traits traits = check_case.adapter->traits();
    if (traits.reciprocal_weight) return {};
    std::string lines = of_points::PointBench(*check_case.adapter, check_case.wo).lines(finding.name);
    if (lines.empty()) return {};
    const Vec3d wo = check_case.wo;
    if (traits.wo != Traits::WoDomain::none)
        lines = fmt::format("wo = np.array([[{:.9g}, {:.9g}, {:.9g}]])\n", wo.x, wo.y, wo.z) + lines;
    return of_points::script_of(
        finding, of_points::reach_lines(flags, traits, traits.domain->domain().coordinates()), lines);
}

std::optional<std::string> script_of_number(
    const CheckFlags& flags, const SamplerAdapter& estimator, const CheckResult& result) {
    const Traits traits = estimator.traits();
    const std::size_t channels = traits.channels == 3 ? 3 : 1;
    std::string reach;
    if (flags.exec().empty())
        reach = import_lines(flags.arm) + "\n\ndef sample(u): return np.reshape(sampler.sample(u), (len(u), -1))\n";
    else {
        const Handshake hello = handshake_with(flags.exec());
        reach = ask_lines(hello, flags.exec(), channels) +
            fmt::format("\n\ndef sample(u): return ask('{}', u)\n", hello.blocks() ? "smpl" : "sample");
    }
    const std::string draw_lines =
        fmt::format("rng = np.random.default_rng(1)\nvalues = sample(rng.random(({{}}, {}){}))\n", traits.numbers,
            traits.u_bits == 53 ? "" : ", np.float32).astype(float");
    constexpr std::size_t most_draws = 1u << 20;
    std::vector<PrimarySample> u;
    RandomBits random(1);
    for (const Finding& finding : findings_of(result)) {
        if (finding.state != State::wrong) continue;
        for (std::size_t n = 1u << 16; n <= most_draws; n *= 4) {
            while (u.size() < n) u.push_back(random_numbers(random, traits.numbers));
            std::vector<Draw> draws(n);
            estimator.sample(0, {0, 0, 1}, u, draws);
            bool has_bad_value = false;
            Vec3d mean{}, square{};
            for (const Draw& d : draws) {
                const Vec3d v = channels == 3 ? d.weights : Vec3d{d.weight.value_or(0), 0, 0};
                has_bad_value = has_bad_value || !std::isfinite(v.x + v.y + v.z);
                mean = mean + v * (1 / static_cast<double>(n));
                square = square + Vec3d{v.x * v.x, v.y * v.y, v.z * v.z} * (1 / static_cast<double>(n));
            }
            const bool is_validity = finding.name == "valid";
            if (is_validity && has_bad_value)
                return of_points::script_of(finding, reach,
                    fmt::format(fmt::runtime(draw_lines), n) +
                        "bad = ~np.isfinite(values).all(1)\nprint(bad.sum(), 'values are not finite')\nwrong = "
                        "bad.any()\n");
            if (is_validity || finding.name != "mean" || flags.estimates.empty()) continue;
            const std::array<double, 3> expected = expected_values(flags, traits.channels);
            for (std::size_t c = 0; c < channels; ++c) {
                const double x = channel_of(mean, static_cast<int>(c)), e = expected[c];
                const double error =
                    std::sqrt(std::max(channel_of(square, static_cast<int>(c)) - x * x, 0.0) / static_cast<double>(n));
                if (!(std::fabs(x - e) > of_points::clear_errors * error)) continue;
                return of_points::script_of(finding, reach,
                    fmt::format(fmt::runtime(draw_lines), 2 * n) +
                        fmt::format("x = values[:, {}]\nmean, error = x.mean(), x.std() / len(x)**0.5\n"
                                    "print('mean', mean, '+-', error, 'expected', {:.12g})\n"
                                    "wrong = abs(mean - {:.12g}) > 5 * error\n",
                            c, e, e));
            }
        }
    }
    return {};
}

}  // namespace crescent::cli
