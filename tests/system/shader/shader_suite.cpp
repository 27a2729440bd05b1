// Shaders in a GoogleTest suite, as users write theirs; tests/system/shader.sh runs it in the folder of the shaders.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "crescent/gtest.h"

namespace {

using crescent::IsARightSamplerBy;
using crescent::shader_sampler;

const crescent::TestSettings at_40{.wo = {{40, 0}}};

TEST(Right, Ggx) {
    EXPECT_THAT(shader_sampler("lobes.wgsl",
                    {.sample = "wi = ggx_sample(wo, u, alpha)",
                        .pdf = "ggx_pdf(wo, wi, alpha)",
                        .f = "ggx_f(wo, wi, alpha)",
                        .set = {{"alpha", 0.3}}}),
        IsARightSamplerBy(at_40));
}

TEST(Wrong, Ggx) {
    EXPECT_THAT(shader_sampler("lobes.wgsl",
                    {.sample = "wi = ggx_sample(wo, u, 0.3)", .pdf = "ggx_pdf(wo, wi, 0.3) * 1.03", .name = "mine"}),
        IsARightSamplerBy(at_40));
}

TEST(Mistake, HasItsPlace) {
    EXPECT_THAT(shader_sampler("lobes.wgsl", {.sample = "wi = ggx_sampel(wo, u, 0.3)", .pdf = "1.0"}),
        IsARightSamplerBy(at_40));
}

}  // namespace
