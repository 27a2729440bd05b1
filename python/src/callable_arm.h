// A vectorised Python callable as an arm of an experiment: draw(wo[n,3], u[n,k], context) -> (wi[n,3], pdf[n], ...).
//
// `context` is a dict of arrays, one row a row of u: those of s, alpha, rho_d and rho_s that the sampler uses, and
// for lights `position`, `normal`, `edge_u`, `edge_v` [n,K,3], `shines` [n,K] and the constants `kind` (a list of K
// texts), `radius` [K] and `radiance` [K,3]. crescent/_context.py makes it from a sampler's own callable.
#pragma once

#include <set>
#include <string>

#include "watched.h"

namespace crescent::python {

struct CallableArmPlan {
    std::string name;
    nb::object draw;
    int numbers = 2;
    std::set<std::string> uses{};  // of the quantities above
    bool serial = false;           // it wants one thread, the caller's own
};

/// Called by any thread, with the interpreter's lock held for the call alone. What the callable raises stops the run
/// and is raised again at its end.
class CallableArm : public ExternalSampler {
public:
    CallableArm(CallableArmPlan plan, Raised& raised) : plan_(std::move(plan)), raised_(raised) {}
    std::string name() const override { return plan_.name; }
    int numbers() const override { return plan_.numbers; }
    std::size_t batch_rows() const override { return 32768; }
    bool uses_lights() const override { return plan_.uses.contains("lights"); }
    void draw(const ExternalBatch& batch, const ExternalDraws& out) const override;

private:
    CallableArmPlan plan_;
    Raised& raised_;
};

}  // namespace crescent::python
