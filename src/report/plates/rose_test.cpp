// The plate `rose`: the peaks that it states, for built-in and external samplers.
#include <gtest/gtest.h>

#include <algorithm>

#include "report/plates/sheet.h"
#include "tests/support/test_world.h"

namespace crescent::plates {
namespace rose_test {

using plates::World;

TEST(Rose, StatesThePeaksOfTheDensities) {
    World world(96, 54);
    PlatePlan plan;
    plan.kind = PlateKind::rose;
    plan.runs = {{"cosine", 0, 0}, {"phong", 0, 0}};
    std::vector<Setting> settings = world.settings(plan);
    EXPECT_TRUE(has(settings, "peak 0.318 sr"));  // 1/pi
    EXPECT_TRUE(has(settings, "peak 5.25 sr"));   // 33/(2 pi)
    EXPECT_TRUE(has(settings, "= 16.5 × cosine"));
}

/// cos / pi as an external sampler, or a sampler that cannot return its density.
struct ExternalCosine : SamplerSource {
    bool asked = true;
    std::string name() const override { return "cosine"; }
    Traits traits() const override { return {.has_pdf = asked}; }
    void sample(int, Vec3d, std::span<const PrimarySample>, std::span<Draw>) const override {}
    void pdf(int, std::span<const Pair> pairs, std::span<double> out) const override {
        for (std::size_t i = 0; i < pairs.size(); ++i) out[i] = std::max(pairs[i].wi.z, 0.0) / pi;
    }
};

TEST(Rose, AsksAnArmFromOutsideForItsDensity) {
    World world(96, 54);
    world.add_arm("mine", "");
    PlatePlan plan;
    plan.kind = PlateKind::rose;
    plan.runs = {{"mine", 0, 0}};
    ExternalCosine mine;
    PlateInputs in = world.inputs();
    in.external_sampler = [&](const std::string& arm) { return arm == "mine" ? &mine : nullptr; };
    const auto says = [&](const char* text) {
        Sheet sheet(plan, in);
        draw(sheet);
        return has(sheet.canvas.settings(), text);
    };
    EXPECT_TRUE(says("peak 0.318 sr"));
    mine.asked = false;
    EXPECT_TRUE(says("a library without crescent_sampler_pdf"));
    in.external_sampler = {};
    EXPECT_TRUE(says("density cannot be evaluated"));
}

}  // namespace rose_test
}  // namespace crescent::plates
