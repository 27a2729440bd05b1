// The interface of a sampler under test, independent of its language, with the errors of external samplers, the
// adapters that forward, record, cache or limit calls, and the cases of a user's sampler.
#pragma once

#include <array>
#include <atomic>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/vec.h"
#include "check/domains/domain_chart.h"
#include "check/sources/evaluation_device.h"
#include "math/simd/frame.h"
#include "samplers/info.h"
#include "scene/lights/all.h"
#include "scene/surroundings.h"

namespace crescent {

// ---- Errors of an external sampler.

/// The sampler does not answer any more: the event and the request.
struct SamplerError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The sampler failed in an earlier case.
struct SamplerExited : SamplerError {
    using SamplerError::SamplerError;
};

/// The program follows the protocol but needs more than PipeLimits::total_seconds.
struct SamplerTimeout : SamplerError {
    using SamplerError::SamplerError;
};

// ---- A sampler under test: a built-in arm, a planted fault, a user's struct, a file or a pipe. Local frame, n = +z,
// wo given, wi drawn, both leave the surface; pdf in 1/sr; f without the cosine, in 1/sr. Calls are in batches, so that
// a pipe is used efficiently.

/// The random numbers of one sample, each in [0, 1): radius and angle first, then as many more as the sampler takes.
struct PrimarySample {
    static constexpr int most_numbers = 8;
    double x = 0, y = 0;
    std::array<double, most_numbers - 2> more{};
    PrimarySample() = default;
    PrimarySample(double u1, double u2) : x(u1), y(u2) {}
    PrimarySample(Vec2d u) : x(u.x), y(u.y) {}
    double operator[](int k) const { return k == 0 ? x : k == 1 ? y : more[static_cast<std::size_t>(k) - 2]; }
    double& operator[](int k) { return k == 0 ? x : k == 1 ? y : more[static_cast<std::size_t>(k) - 2]; }
    operator Vec2d() const { return {x, y}; }
};

/// The index below over above: one for each channel, one for all channels, or unknown.
struct Index : std::optional<Vec3d> {
    Index() = default;
    Index(double of_all) : optional({of_all, of_all, of_all}) {}
    Index(Vec3d by_channel) : optional(by_channel) {}
    Index(std::optional<Vec3d> by_channel) : optional(by_channel) {}
};

/// The properties of a sampler: its inputs and outputs, and what is known of its surface.
struct Traits {
    enum class WoDomain { upper, both, none };  // the w_o that it accepts; none: it does not depend on w_o
    using Asked = WoDomain;
    int numbers = 2;   // random numbers of a sample, and those that spread a point of `domain`
    int channels = 1;  // of f and of the weight, 1 or 3
    WoDomain wo = WoDomain::upper;
    bool has_pdf = true;             // false: no pdf(w), and the pdf of a draw is 1 or 0
    bool own_random = false;         // it uses its own random numbers: the same u may give another answer
    bool delta = false;              // some of its draws belong to delta parts
    bool reciprocal = true;          // false: f is known not to be reciprocal
    Index eta{};                     // index below over above
    bool importance = false;         // f is scaled by eta^2 as importance is, not as radiance
    int bits = 0;                    // precision of its arithmetic: 24, 53; 0: determined from the answers
    int u_bits = 24;                 // of its random numbers: 24, or 53 if it asks for them
    bool reciprocal_weight = false;  // a draw's weight is random and estimates 1/p; f is the target, without a cosine
    int neighbours = 0;              // whose reservoirs a draw merges, see neighbours.h; 0: none
    bool number = false;             // each draw is one value, its weight: an estimate of a number
    /// The chart through which it draws directions for points of another domain; null: it draws directions.
    std::shared_ptr<const DomainChart> domain{};
    /// Whether n has a meaning: draws below it are no samples, and f is multiplied by the cosine.
    bool has_surface() const { return wo != WoDomain::none && !domain && !reciprocal_weight; }
    /// |cos| of f's integrand: 1 where there is no surface at all.
    double cosine(Vec3d wi) const { return domain || reciprocal_weight ? 1 : std::fabs(wi.z); }
    /// A density per solid angle as one over the domain.
    double density(Vec3d w, double per_sr) const { return domain ? domain->density(w, per_sr) : per_sr; }
    /// Random numbers that the sampler itself takes.
    int own_numbers() const { return numbers - (domain ? static_cast<int>(domain->spreads()) : 0); }
};

/// A direction w_i, or the point of the domain, in words: "w_i = (0, 0, 1)", "entry 17".
std::string place_text(const Traits& traits, Vec3d w);

/// A direction and its density; pdf 0: no sample. weight: f cos / p if the sampler returns it.
struct Draw {
    Vec3d wi{};
    double pdf = 0;
    std::optional<double> weight{};  // for three channels: their luminance
    std::optional<double> f{};       // if it is known only at the draws
    /// Not 0: a draw of a delta part, with the probability of its selection; then pdf is 0, and weight is set.
    double delta = 0;
    Vec3d weights{};  // by channel, if there are three and weight is set
};

/// The draw of a point of a domain with its density over it. u: the sampler's `numbers`, then those that spread the
/// point. A point outside the domain has the direction NaN.
Draw draw_of_point(
    const DomainChart& domain, std::span<const double> point, double pdf, const PrimarySample& u, int numbers);

/// Random numbers that a sampler of points may take, besides those that spread a point.
inline int most_numbers(const DomainChart& domain) {
    return PrimarySample::most_numbers - static_cast<int>(domain.spreads());
}

/// Draws to which the chart of an infinite line is fitted, and their random numbers, `count` each.
inline constexpr std::uint32_t draws_of_chart = 4096;
std::vector<PrimarySample> numbers_of_chart(int count);

/// Marks a delta part with selection probability 0; the verdict `valid` reports it.
inline constexpr double delta_never_chosen = -std::numeric_limits<double>::infinity();

/// wo and wi of one evaluation.
struct Pair {
    Vec3d wo, wi;
};

/// Number of answers of an external sampler; for a program, the time they took and its total time limit, in s.
struct QueryUsage {
    std::uint64_t answers = 0;
    double seconds = 0, allowed = 0;  // allowed 0: no limit
};

/// One density with its draws, or two if MIS combines a pair of samples. Thread-safe unless `serial()`.
class SamplerAdapter {
public:
    virtual ~SamplerAdapter() = default;
    virtual std::string name() const = 0;
    virtual Traits traits() const { return {}; }
    virtual int techniques() const { return 1; }
    /// The name of one of several techniques; "" if it has none.
    virtual std::string technique_name(int /*technique*/) const { return ""; }
    virtual void sample(int technique, Vec3d wo, std::span<const PrimarySample> u, std::span<Draw> out) const = 0;
    virtual void pdf(int technique, std::span<const Pair> pairs, std::span<double> out) const = 0;
    /// The same density in double if the sampler has one, for quadrature.
    virtual void exact_pdf(int technique, std::span<const Pair> pairs, std::span<double> out) const {
        pdf(technique, pairs, out);
    }
    /// MIS weight of a direction drawn by `technique`.
    virtual void mis_weight(int /*technique*/, std::span<const Pair> pairs, std::span<double> out) const {
        for (std::size_t i = 0; i < pairs.size(); ++i) out[i] = 1;
    }
    virtual bool has_f() const { return false; }
    virtual void f(std::span<const Pair> /*at*/, std::span<double> out) const {
        for (double& v : out) v = 0;
    }
    /// f by channel if there are three; f is their luminance.
    virtual void f_channels(std::span<const Pair> pairs, std::span<Vec3d> out) const {
        std::vector<double> y(out.size());
        f(pairs, y);
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = {y[i], y[i], y[i]};
    }
    /// The target of random weights, over solid angle; f may be a bounded function of it.
    virtual void target(std::span<const Pair> pairs, std::span<double> out) const { f(pairs, out); }
    /// Whether a reference value of f is known independently of f; reference_f() is f otherwise.
    virtual bool has_true_f() const { return false; }
    virtual void reference_f(std::span<const Pair> pairs, std::span<double> out) const { f(pairs, out); }
    /// Whether f is known at the draws: if only there, their weights are available, but not their integral.
    virtual bool has_drawn_f() const { return has_f(); }
    /// The error of a tabulated p, 1/sr.
    virtual double tabulation_error(Vec3d /*w*/) const { return 0; }
    /// Whether the sampler returns draws for any u, not only recorded ones.
    virtual bool can_draw() const { return true; }
    /// Number of queries to an external sampler so far; for a program, the time they took.
    virtual QueryUsage spending() const { return {}; }
    /// What evaluates an external sampler, if it names it.
    virtual EvaluationDevice device() const { return {}; }
    /// Called during long computations between two queries, before a number of steps, so that a web page can respond to
    /// its user.
    virtual void yield_to_host(std::size_t /*steps*/) const {}
    /// Whether only one thread may call.
    virtual bool serial() const { return false; }
    /// Whether answers are expensive, so that TestSettings limits the number of queries.
    virtual bool limited() const { return serial(); }
};

/// An external sampler that is called in this process: its answers are counted and limited.
class InProcessAdapter : public SamplerAdapter {
public:
    bool limited() const override { return true; }
    QueryUsage spending() const override { return {answers_.load(std::memory_order_relaxed), 0, 0}; }

protected:
    void count(std::size_t answers) const { answers_.fetch_add(answers, std::memory_order_relaxed); }

private:
    mutable std::atomic<std::uint64_t> answers_{0};
};

/// A one-sided disk light: radiance, centre relative to the surface point and radius in m, unit normal.
struct CaseDiskLight {
    double radiance = 0;
    Vec3d center{}, normal{};
    double radius = 0;
    /// Distance along wi to the emitting side.
    std::optional<double> distance(Vec3d wi) const;
};

/// A light of another kind, as in scenes; the surface point is at 0. m.
struct CaseAreaLight {
    double radiance = 0;
    LightKinds::Any form;
    /// Distance along wi to an emitting side.
    std::optional<double> distance(Vec3d wi) const;
    /// Selection weight, as in scenes: radiance times projected area, over pi.
    double power() const;
};

/// Channel 0, 1 or 2 of a colour.
inline double channel_of(Vec3d c, int channel) { return channel == 0 ? c.x : channel == 1 ? c.y : c.z; }
inline double luminance(Vec3d c) { return crescent::luminance(Rgb{c.x, c.y, c.z}); }

/// The lights of a case: a uniform fill of the upper hemisphere, and lights that occlude it and each other.
struct CaseLighting {
    double fill = 1;  // radiance
    std::vector<CaseDiskLight> disks;
    std::vector<CaseAreaLight> area_lights{};              // other than disks
    std::shared_ptr<const Surroundings> around{};          // a sky and emitting triangles; null: none
    Vec3d position{};                                      // of the surface point in the world of `around`, m
    Frame<double> frame{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  // of the surface point in that world
    bool even() const { return disks.empty() && area_lights.empty() && !around; }
    /// The nearest light along wi: its distance and its radiance.
    struct Met {
        double distance, radiance;
    };
    std::optional<Met> first_met(Vec3d wi) const;
    /// Radiance from wi.
    double operator()(Vec3d wi) const;
};

/// Adds the device of a sampler, if it names one that is not in the list.
void add_device(const std::string& arm, const SamplerAdapter& sampler, DevicesByArm& to);

/// Named parameter values, in the order in which they are printed.
using Parameters = std::vector<std::pair<std::string, double>>;

/// One sampler at one w_o with one BRDF under one light.
struct CheckCase {
    std::string arm, brdf, lighting;
    Vec3d wo{};
    double theta_deg = 0, azimuth_deg = 0;
    Parameters parameters;
    CaseLighting light;
    ExpectedBehaviour theory;
    bool baseline = false;  // used only for ranks of efficiency
    std::shared_ptr<const SamplerAdapter> adapter;
    std::string text() const;  // "w_o 60 deg, s=32, Lambert + Phong, fill"
};

/// The text of a case without w_o, and of one that failed before its check.
inline constexpr std::string_view without_wo = "no w_o";
inline constexpr std::string_view before_any_case = "start";

/// The direction at theta from n and phi from x, in degrees.
Vec3d tilt(double theta_deg, double azimuth_deg = 0);

// ---- A sampler that forwards all calls; derived classes change some.

class ForwardingAdapter : public SamplerAdapter {
public:
    explicit ForwardingAdapter(std::shared_ptr<const SamplerAdapter> inner) : inner_(std::move(inner)) {}
    std::string name() const override { return inner_->name(); }
    Traits traits() const override { return inner_->traits(); }
    int techniques() const override { return inner_->techniques(); }
    std::string technique_name(int t) const override { return inner_->technique_name(t); }
    void sample(int t, Vec3d wo, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        inner_->sample(t, wo, u, out);
    }
    void pdf(int t, std::span<const Pair> pairs, std::span<double> out) const override { inner_->pdf(t, pairs, out); }
    void exact_pdf(int t, std::span<const Pair> pairs, std::span<double> out) const override {
        inner_->exact_pdf(t, pairs, out);
    }
    void mis_weight(int t, std::span<const Pair> pairs, std::span<double> out) const override {
        inner_->mis_weight(t, pairs, out);
    }
    bool has_f() const override { return inner_->has_f(); }
    void f(std::span<const Pair> pairs, std::span<double> out) const override { inner_->f(pairs, out); }
    void f_channels(std::span<const Pair> pairs, std::span<Vec3d> out) const override {
        inner_->f_channels(pairs, out);
    }
    void target(std::span<const Pair> pairs, std::span<double> out) const override { inner_->target(pairs, out); }
    bool has_true_f() const override { return inner_->has_true_f(); }
    void reference_f(std::span<const Pair> pairs, std::span<double> out) const override {
        inner_->reference_f(pairs, out);
    }
    bool has_drawn_f() const override { return inner_->has_drawn_f(); }
    double tabulation_error(Vec3d w) const override { return inner_->tabulation_error(w); }
    bool can_draw() const override { return inner_->can_draw(); }
    QueryUsage spending() const override { return inner_->spending(); }
    EvaluationDevice device() const override { return inner_->device(); }
    void yield_to_host(std::size_t steps) const override { inner_->yield_to_host(steps); }
    bool serial() const override { return inner_->serial(); }
    bool limited() const override { return inner_->limited(); }

protected:
    const SamplerAdapter& inner() const { return *inner_; }

private:
    std::shared_ptr<const SamplerAdapter> inner_;
};

// ---- Recorded draws from a file: they are checked without further draws.

class RecordedSampler : public SamplerAdapter {
public:
    bool can_draw() const override { return false; }
    std::size_t rows() const { return draws_.size(); }
    const Draw& row(std::size_t i) const { return draws_[i]; }
    const PrimarySample& row_numbers(std::size_t i) const { return u_[i]; }
    /// The position of a row in the file, "samples.csv:17".
    virtual std::string place(std::size_t row) const = 0;
    void sample(int, Vec3d, std::span<const PrimarySample>, std::span<Draw> out) const override {
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = draws_[i % draws_.size()];
    }

protected:
    std::vector<PrimarySample> u_;
    std::vector<Draw> draws_;
};

// ---- A sampler with a limited number of queries.

/// Throws SamplerTimeout for a query that would raise the answers of `inner` above `limit`.
class LimitedAdapter : public ForwardingAdapter {
public:
    LimitedAdapter(std::shared_ptr<const SamplerAdapter> inner, std::uint64_t limit)
        : ForwardingAdapter(std::move(inner)), most_(limit) {}
    void sample(int t, Vec3d wo, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        allow(out.size());
        inner().sample(t, wo, u, out);
    }
    void pdf(int t, std::span<const Pair> pairs, std::span<double> out) const override {
        allow(out.size());
        inner().pdf(t, pairs, out);
    }
    void exact_pdf(int t, std::span<const Pair> pairs, std::span<double> out) const override {
        allow(out.size());
        inner().exact_pdf(t, pairs, out);
    }
    void f(std::span<const Pair> pairs, std::span<double> out) const override {
        allow(out.size());
        inner().f(pairs, out);
    }
    void f_channels(std::span<const Pair> pairs, std::span<Vec3d> out) const override {
        allow(out.size());
        inner().f_channels(pairs, out);
    }

private:
    std::uint64_t most_;
    void allow(std::size_t questions) const {
        if (spending().answers + questions > most_) throw SamplerTimeout("the limit of queries is reached");
    }
};

/// `sampler` with another name.
std::shared_ptr<const SamplerAdapter> renamed(std::shared_ptr<const SamplerAdapter> sampler, const std::string& name);

// ---- A sampler with a limited time.

/// Throws SamplerTimeout for a call that begins more than `seconds` after this object was made. Until then it changes
/// nothing: results do not depend on the clock unless the limit is reached.
std::shared_ptr<const SamplerAdapter> limited_in_time(std::shared_ptr<const SamplerAdapter> sampler, double seconds);

// ---- The cases of a user's sampler; cases.h has those of the built-in arms.

/// User-defined w_o: theta and azimuth in degrees.
using Grid = std::vector<std::pair<double, double>>;

/// A user's sampler over the grid of w_o under a uniform light, with uniform and cosine as baselines if it has a BRDF.
/// A sampler without BRDF whose draws and p do not depend on w_o, such as that of an environment light, is checked
/// once.
std::vector<CheckCase> make_user_cases(
    const std::shared_ptr<const SamplerAdapter>& adapter, bool full, const Grid& grid = {});
/// The same at one w_o.
CheckCase make_user_case(const std::shared_ptr<const SamplerAdapter>& adapter, double theta, double azimuth);

// ---- The random numbers for samplers under test, multiples of 2^-24 since a sampler may compute in single precision.

/// Sample i of a stream: pairs of numbers from pcg4d, as the estimator draws them. `technique` selects the block of
/// dimensions.
PrimarySample drawn_numbers(
    std::uint32_t seed, std::uint32_t pixel, std::uint64_t i, std::uint32_t technique, int count);
// ---- A cache of p and f at pairs of directions for the duration of a case. Integrals of one case start from the same
// cells, so that each of their points is evaluated once.

/// `sampler` with a cache of its exact densities and f and a counter of its answers; for one thread. draws: also caches
/// draws for the same u, and pdf(w) at them.
std::shared_ptr<const SamplerAdapter> cached(std::shared_ptr<const SamplerAdapter> sampler, bool draws = false);
/// The sampler without its cache.
const SamplerAdapter& uncached(const SamplerAdapter& sampler);

/// One side of a comparison and its random stream.
struct Side {
    CheckCase check_case;
    std::uint32_t stream = 0;
};

/// Queries a program once for each w_o: its answers and draws serve every case with this w_o, independent of the
/// surface and the light of the other side. Cases of one w_o must be consecutive.
class PerDirectionCache {
public:
    Side of(const CheckCase& check_case, std::uint32_t stream);

private:
    std::shared_ptr<const SamplerAdapter> cached_of_, cache_;
    std::array<double, 3> wo_{};
    std::uint32_t stream_ = 0;
};

// ---- Errors in a comparison of two samplers name the failing sampler.

/// `sampler`, whose errors begin with `side`, such as "A", and its name, unless they already name a side. A recorded
/// sampler, or one that cannot fail, is returned unchanged.
std::shared_ptr<const SamplerAdapter> named_side(
    std::shared_ptr<const SamplerAdapter> sampler, const std::string& side);

}  // namespace crescent
