// The interface of a sampler, whatever its origin: built in, a program, a shared library, Python, a shader, a file, the
// page. It declares what it takes and returns, and answers queries in batches, so that a pipe is used efficiently.
// `crescent check` and `crescent run` call the same object. Local frame, n = +z, wo given, wi drawn, both leave the
// surface; pdf in 1/sr; f without the cosine, in 1/sr.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "samplers/evaluation_device.h"
#include "samplers/surface_context.h"
#include "samplers/traits.h"

namespace crescent {

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

/// The random numbers of a batch, a row for each sample: of a check as PrimarySample, of a run packed.
class NumberRows {
public:
    NumberRows() = default;
    NumberRows(std::span<const PrimarySample> samples) : samples_(samples) {}
    NumberRows(std::span<const double> packed, std::size_t columns) : packed_(packed), columns_(columns) {}

    std::size_t size() const { return columns_ > 0 ? packed_.size() / columns_ : samples_.size(); }
    double operator()(std::size_t row, std::size_t number) const {
        return columns_ > 0 ? packed_[row * columns_ + number] : samples_[row][static_cast<int>(number)];
    }
    /// Row by row, `columns` doubles each. `room` is filled if they are not stored so.
    std::span<const double> packed(std::size_t columns, std::vector<double>& room) const;
    /// As samples. `room` is filled if they are not stored so.
    std::span<const PrimarySample> samples(std::vector<PrimarySample>& room) const;

private:
    std::span<const PrimarySample> samples_{};
    std::span<const double> packed_{};
    std::size_t columns_ = 0;
};

/// A batch of questions of one kind.
struct SamplerQuery {
    enum class Kind {
        sample,
        pdf,
        exact_pdf,    // the same density in double if the sampler has it, for quadrature
        mis_weight,   // of a direction drawn by `technique`
        f,            // for three channels: their luminance
        f_channels,   // by channel
        target,       // of random weights, over solid angle; f may be a bounded function of it
        reference_f,  // f as it is known independently of the sampler
        weigh,        // the weight of each of K samplers, [row][K]
    };
    Kind kind = Kind::sample;
    int technique = 0;
    Vec3d wo{};                           // of every sample, where `scene` is null
    NumberRows u{};                       // of kind sample: a row each
    std::span<const Pair> pairs{};        // of the other kinds: a row each
    const SceneRows* scene = nullptr;     // the surface points of a run; null: the example of a check
    std::span<const double> densities{};  // of weigh: of each of K samplers, [row][K]

    std::size_t rows() const { return kind == Kind::sample ? u.size() : pairs.size(); }
    /// Whether the answers cost a call of the user's functions.
    bool is_counted() const { return kind <= Kind::exact_pdf || kind == Kind::f || kind == Kind::f_channels; }
};

/// Where the answers go, a row each: `draws` of kind sample, `channels` of f_channels, `values` of the others.
struct SamplerAnswers {
    std::span<Draw> draws{};
    std::span<double> values{};
    std::span<Vec3d> channels{};
};

/// What a sampler says of itself.
struct SamplerDeclaration {
    std::string name;
    Traits traits{};
    /// The names of its densities, "" for one without a name: two or more if MIS combines samples of several.
    std::vector<std::string> techniques = {""};
    bool has_f = false;
    bool has_drawn_f = false;         // f is known at the draws: if only there, its integral is not
    bool has_true_f = false;          // a reference value of f is known independently of f
    bool weighs = false;              // it gives the weights of a multiple importance sampling instead of drawing
    bool can_draw = true;             // for any u, not only recorded ones
    bool serial = false;              // only one thread may call
    bool limited = false;             // answers are expensive, so that TestSettings limits their number
    std::vector<std::string> uses{};  // quantities of a surface point that it takes, of context_names()
    std::size_t batch_rows = 8192;    // of a run at most; the default stays in the cache of a core
    bool costly_query = false;        // whatever its number of rows: a check asks in larger batches
    EvaluationDevice device{};

    bool uses_lights() const;
};

/// Number of answers of an external sampler; for a program, the time they took and its total time limit, in s.
struct QueryUsage {
    std::uint64_t answers = 0;
    double seconds = 0, allowed = 0;  // allowed 0: no limit
};

/// Thread-safe unless it is declared as serial.
class SamplerAdapter {
public:
    virtual ~SamplerAdapter() = default;
    virtual SamplerDeclaration declaration() const = 0;
    /// Throws SamplerError if the sampler does not answer.
    virtual void evaluate(const SamplerQuery& query, const SamplerAnswers& out) const = 0;
    /// What an external sampler has answered so far.
    virtual QueryUsage spending() const { return {}; }
    /// The error of a tabulated p, 1/sr.
    virtual double tabulation_error(Vec3d /*w*/) const { return 0; }

    std::string name() const { return declaration().name; }
    Traits traits() const { return declaration().traits; }
    int techniques() const { return static_cast<int>(declaration().techniques.size()); }
    std::string technique_name(int technique) const {
        return declaration().techniques[static_cast<std::size_t>(technique)];
    }
    bool has_f() const { return declaration().has_f; }
    bool has_drawn_f() const { return declaration().has_drawn_f; }
    bool has_true_f() const { return declaration().has_true_f; }
    bool can_draw() const { return declaration().can_draw; }
    bool serial() const { return declaration().serial; }
    bool limited() const { return declaration().limited; }

    /// One draw for each row of u.
    void sample(int technique, Vec3d wo, std::span<const PrimarySample> u, std::span<Draw> out) const {
        evaluate({.kind = SamplerQuery::Kind::sample, .technique = technique, .wo = wo, .u = u}, {.draws = out});
    }
    /// The answers of one kind for each pair.
    void values(SamplerQuery::Kind kind, int technique, std::span<const Pair> pairs, std::span<double> out) const {
        evaluate({.kind = kind, .technique = technique, .pairs = pairs}, {.values = out});
    }
    void pdf(int technique, std::span<const Pair> pairs, std::span<double> out) const {
        values(SamplerQuery::Kind::pdf, technique, pairs, out);
    }
    void exact_pdf(int technique, std::span<const Pair> pairs, std::span<double> out) const {
        values(SamplerQuery::Kind::exact_pdf, technique, pairs, out);
    }
    void mis_weight(int technique, std::span<const Pair> pairs, std::span<double> out) const {
        values(SamplerQuery::Kind::mis_weight, technique, pairs, out);
    }
    void f(std::span<const Pair> pairs, std::span<double> out) const { values(SamplerQuery::Kind::f, 0, pairs, out); }
    void f_channels(std::span<const Pair> pairs, std::span<Vec3d> out) const {
        evaluate({.kind = SamplerQuery::Kind::f_channels, .pairs = pairs}, {.channels = out});
    }
    void target(std::span<const Pair> pairs, std::span<double> out) const {
        values(SamplerQuery::Kind::target, 0, pairs, out);
    }
    void reference_f(std::span<const Pair> pairs, std::span<double> out) const {
        values(SamplerQuery::Kind::reference_f, 0, pairs, out);
    }
};

/// A sampler in this process with a function for each kind of query. In a run it is asked run by run.
class SamplerSource : public SamplerAdapter {
public:
    virtual std::string name() const = 0;
    virtual Traits traits() const { return {}; }
    virtual int techniques() const { return 1; }
    virtual std::string technique_name(int /*technique*/) const { return ""; }
    virtual bool has_f() const { return false; }
    virtual bool has_drawn_f() const { return has_f(); }
    virtual bool has_true_f() const { return false; }
    virtual bool can_draw() const { return true; }
    virtual bool serial() const { return false; }
    virtual bool limited() const { return serial(); }

    virtual void sample(int technique, Vec3d wo, std::span<const PrimarySample> u, std::span<Draw> out) const = 0;
    virtual void pdf(int technique, std::span<const Pair> pairs, std::span<double> out) const = 0;
    virtual void exact_pdf(int technique, std::span<const Pair> pairs, std::span<double> out) const {
        pdf(technique, pairs, out);
    }
    virtual void mis_weight(int technique, std::span<const Pair> pairs, std::span<double> out) const;
    virtual void f(std::span<const Pair> pairs, std::span<double> out) const;
    /// f in every channel, unless there are three.
    virtual void f_channels(std::span<const Pair> pairs, std::span<Vec3d> out) const;
    virtual void target(std::span<const Pair> pairs, std::span<double> out) const { f(pairs, out); }
    virtual void reference_f(std::span<const Pair> pairs, std::span<double> out) const { f(pairs, out); }

    SamplerDeclaration declaration() const override;
    void evaluate(const SamplerQuery& query, const SamplerAnswers& out) const override;
};

/// The same for a user's sampler: its answers are counted and limited.
class InProcessAdapter : public SamplerSource {
public:
    bool limited() const override { return true; }
    QueryUsage spending() const override { return {answers_.load(std::memory_order_relaxed), 0, 0}; }

protected:
    void count(std::size_t answers) const { answers_.fetch_add(answers, std::memory_order_relaxed); }

private:
    mutable std::atomic<std::uint64_t> answers_{0};
};

/// A sampler whose queries pass through one function, and whose declaration may differ.
class DecoratedSampler : public SamplerAdapter {
public:
    /// Answers a query with the help of the inner sampler.
    using Evaluate =
        std::function<void(const SamplerAdapter& inner, const SamplerQuery& query, const SamplerAnswers& out)>;
    using Declare = std::function<void(SamplerDeclaration& declaration)>;
    /// Without a function: as the inner sampler.
    DecoratedSampler(std::shared_ptr<const SamplerAdapter> inner, Evaluate evaluate, Declare declare = {})
        : inner_(std::move(inner)), evaluate_(std::move(evaluate)), declare_(std::move(declare)) {}
    SamplerDeclaration declaration() const override;
    void evaluate(const SamplerQuery& query, const SamplerAnswers& out) const override;
    QueryUsage spending() const override { return inner_->spending(); }
    double tabulation_error(Vec3d w) const override { return inner_->tabulation_error(w); }

protected:
    const SamplerAdapter& inner() const { return *inner_; }

private:
    std::shared_ptr<const SamplerAdapter> inner_;
    Evaluate evaluate_;
    Declare declare_;
};

/// The samplers of an experiment's arms that are not built in, by arm.
using ExternalSamplers = std::map<std::string, std::shared_ptr<const SamplerAdapter>, std::less<>>;
/// Returns null if the arm is built in.
inline const SamplerAdapter* external_of(const ExternalSamplers& samplers, std::string_view arm) {
    const auto match = samplers.find(arm);
    return match == samplers.end() ? nullptr : match->second.get();
}

/// A sampler as the kernels take it: a name of the list in all.h, or one that is not built in, which takes precedence.
struct SamplerRef {
    std::string_view sampler;
    const SamplerAdapter* outside = nullptr;
    SamplerRef(std::string_view word, const SamplerAdapter* from = nullptr) : sampler(word), outside(from) {}
    SamplerRef(const std::string& word) : sampler(word) {}
    SamplerRef(const char* word) : sampler(word) {}
};

}  // namespace crescent
