// The metrics of a film, computed for every region or for the frame. To add one, add its struct here and a line to the
// list at the end. The list determines what a run measures and stores, metrics.json and metrics.csv, the quantities
// that an assertion can name, the spread over seeds, `crescent list metrics`, the report and the tests.
//
// A metric receives the pixels of a box, row by row from the bottom-left, and then returns its value; it sums in
// double, so that equal films give equal numbers.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>
#include <utility>

namespace crescent {

/// One pixel of a film, with the reference. Y in W/(sr m^2).
struct FilmPixel {
    double y = 0, reference = 0;
    double var = 0;         // variance of the mean of Y
    double largest = 0;     // single sample
    double horizon = 0;     // directions drawn at or below the horizon
    bool geometry = false;  // whether the camera sees a shape there
    double pair_error = 0;  // e of a paired reference (render/reference/paired.h), else 0
    double difference() const { return y - reference; }
    /// An unbiased estimate of the squared error, below 0 in some pixels if the reference is paired.
    double squared_error() const { return difference() * difference() - pair_error * pair_error; }
};

/// Values that are the same for every pixel.
struct FilmFacts {
    double pixels = 0;  // of the box
    std::uint64_t n = 0;
    std::uint64_t directions = 1;   // drawn per sample
    std::uint64_t evaluations = 1;  // of f per sample
    std::uint64_t bad = 0;          // samples of the whole film
    double firefly_k = 0;
};

/// The description of a metric.
struct MetricInfo {
    std::string_view means;
    std::string_view label{};        // markup, if the report shows something else than the name
    bool in_tables = true;           // in the report and on the terminal
    bool of_combinations = false;    // in tables only if an arm combines samplers
    bool from_two_samples = false;   // unknown at one sample per pixel
    bool of_single_samples = false;  // the highest sample count includes the samples of all others; no spread over
                                     // seeds
};

/// The type of a metric's value: double, or an integer for a count.
template <class Metric> using MetricOf = decltype(std::declval<const Metric&>().value(FilmFacts{}));

/// rmse: root mean square error of Y against the reference, over a region.
struct RmseMetric {
    static constexpr MetricInfo info = {
        .means = "root mean square error of Y against the reference over a region", .label = "RMSE"};
    double squares = 0;
    void add(const FilmPixel& p, const FilmFacts&) { squares += p.squared_error(); }
    /// NaN below the error of a paired reference: the estimate of the squared error is negative.
    double value(const FilmFacts& f) const { return std::sqrt(squares / f.pixels); }
};

/// var: mean over the pixels of a region of the variance of the mean of Y.
struct VarMetric {
    static constexpr MetricInfo info = {
        .means = "mean over a region of the variance of the mean of Y", .from_two_samples = true};
    double sum = 0;
    void add(const FilmPixel& p, const FilmFacts&) { sum += p.var; }
    double value(const FilmFacts& f) const {
        return f.n < 2 ? std::numeric_limits<double>::quiet_NaN() : sum / f.pixels;
    }
};

/// relmse: relative mean square error of Y against the reference, over a region: the mean of
/// (Y - R)^2 / (R^2 + 0.01) (Rousselle, Knaus, Zwicker 2011, "Adaptive Sampling and Reconstruction using Greedy Error
/// Minimization", sec. 5, with their epsilon).
struct RelMseMetric {
    static constexpr MetricInfo info = {.means = "mean over a region of (Y - R)^2 / (R^2 + 0.01), R the reference",
        .label = "relMSE",
        .in_tables = false};
    static constexpr double epsilon = 0.01;  // [Y]^2
    double sum = 0;
    void add(const FilmPixel& p, const FilmFacts&) { sum += p.squared_error() / (p.reference * p.reference + epsilon); }
    double value(const FilmFacts& f) const { return sum / f.pixels; }
};

/// smape: symmetric mean absolute percentage error of Y against the reference, over a region: the mean of
/// |Y - R| / (|Y| + |R| + 0.01), between 0 and 1 (Vogels et al. 2018, "Denoising with Kernel Prediction and Asymmetric
/// Loss Functions", eq. 4, with their epsilon).
struct SmapeMetric {
    static constexpr MetricInfo info = {.means = "mean over a region of |Y - R| / (|Y| + |R| + 0.01), R the reference",
        .label = "SMAPE",
        .in_tables = false};
    static constexpr double epsilon = 0.01;  // [Y]
    double sum = 0;
    void add(const FilmPixel& p, const FilmFacts&) {
        sum += std::fabs(p.difference()) / (std::fabs(p.y) + std::fabs(p.reference) + epsilon);
    }
    double value(const FilmFacts& f) const { return sum / f.pixels; }
};

/// bias2: squared bias of Y against the reference, over a region: the mean of (Y - R)^2 minus the variance of the
/// mean of Y. Its expectation is the mean of (E[Y] - R)^2, so that of an unbiased sampler is around 0, on either side.
struct BiasSqMetric {
    static constexpr MetricInfo info = {
        .means = "mean over a region of (Y - R)^2 minus the variance of the mean of Y, R the reference",
        .label = "bias²",
        .in_tables = false,
        .from_two_samples = true};
    double sum = 0;
    void add(const FilmPixel& p, const FilmFacts&) { sum += p.squared_error() - p.var; }
    double value(const FilmFacts& f) const {
        return f.n < 2 ? std::numeric_limits<double>::quiet_NaN() : sum / f.pixels;
    }
};

/// fireflies: geometry pixels whose error is larger than firefly_k times the reference.
struct FirefliesMetric {
    static constexpr MetricInfo info = {.means = "geometry pixels with |Y - Y_ref| > firefly_k Y_ref"};
    std::uint64_t count = 0;
    void add(const FilmPixel& p, const FilmFacts& f) {
        if (p.geometry && std::fabs(p.difference()) > f.firefly_k * p.reference) ++count;
    }
    std::uint64_t value(const FilmFacts&) const { return count; }
};

/// horizon_frac: the share of the directions drawn at geometry pixels (two per sample for a sampler with two
/// techniques) that are below the horizon.
struct HorizonFracMetric {
    static constexpr MetricInfo info = {
        .means = "part of the directions drawn at geometry pixels that fall under the horizon",
        .label = "horizon share"};
    double directions = 0, geometry = 0;
    void add(const FilmPixel& p, const FilmFacts&) {
        if (p.geometry) {
            ++geometry;
            directions += p.horizon;
        }
    }
    double value(const FilmFacts& f) const {
        return geometry > 0 ? directions / (geometry * static_cast<double>(f.n * f.directions)) : 0;
    }
};

/// y_mean: mean of Y over the whole frame.
struct YMeanMetric {
    static constexpr MetricInfo info = {.means = "mean Y of the whole frame", .label = "<i>Y</i><sub>mean</sub>"};
    double sum = 0;
    void add(const FilmPixel& p, const FilmFacts&) { sum += p.y; }
    double value(const FilmFacts& f) const { return sum / f.pixels; }
};

/// rmse_frame: rmse over the whole frame. It mixes the regions, so reports show it only as a footnote.
struct RmseFrameMetric : RmseMetric {
    static constexpr MetricInfo info = {
        .means = "root mean square error of Y over the whole frame", .label = "whole-frame RMSE", .in_tables = false};
};

/// largest: the largest single sample of the frame.
struct LargestMetric {
    static constexpr MetricInfo info = {
        .means = "largest single sample of the frame; the arm's highest sample count unless n is given",
        .in_tables = false,
        .of_single_samples = true};
    double largest = 0;
    void add(const FilmPixel& p, const FilmFacts&) { largest = std::max(largest, p.largest); }
    double value(const FilmFacts&) const { return largest; }
};

/// bad: samples that are NaN, infinite or negative.
struct BadMetric {
    static constexpr MetricInfo info = {
        .means =
            "samples that are not a number, infinite or negative; the arm's highest sample count unless n is given",
        .in_tables = false,
        .of_single_samples = true};
    void add(const FilmPixel&, const FilmFacts&) {}
    std::uint64_t value(const FilmFacts& f) const { return f.bad; }
};

/// rays: the directions that one sample estimates, each with one ray: 1, or more for samplers that join several.
struct RaysMetric {
    static constexpr MetricInfo info = {.means = "rays of one sample, one for each direction that it estimates",
        .label = "rays a sample",
        .of_combinations = true};
    void add(const FilmPixel&, const FilmFacts&) {}
    std::uint64_t value(const FilmFacts& f) const { return f.directions; }
};

/// f_evaluations: the evaluations of f of one sample: one for each direction, and of resampling one for each candidate.
struct FEvaluationsMetric {
    static constexpr MetricInfo info = {
        .means = "evaluations of f of one sample", .label = "evaluations of f a sample", .of_combinations = true};
    void add(const FilmPixel&, const FilmFacts&) {}
    std::uint64_t value(const FilmFacts& f) const { return f.evaluations; }
};

}  // namespace crescent

// metric(name, type)
// clang-format off: one a line
#define CRESCENT_REGION_METRICS(metric) \
    metric(rmse, RmseMetric)            \
    metric(var, VarMetric)              \
    metric(relmse, RelMseMetric)        \
    metric(smape, SmapeMetric)          \
    metric(bias2, BiasSqMetric)

#define CRESCENT_FRAME_METRICS(metric)       \
    metric(fireflies, FirefliesMetric)       \
    metric(horizon_frac, HorizonFracMetric)  \
    metric(y_mean, YMeanMetric)              \
    metric(rmse_frame, RmseFrameMetric)      \
    metric(largest, LargestMetric)           \
    metric(bad, BadMetric)                   \
    metric(rays, RaysMetric)                 \
    metric(f_evaluations, FEvaluationsMetric)
// clang-format on
