// Whole runs: what the meters read off GL films is what they read off the CPU's, within 1 % of the band that the seeds
// span.
#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "test_scene.h"

namespace crescent::gl {
namespace {

Experiment metered_scene() {
    return parse(std::string(test::scene_text) + R"(
[regions.balls]
box = [20, 24, 76, 44]
[regions.ground]
box = [4, 4, 90, 16]
)",
        "metered.toml", {"seeds=8", "n=64", "arms.phong.n=[4,16,64]"});
}

RunResult run_with(const std::shared_ptr<Instrument>& instrument) {
    const std::filesystem::path out =
        std::filesystem::temp_directory_path() / ("crescent-gl-" + std::to_string(::getpid()));
    RunOptions options;
    options.out = out.string();
    options.instrument = instrument;
    Watch watch;
    RunResult result = run(metered_scene(), options, watch);
    std::filesystem::remove_all(out);
    return result;
}

TEST(MeterLaw, EveryMeterOfARunIsTheCpusWithinOnePercentOfItsBand) {
    const RunResult cpu = run_with(nullptr), gl = run_with(find_instrument("gl")->open({}));
    ASSERT_EQ(cpu.metrics.bands.size(), gl.metrics.bands.size());
    ASSERT_GT(cpu.metrics.bands.size(), 20u);
    for (std::size_t k = 0; k < cpu.metrics.bands.size(); ++k) {
        const BandMeter &a = cpu.metrics.bands[k], &b = gl.metrics.bands[k];
        // Meters that no seed changes have a band of no width: rounding of the films' floats is left to them.
        const double allowed = 0.01 * (a.band.q95 - a.band.q05) + 1e-6 * std::abs(a.measured);
        EXPECT_NEAR(b.measured, a.measured, allowed) << to_string(a.key) << " " << a.meter;
        EXPECT_NEAR(b.band.median, a.band.median, allowed) << to_string(a.key) << " " << a.meter;
    }
    EXPECT_TRUE(gl.metrics.all_hold());
    EXPECT_EQ(gl.metrics.assertions.size(), cpu.metrics.assertions.size() + 8) << "the GL's own claims join";
    EXPECT_EQ(gl.provenance.instrument_details.size(), 3u);
    EXPECT_TRUE(cpu.provenance.instrument_details.empty());
}

}  // namespace
}  // namespace crescent::gl
