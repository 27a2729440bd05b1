// Causes of random weights W: a reservoir of two candidates, one of which may have no target.
#include "check/explain/reciprocal_weights.h"

#include <gtest/gtest.h>

#include "check/explain/causes.h"
#include "check/sources/reciprocal_weights.h"
#include "tests/support/explained.h"

namespace crescent::check {
namespace reciprocal_weights_test {

double target_of(Vec3d w) { return w.z > 0 && w.x > 0 ? w.z * (0.2 + w.y * w.y) : 0; }

/// RIS of two candidates that are uniform over the hemisphere.
struct Reservoir : FunctionSampler {
    bool counts_all = true;
    std::function<double(Vec3d)> factor = [](Vec3d) { return 1.0; };
    void sample(int, Vec3d, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        for (std::size_t i = 0; i < u.size(); ++i) {
            const Vec3d a = from_chart({u[i][0], two_pi * u[i][1]}), b = from_chart({u[i][2], two_pi * u[i][3]});
            const double wa = target_of(a) * two_pi, wb = target_of(b) * two_pi;
            const Vec3d kept = u[i][4] * (wa + wb) < wa ? a : b;
            const double m = counts_all ? 2 : (wa > 0) + (wb > 0);
            out[i] = Draw{kept, 1};
            out[i].weight = wa + wb > 0 ? (wa + wb) / m / target_of(kept) * factor(kept) : 0;
            out[i].weights = {*out[i].weight, 0, 0};
        }
    }
};

Explained explained_reservoir(Reservoir made) {
    made.of.numbers = 5;
    made.of.reciprocal_weight = true;
    made.of.has_pdf = false;
    made.f_value = [](Vec3d, Vec3d w) { return target_of(w); };
    Explained out;
    CheckCase& t = out.check_cases.emplace_back();
    t.arm = "made";
    t.wo = {0, 0, 1};
    t.adapter = with_bounded_weights(std::make_shared<Reservoir>(std::move(made)));
    CheckSettings settings;
    settings.budget = CheckBudget::limited();
    ProgressMonitor monitor;
    out.outcomes = check_samplers(out.check_cases, settings, monitor);
    if (out.wrong()) out.cause = cause_of(out.check_cases, out.outcomes[0]);
    return out;
}

TEST(ReciprocalWeights, AreRightWithAllCandidates) { EXPECT_FALSE(explained_reservoir({}).wrong()); }

TEST(ReciprocalWeights, CountOnlyCandidatesWithATarget) {
    Reservoir made;
    made.counts_all = false;
    const Explained r = explained_reservoir(std::move(made));
    expect_cause(r, "constant");
    EXPECT_NEAR(r.cause->exponent, 1.5, 0.02);
    EXPECT_NE(r.text().find("uniform over the hemisphere or by the cosine a share of 0.5 has a target above 0"),
        std::string::npos)
        << r.text();
}

TEST(ReciprocalWeights, LackAFactor) {
    Reservoir made;
    made.factor = [](Vec3d) { return 0.97; };
    Explained r = explained_reservoir(made);
    expect_cause(r, "constant");
    EXPECT_NEAR(r.cause->exponent, 0.97, 0.01);
    made.factor = [](Vec3d w) { return w.z; };
    r = explained_reservoir(made);
    expect_cause(r, "cos theta_i");
    made.factor = [](Vec3d w) { return target_of(w); };
    r = explained_reservoir(made);
    expect_cause(r, "target");
}

TEST(ReciprocalWeights, AreNotExplainedByAnyFactor) {
    Reservoir made;
    made.factor = [](Vec3d w) { return w.y > 0 ? 1.1 : 0.95; };
    const Explained r = explained_reservoir(std::move(made));
    EXPECT_TRUE(r.wrong());
    EXPECT_FALSE(r.cause) << r.text();
}

}  // namespace reciprocal_weights_test
}  // namespace crescent::check
