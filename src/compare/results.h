// What a comparison found, as plain data: meters with their doubt, whether arms differ, where the noise moved.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compare/renders.h"
#include "compare/spectrum.h"
#include "compare/statistics.h"
#include "meters/metrics.h"

namespace crescent {

inline constexpr double confidence = 0.95;  // of every interval

/// A meter of one arm in one region. `why` says why there is no value or no interval.
struct MeterValue {
    std::optional<double> value;
    std::optional<std::pair<double, double>> interval;  // 95 %
    std::string why;
};

struct RegionResult {
    std::string region;
    std::uint64_t pixels = 0;
    std::vector<std::pair<std::string, MeterValue>>
        meters;                 // rmse, var, bias2, relmse, mape, fireflies, y_mean, flip, efficiency
    std::optional<Tail> tail;   // of the squared errors of all pixels and renders
    double largest_share = 0;   // of the largest squared error in their sum
    std::vector<double> power;  // error spectrum, see spectrum.h
    NoiseColour colour = NoiseColour::unknown;
    const MeterValue& meter(const std::string& name) const;
    /// The tail is too heavy for an interval of a mean of squares to mean anything.
    bool heavy() const;
};

struct ArmResult {
    std::string name;
    std::size_t renders = 0;
    std::optional<double> spp, seconds;
    std::vector<RegionResult> regions;
    const RegionResult& region(const std::string& name) const;
};

/// One test of equal means.
struct MeanTest {
    std::string region;
    double a = 0, b = 0;  // mean Y
    Welch welch;
    bool differs = false;
    double smallest = 0;  // the relative difference that would have been seen nine times out of ten
    std::string why;      // why it was not tested; "" where it was
};

/// Two arms, or an arm and the reference: are their expectations the same?
struct BiasResult {
    std::string a, b;
    bool paired = false;
    bool dependent = false;  // neighbouring pixels' noise is correlated: Benjamini-Yekutieli
    std::vector<MeanTest> regions;
    std::vector<double> tile_p;           // NaN: not tested
    std::vector<double> tile_difference;  // mean Y of a less that of b
    std::vector<bool> tile_differs;
    std::size_t tiles_tested = 0, tiles_left_out = 0, tiles_different = 0;
    std::vector<std::uint64_t> pixel_p;  // histogram of per-pixel p in tenths
    bool differs() const;
    std::string sentence;
};

/// Where the noise moved from b to a: log2(variance a / variance b) a tile.
struct NoiseResult {
    std::string a, b;
    std::vector<double> log2_ratio;  // NaN: no variance
    std::vector<bool> told_apart;    // from 1
};

struct CompareResult {
    std::vector<ArmResult> arms;
    std::vector<BiasResult> bias;
    std::vector<NoiseResult> noise;
    std::vector<AssertionResult> assertions;
    std::vector<std::string> warnings;
    std::map<std::string, double> reference_error;  // region -> rms standard error of the reference's Y; NaN: not known
    enum class State { holds, fails, inconclusive } state = State::holds;
    std::string say;  // one sentence for the state
};

}  // namespace crescent
