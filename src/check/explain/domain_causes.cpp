// Candidate causes over domains other than directions. A move of the points, such as an exchange of two coordinates,
// gives the supposed density p(move(x)) times the change of measure.
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "check/explain/causes.h"
#include "math/functions.h"

namespace crescent::check {

namespace {

using Kind = DomainPart::Kind;
using Move = std::function<void(std::span<double>)>;
using Coordinates = std::array<double, Domain::most_coordinates>;

constexpr std::array symbols = {"x", "y", "z"};

/// Sets `out` to the density of points whose images by `move` have the density p. change: of the measure by it.
void moved_density(const SamplerAdapter& s, int technique, std::span<const Pair> pairs, std::span<double> out,
    const Move& move, double change) {
    const std::shared_ptr<const DomainChart> chart = s.traits().domain;
    const std::size_t count = chart->domain().coordinates();
    constexpr std::array<double, Domain::most_dimensions + 1> middle = {0.5, 0.5, 0.5, 0.5, 0.5};
    std::vector<Pair> images(pairs.begin(), pairs.end());
    std::vector<double> factor(pairs.size());
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        Coordinates x{}, again{};
        const std::span<double> point = std::span(x).first(count);
        factor[i] = change * chart->point(pairs[i].wi, point);
        move(point);
        if (!chart->domain().fault(point).empty()) {
            factor[i] = 0;
            continue;
        }
        images[i].wi = chart->direction(point, std::span(middle).first(chart->spreads()));
        const double image = chart->point(images[i].wi, std::span(again).first(count));
        factor[i] = image > 0 ? factor[i] / image : 0;
    }
    s.exact_pdf(technique, images, out);
    for (std::size_t i = 0; i < pairs.size(); ++i) out[i] *= factor[i];
}

/// The same with 0 where p is 0 and draws there count as no samples.
Hypothesis by_moving(std::string name, Move move, double change, bool at_zero) {
    Hypothesis h;
    h.name = std::move(name);
    h.density = [move = std::move(move), change, at_zero](
                    const SamplerAdapter& s, int technique, std::span<const Pair> pairs, std::span<double> out) {
        moved_density(s, technique, pairs, out, move, change);
        if (at_zero) return;
        std::vector<double> p(pairs.size());
        s.exact_pdf(technique, pairs, p);
        for (std::size_t i = 0; i < p.size(); ++i)
            if (!(p[i] > 0)) out[i] = 0;
    };
    return h;
}

struct NamedMove {
    std::string name;
    Move move;
};

void add_exchange(std::vector<NamedMove>& to, std::string name, std::size_t i, std::size_t j) {
    to.push_back({std::move(name), [=](std::span<double> x) { std::swap(x[i], x[j]); }});
}
void add_reflection(std::vector<NamedMove>& to, std::string name, std::size_t i, double sum) {
    to.push_back({std::move(name), [=](std::span<double> x) { x[i] = sum - x[i]; }});
}

/// Moves of one part that keep its measure; c: its first coordinate.
void add_moves(std::vector<NamedMove>& to, const DomainPart& part, std::size_t c) {
    const auto coordinate = [](std::size_t i) { return std::string(symbols[i]); };
    switch (part.kind) {
        case Kind::disk:
        case Kind::square:
        case Kind::cube:
            for (std::size_t i = 0; i < part.coordinates(); ++i) {
                for (std::size_t j = i + 1; j < part.coordinates(); ++j)
                    add_exchange(
                        to, "the coordinates " + coordinate(i) + " and " + coordinate(j) + " exchanged", c + i, c + j);
                add_reflection(to, coordinate(i) + " mirrored", c + i, part.kind == Kind::disk ? 0 : 1);
            }
            break;
        case Kind::triangle:
            add_exchange(to, "b0 and b1 exchanged", c, c + 1);
            to.push_back({"b0 and b2 exchanged", [c](std::span<double> b) { b[c] = 1 - b[c] - b[c + 1]; }});
            to.push_back({"b1 and b2 exchanged", [c](std::span<double> b) { b[c + 1] = 1 - b[c] - b[c + 1]; }});
            break;
        case Kind::line:
            if (std::isfinite(part.from) == std::isfinite(part.to))
                add_reflection(to, "x mirrored", c, std::isfinite(part.to) ? part.from + part.to : 0);
            break;
        case Kind::set:
            for (const int shift : {1, -1})
                to.push_back({fmt::format("entry i {} 1 taken for entry i (off by one)", shift > 0 ? '+' : '-'),
                    [=, count = static_cast<double>(part.count)](
                        std::span<double> x) { x[c] = std::fmod(x[c] + shift + count, count); }});
            add_reflection(to, "the entries in reverse order", c, part.count - 1.0);
            break;
        default: break;
    }
}

std::vector<NamedMove> moves_of(const Domain& domain) {
    std::vector<NamedMove> out;
    std::size_t c = 0;
    for (const DomainPart& part : domain.parts()) {
        add_moves(out, part, c);
        c += part.coordinates();
    }
    return out;
}

/// A factor that is a function of the point.
Factor factor_of_point(const std::shared_ptr<const DomainChart>& chart, std::string name,
    std::function<double(std::span<const double>)> value, bool any_exponent = false) {
    Factor out;
    out.name = std::move(name);
    out.any_exponent = any_exponent;
    out.value = [chart, value = std::move(value)](Vec3d, Vec3d wi) {
        Coordinates x{};
        chart->point(wi, std::span(x).first(chart->domain().coordinates()));
        const double v = value(x);
        return std::isfinite(v) ? v : 0;
    };
    return out;
}

/// "x - 2", "x + 3" or "x".
std::string difference(double from) {
    return from == 0 ? "x" : fmt::format("x {} {:g}", from > 0 ? '-' : '+', std::fabs(from));
}

}  // namespace

std::vector<Factor> domain_factors(const std::shared_ptr<const DomainChart>& chart) {
    std::vector<Factor> out;
    const auto add = [&](std::string name, auto value) {
        out.push_back(factor_of_point(chart, std::move(name), std::move(value)));
    };
    using Point = std::span<const double>;
    std::size_t c = 0;
    for (const DomainPart& part : chart->domain().parts()) {
        switch (part.kind) {
            case Kind::sphere:
            case Kind::hemisphere:
                add("cos theta", [c](Point x) { return std::fabs(x[c + 2]); });
                add("sin theta", [c](Point x) { return math::hypot(x[c], x[c + 1]); });
                break;
            case Kind::disk: add("the radius r", [c](Point x) { return math::hypot(x[c], x[c + 1]); }); break;
            case Kind::square:
            case Kind::cube:
                for (std::size_t i = 0; i < part.coordinates(); ++i) {
                    add(symbols[i], [=](Point x) { return x[c + i]; });
                    add(fmt::format("1 - {}", symbols[i]), [=](Point x) { return 1 - x[c + i]; });
                }
                break;
            case Kind::triangle:
                add("b0", [c](Point b) { return b[c]; });
                add("1 - b0", [c](Point b) { return 1 - b[c]; });
                add("b1", [c](Point b) { return b[c + 1]; });
                add("1 - b1", [c](Point b) { return 1 - b[c + 1]; });
                break;
            case Kind::line:
                if (std::isfinite(part.from))
                    add(difference(part.from), [c, from = part.from](Point x) { return x[c] - from; });
                if (std::isfinite(part.to))
                    add(fmt::format("{:g} - x", part.to), [c, to = part.to](Point x) { return to - x[c]; });
                break;
            case Kind::set: break;
        }
        c += part.coordinates();
    }
    return out;
}

std::vector<Hypothesis> domain_frames(std::span<const Place> places) {
    std::vector<Hypothesis> out;
    for (NamedMove& move : moves_of(places[0].traits.domain->domain())) {
        Hypothesis h = by_moving(std::move(move.name), std::move(move.move), 1, places[0].draws_at_zero());
        h.place = static_cast<int>(out.size());
        score(h, places);
        if (h.helps()) out.push_back(std::move(h));
    }
    return out;
}

// ---- A parameter of a move, by the likelihood of the draws: a coarse search, then golden sections.

namespace {

/// A hypothesis for each value of one number, and the values that are tried.
struct MoveFamily {
    std::function<Hypothesis(double)> at;
    double from, to;
};

double mean_log_of(const Hypothesis& h, std::span<const Place> places, std::size_t most_draws) {
    double out = 0;
    for (const Place& place : places) {
        std::vector<Pair> pairs;
        for (std::size_t i = 0; i < std::min(most_draws, place.w.size()); ++i)
            pairs.push_back({place.check_case->wo, place.w[i]});
        std::vector<double> p(pairs.size());
        h.density(place.adapter(), place.technique(), pairs, p);
        out += place.mean_log(p) / static_cast<double>(places.size());
    }
    return out;
}

std::optional<FittedMove> fitted_move(const MoveFamily& family, std::span<const Place> places) {
    constexpr int steps = 40;
    constexpr std::size_t few = 512, total = 1u << 20;
    const double step = (family.to - family.from) / steps;
    double best = -1e300, value = 0;
    for (int k = 0; k <= steps; ++k) {
        const double x = family.from + k * step, l = mean_log_of(family.at(x), places, few);
        if (l > best) {
            best = l;
            value = x;
        }
    }
    constexpr double golden = 0.6180339887498949;
    double low = value - step, high = value + step;
    double a = high - golden * (high - low), b = low + golden * (high - low);
    double of_a = mean_log_of(family.at(a), places, total), of_b = mean_log_of(family.at(b), places, total);
    for (int k = 0; k < 16; ++k) {
        if (of_a > of_b) {
            high = b;
            b = a;
            of_b = of_a;
            of_a = mean_log_of(family.at(a = high - golden * (high - low)), places, total);
        } else {
            low = a;
            a = b;
            of_a = of_b;
            of_b = mean_log_of(family.at(b = low + golden * (high - low)), places, total);
        }
    }
    FittedMove out;
    out.value = (low + high) / 2;
    const double near = step / 4, here = mean_log_of(family.at(out.value), places, total);
    const double bend = (2 * here - mean_log_of(family.at(out.value - near), places, total) -
                            mean_log_of(family.at(out.value + near), places, total)) /
        (near * near);
    double draws = 0;
    for (const Place& place : places) draws += static_cast<double>(place.w.size());
    out.error = bend > 0 ? 1 / std::sqrt(bend * draws) : step;
    out.hypothesis = family.at(out.value);
    score(out.hypothesis, places);
    return out.hypothesis.helps() ? std::optional(out) : std::nullopt;
}

}  // namespace

std::vector<FittedMove> domain_moves(std::span<const Place> places) {
    std::vector<FittedMove> out;
    const bool at_zero = places[0].draws_at_zero();
    std::size_t c = 0;
    for (const DomainPart& part : places[0].traits.domain->domain().parts()) {
        if (part.is_infinite()) {
            const double end = std::isfinite(part.from) ? part.from : std::isfinite(part.to) ? part.to : 0;
            const auto scaled = [=](double log_scale) {
                const double factor = math::exp(-log_scale);
                return by_moving(
                    "scaled", [=](std::span<double> x) { x[c] = end + factor * (x[c] - end); }, factor, at_zero);
            };
            if (auto found = fitted_move({scaled, -1.5, 1.5}, places)) {
                found->error *= math::exp(found->value);
                found->value = math::exp(found->value);
                found->factor = "scale";
                found->of = difference(end);
                found->neutral = 1;
                out.push_back(std::move(*found));
            }
        }
        c += part.coordinates();
    }
    return out;
}

}  // namespace crescent::check
