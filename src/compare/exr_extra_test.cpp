// Variances, sample counts and times by their names, of parts that are in no file.
#include "compare/exr_extra.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace crescent {
namespace exr_extra_test {

using ::testing::ElementsAre;
using Kind = ExrExtra::Kind;

ExrPart part(const std::vector<std::string>& channels) {
    ExrPart out;
    for (const std::string& name : channels) out.channels.emplace_back().name = name;
    return out;
}

TEST(ExrVariance, HasTheKindOfItsLayer) {
    EXPECT_EQ(exr_extra(part({"R", "G", "B"})).kind, Kind::none);
    const ExrExtra variance = exr_extra(part({"variance.R", "variance.G", "variance.B", "Debug Sample Count.X"}));
    EXPECT_EQ(variance.kind, Kind::variance);
    EXPECT_THAT(variance.spread, ElementsAre("variance.R", "variance.G", "variance.B"));
    EXPECT_EQ(variance.samples, "Debug Sample Count.X");
    EXPECT_EQ(exr_extra(part({"stddev.Y"})).kind, Kind::error);
    EXPECT_EQ(exr_extra(part({"Variance.Y", "RelativeVariance.Y"})).kind, Kind::of_samples);
    const ExrExtra moments = exr_extra(part({"nested.Y", "m2_nested.Y"}));
    EXPECT_EQ(moments.kind, Kind::moments);
    EXPECT_THAT(moments.spread, ElementsAre("m2_nested.Y", "nested.Y"));
    EXPECT_EQ(exr_extra(part({"variance.u"})).kind, Kind::none);  // of no colour
}

TEST(ExrVariance, OfYIsOfFullyCorrelatedChannels) {
    const auto variance = [](Kind kind, const std::vector<std::vector<float>>& planes) {
        Render out("r", 1, 1);
        ExrExtra extra;
        extra.kind = kind;
        extra.spread.resize(planes.size());
        set_variance(out, extra, planes);
        EXPECT_EQ(out.per_sample, kind == Kind::of_samples || kind == Kind::moments);
        return static_cast<double>(out.variance.at(0));
    };
    const double deviation = 0.2126 * 1 + 0.7152 * 2 + 0.0722 * 3;
    EXPECT_NEAR(variance(Kind::variance, {{1}, {4}, {9}}), deviation * deviation, 1e-6);
    EXPECT_NEAR(variance(Kind::error, {{1}, {2}, {3}}), deviation * deviation, 1e-6);
    EXPECT_EQ(variance(Kind::of_samples, {{5}}), 5);
    EXPECT_EQ(variance(Kind::variance, {{-1}}), 0);
    EXPECT_EQ(variance(Kind::moments, {{13}, {3}}), 4);
    EXPECT_EQ(variance(Kind::moments, {{8}, {3}}), 0);  // below 0 by rounding
}

TEST(ExrSamples, AreTheMeanOfCountsAndNotOfShares) {
    const auto spp = [](const std::vector<float>& plane, std::optional<double> stated = {}) {
        Render out("r", 2, 1);
        out.spp = stated;
        set_samples(out, {Kind::none, {}, "samples"}, plane);
        return out.spp;
    };
    EXPECT_EQ(spp({16, 64}), 40);
    EXPECT_EQ(spp({16, 64}, 32), 32);  // an attribute is exact
    EXPECT_EQ(spp({0.25f, 1}), std::nullopt);
    EXPECT_THROW((void)spp({16, -1}), InputError);
    EXPECT_THROW((void)spp({16, std::numeric_limits<float>::infinity()}), InputError);
}

TEST(ExrAttributes, AreNumbersOrTimesOfAnyRenderer) {
    const auto seconds = [](const ExrAttribute& attribute) {
        ExrPart of;
        of.attributes = {{"samples", 9.0, "", {}}, attribute};
        return exr_attribute("r", of, "a time", {"rendertime"});
    };
    EXPECT_EQ(seconds({"RenderTime", 2.5, "", {}}), 2.5);
    EXPECT_EQ(seconds({"cycles.ViewLayer.render_time", {}, "01:02:03.5", {}}), 3723.5);
    EXPECT_EQ(seconds({"arnold/render time", {}, "7s", {}}), 7);
    EXPECT_EQ(seconds({"renderTime", {}, "soon", {}}), std::nullopt);
    EXPECT_EQ(seconds({"renderTime", 0.0, "", {}}), std::nullopt);
    EXPECT_EQ(seconds({"renderTimeLimit", 5.0, "", {}}), std::nullopt);
    EXPECT_THROW((void)seconds({"renderTime", -1.0, "", {}}), InputError);
}

}  // namespace exr_extra_test
}  // namespace crescent
