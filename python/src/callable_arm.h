// A vectorised Python callable as an arm of an experiment: draw(wo[n,3], u[n,k], context) -> (wi[n,3], pdf[n], ...).
//
// pdf(wo[n,3], wi[n,3], context) -> [n] is needed by combinations alone.
//
// `context` is a dict of arrays, one row a row of u: those of s, alpha, rho_d and rho_s that the sampler uses, and
// for lights `position`, `normal`, `edge_u`, `edge_v` [n,K,3], `shines` [n,K] and the constants `kind` (a list of K
// texts), `radius` [K] and `radiance` [K,3]. crescent/_context.py makes it from a sampler's own callable.
#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "watched.h"

namespace crescent::python {

struct CallableArmPlan {
    std::string name;
    nb::object draw, pdf;  // pdf may be None
    nb::object weights{};  // of a combination, weights(wo, wi, {..., "p": [n,K]}) -> [n,K], in their place; or None
    int numbers = 2;
    std::set<std::string> uses{};  // of the quantities above
    bool serial = false;           // it wants one thread, the caller's own
};

/// Called by any thread, with the interpreter's lock held for the call alone. What the callable raises stops the run
/// and is raised again at its end.
class CallableArm : public ExternalSampler {
public:
    explicit CallableArm(CallableArmPlan plan)
        : plan_(std::move(plan)), has_density_(!plan_.pdf.is_none()), has_weights_(!plan_.weights.is_none()) {}
    /// Receives exceptions of the callables; must be set during a run or a check.
    void set_raised(Raised* raised) const { raised_ = raised; }
    bool serial() const { return plan_.serial; }
    std::string name() const override { return plan_.name; }
    int numbers() const override { return plan_.numbers; }
    std::size_t batch_rows() const override { return 32768; }
    bool uses_lights() const override { return plan_.uses.contains("lights"); }
    void draw(const ExternalBatch& batch, const ExternalDraws& out) const override;
    bool has_density() const override { return has_density_; }
    void density(const ExternalBatch& batch, std::span<const Vec3d> wi, std::span<double> out) const override;
    bool has_weights() const override { return has_weights_; }
    void weigh(const ExternalBatch& batch, std::span<const Vec3d> wi, std::span<const double> p,
        std::span<double> out) const override;

private:
    CallableArmPlan plan_;
    bool has_density_, has_weights_;  // readable without the lock
    mutable Raised* raised_ = nullptr;
};

/// (arm, draw, pdf, weights, numbers, uses, serial) of each arm whose sampler, or whose weights, are a callable.
using CallableArms =
    std::vector<std::tuple<std::string, nb::object, nb::object, nb::object, int, std::vector<std::string>, bool>>;

/// The samplers of these arms.
inline std::map<std::string, std::shared_ptr<const CallableArm>> samplers_of(const CallableArms& callables) {
    std::map<std::string, std::shared_ptr<const CallableArm>> out;
    for (const auto& [name, draw, pdf, weights, numbers, uses, one_thread] : callables)
        out[name] = std::make_shared<CallableArm>(
            CallableArmPlan{name, draw, pdf, weights, numbers, {uses.begin(), uses.end()}, one_thread});
    return out;
}

}  // namespace crescent::python
