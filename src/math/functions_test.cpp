// Every function against MPFR, which rounds correctly, over the ranges of its table in functions.h: where it is used,
// over all exponents, and at hard cases. The bounds here are those of the table.
#include "math/functions.h"

#include <gtest/gtest.h>
#include <mpfr.h>

#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace crescent::math {
namespace functions_test {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// 200 bits.
struct Exact {
    mpfr_t v;
    explicit Exact(double x = 0) {
        mpfr_init2(v, 200);
        mpfr_set_d(v, x, MPFR_RNDN);
    }
    ~Exact() { mpfr_clear(v); }
    Exact(const Exact&) = delete;
    Exact& operator=(const Exact&) = delete;
};

/// |got - exact| in ULP of exact.
double ulps(double got, const Exact& exact) {
    const double near = mpfr_get_d(exact.v, MPFR_RNDN);
    if (!std::isfinite(near)) return got == near || (std::isnan(near) && std::isnan(got)) ? 0 : infinity;
    if (std::isnan(got) || std::isinf(got)) return infinity;
    Exact off(got);
    mpfr_sub(off.v, off.v, exact.v, MPFR_RNDN);
    const int exponent = mpfr_zero_p(exact.v) ? -1074 : std::max(static_cast<int>(mpfr_get_exp(exact.v)) - 53, -1074);
    mpfr_mul_2si(off.v, off.v, -exponent, MPFR_RNDN);
    return std::fabs(mpfr_get_d(off.v, MPFR_RNDN));
}

using Reference = int (*)(mpfr_ptr, mpfr_srcptr, mpfr_rnd_t);

struct Row {
    const char* name;
    double (*ours)(double);
    Reference exact;
    double bound;
    std::vector<std::pair<double, double>> ranges;  // linear; an infinite end: every exponent
};

/// Draws evenly between a and b; for an infinite b, random sign, exponent and mantissa.
double drawn(std::mt19937_64& bits, std::pair<double, double> range) {
    if (std::isinf(range.second)) {
        const double v = std::fabs(std::bit_cast<double>(bits()));
        if (!std::isfinite(v)) return 1;
        return range.first < 0 && (bits() & 1u) ? -v : v;
    }
    return range.first + (range.second - range.first) * (static_cast<double>(bits() >> 11) * 0x1p-53);
}

const std::vector<Row>& rows() {
    static const std::vector<std::pair<double, double>> circles = {
        {-7, 7}, {-0.01, 0.01}, {-1e6, 1e6}, {-1e15, 1e15}, {-0x1p20, 0x1p20}};
    static const std::vector<Row> all = {
        {"exp", exp, mpfr_exp, 0.54, {{-1, 1}, {-700, 709}, {-0.03, 0.03}}},
        {"exp2", exp2, mpfr_exp2, 0.54, {{-1, 1}, {-1020, 1023}}},
        {"expm1", expm1, mpfr_expm1, 0.75, {{-0.03, 0.03}, {-1, 1}, {-45, 700}, {-1e-10, 1e-10}}},
        {"log", log, mpfr_log, 0.9, {{0.9, 1.1}, {0, 2}, {0.97, 1.03}, {0, infinity}, {0, 1e-300}}},
        {"log10", log10, mpfr_log10, 0.51, {{0, 2}, {0.97, 1.03}, {0, infinity}}},
        {"log1p", log1p, mpfr_log1p, 0.9,
            {{-1, 1}, {-0.03, 0.03}, {-1e-10, 1e-10}, {-1e-18, 1e-15}, {0, infinity}, {0, 1e17}}},
        {"sin", sin, mpfr_sin, 0.8, circles},
        {"cos", cos, mpfr_cos, 0.8, circles},
        {"tan", tan, mpfr_tan, 2, {{-7, 7}, {-0.01, 0.01}, {-1e6, 1e6}, {-1e15, 1e15}}},
        {"asin", asin, mpfr_asin, 2, {{-1, 1}, {-1e-5, 1e-5}, {0.9999, 1}}},
        {"acos", acos, mpfr_acos, 2, {{-1, 1}, {-1e-5, 1e-5}, {0.9999, 1}, {-1, -0.9999}}},
    };
    return all;
}

double worst_of(const Row& row, double (*f)(double), int draws, std::string& where) {
    std::mt19937_64 bits(7);
    double worst = 0;
    const auto try_at = [&](double x) {
        Exact exact(x);
        row.exact(exact.v, exact.v, MPFR_RNDN);
        const double off = ulps(f(x), exact);
        if (off > worst) {
            worst = off;
            char text[64];
            std::snprintf(text, sizeof text, "%s(%a)", row.name, x);
            where = text;
        }
    };
    for (const auto& range : row.ranges)
        for (int k = 0; k < draws; ++k) try_at(drawn(bits, range));
    return worst;
}

TEST(Functions, StayWithinTheErrorOfTheirTable) {
    for (const Row& row : rows()) {
        std::string where;
        const double worst = worst_of(row, row.ours, 4000, where);
        RecordProperty(row.name, std::to_string(worst));
        EXPECT_LE(worst, row.bound) << where;
    }
}

TEST(Functions, WholePowersStayWithinNUnits) {
    const std::array<std::pair<double, double>, 4> ranges = {{{0, 1}, {0.9, 1.1}, {-3, 3}, {-infinity, infinity}}};
    std::mt19937_64 bits(13);
    for (unsigned n = 1; n <= 300; ++n)
        for (const auto& range : ranges)
            for (int k = 0; k < 100; ++k) {
                const double x = drawn(bits, range);
                Exact exact(x);
                mpfr_pow_ui(exact.v, exact.v, n, MPFR_RNDN);
                ASSERT_LE(ulps(whole_power(x, n), exact), n) << x << " to the power of " << n;
            }
}

struct Pair {
    const char* name;
    double (*ours)(double, double);
    int (*exact)(mpfr_ptr, mpfr_srcptr, mpfr_srcptr, mpfr_rnd_t);
    double bound;
    std::vector<std::array<std::pair<double, double>, 2>> ranges;
};

TEST(Functions, TwoArgumentErrorsAreWithinTheTable) {
    const std::pair<double, double> any = {-infinity, infinity}, positive = {0, infinity};
    double (*length)(double, double) = hypot;
    const std::vector<Pair> table = {
        {"pow", pow, mpfr_pow, 0.75,
            {{{{0, 1}, {0, 300}}}, {{{0, 3}, {-400, 400}}}, {{positive, {-1.1, 1.1}}},
                {{{0.9999, 1.0001}, {-1e6, 1e6}}}, {{{10, 10}, {-300, 300}}}}},
        {"atan2", atan2, mpfr_atan2, 1.25,
            {{{{-1, 1}, {-1, 1}}}, {{any, any}}, {{{-0.1, 0.1}, {0.9, 1}}}, {{{-1, 1}, {-1e-9, 1e-9}}}}},
        {"hypot", length, mpfr_hypot, 0.51, {{{{-1, 1}, {-1, 1}}}, {{any, any}}, {{{0.9, 1}, {-1e-8, 1e-8}}}}},
    };
    for (const Pair& row : table) {
        std::mt19937_64 bits(11);
        double worst = 0;
        std::string where;
        for (const auto& [first, second] : row.ranges)
            for (int k = 0; k < 4000; ++k) {
                const double x = drawn(bits, first), y = drawn(bits, second);
                Exact exact(x), other(y);
                row.exact(exact.v, exact.v, other.v, MPFR_RNDN);
                const double off = ulps(row.ours(x, y), exact);
                if (off > worst) {
                    worst = off;
                    where = ::testing::PrintToString(std::pair(x, y));
                }
            }
        EXPECT_LE(worst, row.bound) << row.name << where;
        RecordProperty(row.name, std::to_string(worst));
    }
}

TEST(Functions, PowersThatADoubleHoldsAreExact) {
    double ten = 1;
    for (int k = 0; k <= 22; ++k, ten *= 10) {
        EXPECT_EQ(pow(10, k), ten);
        EXPECT_EQ(log10(ten), k);
    }
    for (int k = -1074; k <= 1023; ++k) EXPECT_EQ(exp2(k), std::ldexp(1.0, k));
    EXPECT_EQ(hypot(3, 4), 5);
    EXPECT_EQ(hypot(1, 2, 2), 3);
    EXPECT_EQ(pow(-3, 3), -27);
}

/// Zeros, infinities, NaN and the ends of the range, as C has them.
TEST(Functions, HaveTheEdgesOfC) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<double> edges = {0.0, -0.0, 1, -1, 0.5, -0.5, 2, -2, 3, infinity, -infinity, nan, 1e308, -1e308,
        5e-324, -5e-324, 1e-310, 710, -746, -745.2, 709.9, 1.5, 1e20};
    const auto same = [](double a, double b) {
        if (std::isnan(b)) return std::isnan(a);
        if (b == 0 || std::isinf(b)) return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
        return std::fabs(a - b) <= 0x1p-51 * std::fabs(b) + 5e-324;
    };
    const auto hold = [&](const char* name, double ours, double c, double x, double y) {
        EXPECT_TRUE(same(ours, c)) << name << '(' << x << ", " << y << ") = " << ours << ", in C " << c;
    };
    for (double x : edges) {
        hold("exp", exp(x), std::exp(x), x, 0);
        hold("exp2", exp2(x), std::exp2(x), x, 0);
        hold("expm1", expm1(x), std::expm1(x), x, 0);
        hold("log", log(x), std::log(x), x, 0);
        hold("log10", log10(x), std::log10(x), x, 0);
        hold("log1p", log1p(x), std::log1p(x), x, 0);
        hold("asin", asin(x), std::asin(x), x, 0);
        hold("acos", acos(x), std::acos(x), x, 0);
        if (!(std::fabs(x) >= 0x1p50)) {
            hold("sin", sin(x), std::sin(x), x, 0);
            hold("cos", cos(x), std::cos(x), x, 0);
            EXPECT_EQ(std::bit_cast<std::uint64_t>(sincos(x).sin), std::bit_cast<std::uint64_t>(sin(x)));
            EXPECT_EQ(std::bit_cast<std::uint64_t>(sincos(x).cos), std::bit_cast<std::uint64_t>(cos(x)));
        }
        for (double y : edges) {
            hold("pow", pow(x, y), std::pow(x, y), x, y);
            hold("atan2", atan2(x, y), std::atan2(x, y), x, y);
            hold("hypot", hypot(x, y), std::hypot(x, y), x, y);
        }
    }
}

TEST(Functions, AMeasureOfErrorSeesAnUlp) {
    std::string where;
    const Row& exp_row = rows()[0];
    EXPECT_GT(worst_of(exp_row, [](double x) { return std::nextafter(exp(x), 1e300); }, 100, where), 0.9);
}

}  // namespace functions_test
}  // namespace crescent::math
