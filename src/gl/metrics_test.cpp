// Whole runs: the metrics of GL films equal those of the CPU's, within 1 % of the band over seeds.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/gl_test_scene.h"

namespace crescent::gl {
namespace metrics_test {

Experiment metered_scene() {
    return parse(std::string(test::scene_text) + R"(
[regions.balls]
box = [20, 24, 76, 44]
[regions.ground]
box = [4, 4, 90, 16]
)",
        "metered.toml", {"seeds=8", "n=64", "arms.phong.n=[4,16,64]"});
}

Measured measured_with(const std::shared_ptr<Backend>& backend) {
    ProgressMonitor monitor;
    RunOptions options;
    options.backend = backend;
    return measure_in_memory(metered_scene(), options, monitor);
}

TEST(MetricsAgreement, EveryMetricMatchesTheCpu) {
    const Measured cpu = measured_with(nullptr), gl = measured_with(find_backend("gl")->open({}));
    ASSERT_EQ(cpu.metrics.bands.size(), gl.metrics.bands.size());
    ASSERT_GT(cpu.metrics.bands.size(), 20u);
    for (std::size_t k = 0; k < cpu.metrics.bands.size(); ++k) {
        const SeedSpread &a = cpu.metrics.bands[k], &b = gl.metrics.bands[k];
        // Metrics that do not depend on the seed have a band of zero width; the rounding of the films' floats is
        // allowed for them.
        const double allowed = 0.01 * (a.band.q95 - a.band.q05) + 1e-6 * std::abs(a.measured);
        EXPECT_NEAR(b.measured, a.measured, allowed) << to_string(a.key) << " " << a.metric;
        EXPECT_NEAR(b.band.median, a.band.median, allowed) << to_string(a.key) << " " << a.metric;
    }
    EXPECT_TRUE(gl.metrics.all_hold());
    EXPECT_EQ(gl.metrics.assertions.size(), cpu.metrics.assertions.size() + 8) << "the GL's own claims join";
    EXPECT_EQ(gl.provenance.backend_details.size(), 3u);
    EXPECT_TRUE(cpu.provenance.backend_details.empty());
}

}  // namespace metrics_test
}  // namespace crescent::gl
