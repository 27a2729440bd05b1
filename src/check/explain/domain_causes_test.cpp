// Samplers of points with one fault each: the cause that the verdict of the density names.
#include "check/explain/domain_causes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <utility>

#include "base/vec.h"
#include "check/sources/point_sampler.h"
#include "check/user.h"

namespace crescent {
namespace domain_causes_test {

using Point = std::span<const double>;
using Table = std::array<double, 8>;

constexpr Table probabilities = {0.3, 0.05, 0.1, 0.15, 0.02, 0.08, 0.2, 0.1};

std::string cause_of(const PointSampler& sampler) {
    for (const Verdict& v : check_sampler("made", sampler).verdicts)
        if (!v.cause.empty()) return v.cause;
    return "none";
}

std::size_t entry_at(const auto& table, double u) {
    double sum = 0;
    for (std::size_t k = 0; k + 1 < table.size(); ++k)
        if (u < (sum += table[k])) return k;
    return table.size() - 1;
}

/// Draws entries by one table; p is that of another.
PointSampler choice(const Table& drawn, int shift, bool wraps) {
    const auto entry = [=](double u) {
        const int k = static_cast<int>(entry_at(drawn, u)) + shift;
        return static_cast<std::size_t>(wraps ? (k + 8) % 8 : std::clamp(k, 0, 7));
    };
    return {.domain = "set:8",
        .numbers = 1,
        .sample =
            [=](Point u, std::span<double> x) {
                const std::size_t k = entry(u[0]);
                x[0] = static_cast<double>(k);
                return probabilities[k];
            },
        .pdf = [](Point x) { return probabilities[static_cast<std::size_t>(x[0])]; },
        .parallel = true};
}

TEST(DomainCauses, NameEntriesThatAreOneOff) {
    EXPECT_EQ(cause_of(choice(probabilities, 0, false)), "none");
    EXPECT_NE(
        cause_of(choice(probabilities, 1, true)).find("entry i + 1 taken for entry i (off by one)"), std::string::npos);
    for (const int shift : {1, -1}) {
        const std::string cause = cause_of(choice(probabilities, shift, false));
        EXPECT_NE(cause.find(shift > 0 ? "entry i + 1 taken for entry i, but for the last (off by one)"
                                       : "entry i - 1 taken for entry i, but for the first (off by one)"),
            std::string::npos)
            << cause;
    }
}

TEST(DomainCauses, NameTwoEntriesThatAreExchanged) {
    Table drawn = probabilities;
    std::swap(drawn[1], drawn[6]);
    const std::string cause = cause_of(choice(drawn, 0, false));
    EXPECT_NE(cause.find("entries 1 and 6 exchanged"), std::string::npos) << cause;
}

/// A lobe and a direction about n: two lobes of other powers of the cosine.
TEST(DomainCauses, NameOtherChancesOfLobes) {
    constexpr std::array<double, 3> drawn = {0.2, 0.5, 0.3}, claimed = {0.25, 0.45, 0.3};
    const auto density = [=](Point x) {
        const auto k = static_cast<std::size_t>(x[0]);
        const double n = 1 + 4.0 * static_cast<double>(k);
        return claimed[k] * (n + 1) / (2 * pi) * std::pow(std::max(x[3], 0.0), n);
    };
    const std::string cause = cause_of({.domain = "set:3 x hemisphere",
        .numbers = 3,
        .sample =
            [=](Point u, std::span<double> x) {
                const std::size_t k = entry_at(drawn, u[0]);
                const double z = std::pow(1 - u[1], 1 / (2 + 4.0 * static_cast<double>(k))), r = std::sqrt(1 - z * z);
                x[0] = static_cast<double>(k);
                x[1] = r * std::cos(2 * pi * u[2]);
                x[2] = r * std::sin(2 * pi * u[2]);
                x[3] = z;
                return density(x);
            },
        .pdf = density,
        .parallel = true});
    EXPECT_NE(cause.find("the entries are chosen with other probabilities: entry 0 with "), std::string::npos) << cause;
}

double kumaraswamy(double a, double b, double x) {
    return a * b * std::pow(x, a - 1) * std::pow(1 - std::pow(x, a), b - 1);
}
/// Draws of that distribution with a and b, mirrored or not; p has the parameters c and d.
PointSampler kumaraswamy_sampler(double a, double b, bool mirrored, double c, double d) {
    return {.domain = "line:0,1",
        .numbers = 1,
        .sample =
            [=](Point u, std::span<double> x) {
                const double drawn = std::pow(1 - std::pow(1 - u[0], 1 / b), 1 / a);
                x[0] = mirrored ? 1 - drawn : drawn;
                return kumaraswamy(c, d, x[0]);
            },
        .pdf = [=](Point x) { return kumaraswamy(c, d, x[0]); },
        .parallel = true};
}

TEST(DomainCauses, NameAMirroredPointOnlyIfDrawsFollowIt) {
    const std::string mirrored = cause_of(kumaraswamy_sampler(2, 5, true, 2, 5));
    EXPECT_NE(mirrored.find("x mirrored: x -> 1 - x"), std::string::npos) << mirrored;
    const std::string exchanged = cause_of(kumaraswamy_sampler(5, 2, false, 2, 5));
    EXPECT_EQ(exchanged.find("mirrored"), std::string::npos) << exchanged;
}

/// Exponential draws of another rate, from the end of a half-infinite line or on both sides of 0.
TEST(DomainCauses, SayNothingOfConcentrationOverInfiniteLines) {
    for (const double rate : {0.6, 0.9, 1.1, 1.7})
        for (const char* domain : {"line:0,inf", "line:-inf,0"}) {
            const double sign = std::string(domain) == "line:0,inf" ? 1 : -1;
            const auto density = [](Point x) { return std::exp(-std::fabs(x[0])); };
            const PointSampler sampler{.domain = domain,
                .numbers = 1,
                .sample =
                    [=](Point u, std::span<double> x) {
                        x[0] = -sign * std::log1p(-u[0]) / rate;
                        return density(x);
                    },
                .pdf = density,
                .parallel = true};
            std::string text;
            for (const Verdict& v : check_sampler("made", sampler).verdicts) text += v.message() + " " + v.cause + "\n";
            EXPECT_EQ(text.find("concentrated"), std::string::npos) << domain << ", rate " << rate << ": " << text;
            EXPECT_NE(text.find("a rate, a mean free path or another scale"), std::string::npos)
                << rate << ": " << text;
        }
}

/// A lens without the root of its radius, with a distance.
TEST(DomainCauses, NameTheRadiusOfADiskBesideALine) {
    for (const bool infinite : {false, true}) {
        const auto density = [=](Point x) { return (infinite ? 2 * std::exp(-2 * x[2]) : 1) / pi; };
        const std::string cause = cause_of({.domain = infinite ? "disk x line:0,inf" : "disk x line:0,1",
            .numbers = 3,
            .sample =
                [=](Point u, std::span<double> x) {
                    x[0] = u[0] * std::cos(2 * pi * u[1]);
                    x[1] = u[0] * std::sin(2 * pi * u[1]);
                    x[2] = infinite ? -std::log1p(-u[2]) / 2 : u[2];
                    return density(x);
                },
            .pdf = density,
            .parallel = true});
        EXPECT_NE(cause.find("over the radius r"), std::string::npos) << infinite << ": " << cause;
    }
}

}  // namespace domain_causes_test
}  // namespace crescent
