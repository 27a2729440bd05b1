// A sampler under test behind one interface, whatever it is written in, with the errors of one from outside and the
// adapters that forward, record or limit calls.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/vec.h"
#include "math/simd/frame.h"
#include "samplers/info.h"
#include "scene/lights/all.h"
#include "scene/surroundings.h"

namespace crescent::inline sources {

// ---- How a sampler from outside fails to answer: what is thrown to whoever asked it.

/// The sampler cannot be talked with any more: what happened, at which request.
struct SamplerError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// It was given up in an earlier case.
struct SamplerExited : SamplerError {
    using SamplerError::SamplerError;
};

/// The program keeps to the protocol but needs more than PipeLimits::total_seconds.
struct SamplerTimeout : SamplerError {
    using SamplerError::SamplerError;
};

// ---- A sampler on case, whatever it is written in: built-in arm, planted fault, a user's struct, a file, a pipe.
// Local frame, n = +z, wo given, wi drawn, both leave the surface; pdf in 1/sr; f without the cosine, in 1/sr.
// Calls come in batches, so that a pipe can be kept full.

/// The random numbers of one sample, each in [0, 1): radius and angle first, then as many more as it takes.
struct PrimarySample {
    static constexpr int most = 8;
    double x = 0, y = 0;
    std::array<double, most - 2> more{};
    PrimarySample() = default;
    PrimarySample(double u1, double u2) : x(u1), y(u2) {}
    PrimarySample(Vec2d u) : x(u.x), y(u.y) {}
    double operator[](int k) const { return k == 0 ? x : k == 1 ? y : more[static_cast<std::size_t>(k) - 2]; }
    double& operator[](int k) { return k == 0 ? x : k == 1 ? y : more[static_cast<std::size_t>(k) - 2]; }
    operator Vec2d() const { return {x, y}; }
};

/// The index below over above: of each channel, of all alike where one number is given, or not known.
struct Index : std::optional<Vec3d> {
    Index() = default;
    Index(double of_all) : optional({of_all, of_all, of_all}) {}
    Index(Vec3d by_channel) : optional(by_channel) {}
    Index(std::optional<Vec3d> by_channel) : optional(by_channel) {}
};

/// What a sampler is, apart from its answers: what it takes, what it gives, and what is known of its surface.
struct Traits {
    enum class WoDomain { upper, both, none };  // which w_o it answers for; none: it does not depend on w_o
    using Asked = WoDomain;
    int numbers = 2;   // random numbers of a sample
    int channels = 1;  // of f and of the weight, 1 or 3
    WoDomain wo = WoDomain::upper;
    bool has_pdf = true;      // false: no pdf(w), and the pdf of a draw is 1 or 0
    bool own_random = false;  // it draws random numbers of its own: the same u may give another answer
    bool delta = false;       // some of its draws are of delta parts
    bool reciprocal = true;   // false: f is known not to be
    Index eta{};              // index below over above
    bool importance = false;  // f is not scaled by eta^2 as radiance is, but the other way
    int bits = 0;             // of what it computes in: 24, 53; 0: read off the answers
};

/// A direction and the density it came with; pdf 0: nothing drawn. weight: f cos / p where the sampler itself says it.
struct Draw {
    Vec3d wi{};
    double pdf = 0;
    std::optional<double> weight{};  // of three channels: their luminance
    std::optional<double> f{};       // where it is known at the draws alone
    /// Not 0: a draw of a delta part, with the probability that it was chosen with; pdf is 0 then, and weight is there.
    double delta = 0;
    Vec3d weights{};  // by channel, where there are three and weight is there
};

/// The probability of a delta part that says it was chosen with 0; valid tells of it.
inline constexpr double delta_never_chosen = -std::numeric_limits<double>::infinity();

/// wo and wi of one question.
struct Pair {
    Vec3d wo, wi;
};

/// Answers that a sampler from outside gave; of a program, the time they took and the time it has in all, in s.
struct QueryUsage {
    std::uint64_t answers = 0;
    double seconds = 0, allowed = 0;  // allowed 0: it is never cut short
};

/// One density with its draws, or two where a pair of samples is weighed by MIS. Thread-safe unless `serial()`.
class SamplerAdapter {
public:
    virtual ~SamplerAdapter() = default;
    virtual std::string name() const = 0;
    virtual Traits traits() const { return {}; }
    virtual int techniques() const { return 1; }
    virtual void sample(int technique, Vec3d wo, std::span<const PrimarySample> u, std::span<Draw> out) const = 0;
    virtual void pdf(int technique, std::span<const Pair> at, std::span<double> out) const = 0;
    /// The same density in double where the sampler has one, for quadrature.
    virtual void exact_pdf(int technique, std::span<const Pair> at, std::span<double> out) const {
        pdf(technique, at, out);
    }
    /// MIS weight of a direction drawn by `technique`.
    virtual void mis_weight(int /*technique*/, std::span<const Pair> at, std::span<double> out) const {
        for (std::size_t i = 0; i < at.size(); ++i) out[i] = 1;
    }
    virtual bool has_f() const { return false; }
    virtual void f(std::span<const Pair> /*at*/, std::span<double> out) const {
        for (double& v : out) v = 0;
    }
    /// f by channel, where there are three; f is their luminance.
    virtual void f_channels(std::span<const Pair> at, std::span<Vec3d> out) const {
        std::vector<double> y(out.size());
        f(at, y);
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = {y[i], y[i], y[i]};
    }
    /// What f ought to be where that is known apart from f; the same as f elsewhere.
    virtual bool has_true_f() const { return false; }
    virtual void reference_f(std::span<const Pair> at, std::span<double> out) const { f(at, out); }
    /// f is known at the draws, though not elsewhere: their weights can be looked at, but compared with no integral.
    virtual bool has_drawn_f() const { return has_f(); }
    /// A tabulated p is known to this much there, 1/sr.
    virtual double tabulation_error(Vec3d /*w*/) const { return 0; }
    /// Whether the sampler can be asked for draws at any u, not only listed ones.
    virtual bool can_draw() const { return true; }
    /// What was asked of a sampler from outside so far; of a program, how long that took.
    virtual QueryUsage spending() const { return {}; }
    /// Told by what computes long between two questions, before so many steps: a page may answer its reader meanwhile.
    virtual void yield_to_host(std::size_t /*steps*/) const {}
    /// Only one thread may call.
    virtual bool serial() const { return false; }
    /// Each answer is worth something: it is asked no more often than TestSettings allows.
    virtual bool limited() const { return serial(); }
};

/// A sampler from outside that is called in this process: its answers are counted, and limited.
class InProcessAdapter : public SamplerAdapter {
public:
    bool limited() const override { return true; }
    QueryUsage spending() const override { return {answers_.load(std::memory_order_relaxed), 0, 0}; }

protected:
    void count(std::size_t answers) const { answers_.fetch_add(answers, std::memory_order_relaxed); }

private:
    mutable std::atomic<std::uint64_t> answers_{0};
};

/// A one-sided disk light: radiance, centre from the surface point and radius in m, unit normal.
struct CaseDiskLight {
    double radiance = 0;
    Vec3d center{}, normal{};
    double radius = 0;
    /// How far wi goes until it meets the emitting side.
    std::optional<double> distance(Vec3d wi) const;
};

/// A light of another kind, as scenes have it; the surface point is at 0. m.
struct CaseAreaLight {
    double radiance = 0;
    LightKinds::Any form;
    /// How far wi goes until it meets an emitting side.
    std::optional<double> distance(Vec3d wi) const;
    /// What it is worth choosing by, as in scenes: radiance times the area that it shows, over pi.
    double power() const;
};

/// Channel 0, 1 or 2 of a colour.
inline double channel_of(Vec3d c, int channel) { return channel == 0 ? c.x : channel == 1 ? c.y : c.z; }
inline double luminance(Vec3d c) { return output::luminance(Rgb{c.x, c.y, c.z}); }

/// What shines on the surface: an even fill of the upper hemisphere, and lights that hide it and one another.
struct CaseLighting {
    double fill = 1;  // radiance
    std::vector<CaseDiskLight> disks;
    std::vector<CaseAreaLight> area_lights{};              // that are no disks
    std::shared_ptr<const Surroundings> around{};          // a sky and emitting triangles; null: none
    Vec3d position{};                                      // of the surface point in the world of `around`, m
    Frame<double> frame{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  // of the surface point in that world
    bool even() const { return disks.empty() && area_lights.empty() && !around; }
    /// The nearest light that wi meets: how far it is and its radiance.
    struct Met {
        double distance, radiance;
    };
    std::optional<Met> first_met(Vec3d wi) const;
    /// Radiance from wi.
    double operator()(Vec3d wi) const;
};

/// Named parameter values, in the order in which they are told.
using Parameters = std::vector<std::pair<std::string, double>>;

/// One sampler at one w_o with one BRDF under one light.
struct CheckCase {
    std::string arm, brdf, lighting;
    Vec3d wo{};
    double theta_deg = 0, azimuth_deg = 0;
    Parameters parameters;
    CaseLighting light;
    ExpectedBehaviour theory;
    bool baseline = false;  // only its efficiency counts, for others to be ranked against
    std::shared_ptr<const SamplerAdapter> adapter;
    std::string text() const;  // "w_o 60 deg, s=32, Lambert + Phong, fill"
};

/// The text of a case whose sampler takes no w_o, and of one that never came to be judged.
inline constexpr std::string_view without_wo = "no w_o";
inline constexpr std::string_view before_any_case = "start";

/// The direction theta from n, phi from x, in degrees.
Vec3d tilt(double theta_deg, double azimuth_deg = 0);

// ---- A sampler that answers as another one does, but for what a class derived from it changes.

class ForwardingAdapter : public SamplerAdapter {
public:
    explicit ForwardingAdapter(std::shared_ptr<const SamplerAdapter> inner) : inner_(std::move(inner)) {}
    std::string name() const override { return inner_->name(); }
    Traits traits() const override { return inner_->traits(); }
    int techniques() const override { return inner_->techniques(); }
    void sample(int t, Vec3d wo, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        inner_->sample(t, wo, u, out);
    }
    void pdf(int t, std::span<const Pair> at, std::span<double> out) const override { inner_->pdf(t, at, out); }
    void exact_pdf(int t, std::span<const Pair> at, std::span<double> out) const override {
        inner_->exact_pdf(t, at, out);
    }
    void mis_weight(int t, std::span<const Pair> at, std::span<double> out) const override {
        inner_->mis_weight(t, at, out);
    }
    bool has_f() const override { return inner_->has_f(); }
    void f(std::span<const Pair> at, std::span<double> out) const override { inner_->f(at, out); }
    void f_channels(std::span<const Pair> at, std::span<Vec3d> out) const override { inner_->f_channels(at, out); }
    bool has_true_f() const override { return inner_->has_true_f(); }
    void reference_f(std::span<const Pair> at, std::span<double> out) const override { inner_->reference_f(at, out); }
    bool has_drawn_f() const override { return inner_->has_drawn_f(); }
    double tabulation_error(Vec3d w) const override { return inner_->tabulation_error(w); }
    bool can_draw() const override { return inner_->can_draw(); }
    QueryUsage spending() const override { return inner_->spending(); }
    void yield_to_host(std::size_t steps) const override { inner_->yield_to_host(steps); }
    bool serial() const override { return inner_->serial(); }
    bool limited() const override { return inner_->limited(); }

protected:
    const SamplerAdapter& inner() const { return *inner_; }

private:
    std::shared_ptr<const SamplerAdapter> inner_;
};

// ---- Draws that were made elsewhere, read from a file: judged as they are, since no more can be asked for.

class RecordedSampler : public SamplerAdapter {
public:
    bool can_draw() const override { return false; }
    std::size_t rows() const { return draws_.size(); }
    const Draw& row(std::size_t i) const { return draws_[i]; }
    const PrimarySample& row_numbers(std::size_t i) const { return u_[i]; }
    /// Where a row stands in the file, "samples.csv:17".
    virtual std::string place(std::size_t row) const = 0;
    void sample(int, Vec3d, std::span<const PrimarySample>, std::span<Draw> out) const override {
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = draws_[i % draws_.size()];
    }

protected:
    std::vector<PrimarySample> u_;
    std::vector<Draw> draws_;
};

// ---- A sampler that is asked no more often than it may be: a question beyond that is not put.

/// Throws SamplerTimeout in place of questions by which `inner` would have given more than `most` answers in all.
class LimitedAdapter : public ForwardingAdapter {
public:
    LimitedAdapter(std::shared_ptr<const SamplerAdapter> inner, std::uint64_t most)
        : ForwardingAdapter(std::move(inner)), most_(most) {}
    void sample(int t, Vec3d wo, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        allow(out.size());
        inner().sample(t, wo, u, out);
    }
    void pdf(int t, std::span<const Pair> at, std::span<double> out) const override {
        allow(out.size());
        inner().pdf(t, at, out);
    }
    void exact_pdf(int t, std::span<const Pair> at, std::span<double> out) const override {
        allow(out.size());
        inner().exact_pdf(t, at, out);
    }
    void f(std::span<const Pair> at, std::span<double> out) const override {
        allow(out.size());
        inner().f(at, out);
    }
    void f_channels(std::span<const Pair> at, std::span<Vec3d> out) const override {
        allow(out.size());
        inner().f_channels(at, out);
    }

private:
    std::uint64_t most_;
    void allow(std::size_t questions) const {
        if (spending().answers + questions > most_) throw SamplerTimeout("it may not be asked more");
    }
};

}  // namespace crescent::inline sources
