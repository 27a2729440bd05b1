// The pictures of a view: which there are, their size, and the scale of their differences.
#include "compare/suite/pictures.h"

#include <gtest/gtest.h>
#include <png.h>

#include "compare/suite/suite.h"
#include "tests/support/memory_renders.h"

namespace crescent {
namespace pictures_test {

/// A grey ramp of 64 x 4 pixels from 0 on, times a factor.
std::vector<float> ramp(float factor) {
    std::vector<float> out(64 * 4);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = factor * static_cast<float>(i % 64);
    return out;
}

std::vector<unsigned char> pixels_of(const std::vector<unsigned char>& png) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    EXPECT_TRUE(png_image_begin_read_from_memory(&image, png.data(), png.size())) << image.message;
    image.format = PNG_FORMAT_RGB;
    std::vector<unsigned char> out(PNG_IMAGE_SIZE(image));
    EXPECT_TRUE(png_image_finish_read(&image, nullptr, out.data(), 0, nullptr)) << image.message;
    return out;
}

TEST(SuitePictures, OfOneSideShowItsFirstRender) {
    const Suite suite;
    RenderSource source;
    source.read = [](const std::string& path, const std::string&) { return Render(path, 1600, 8); };
    ViewResult added, missing;
    SuiteView only_candidate, only_baseline;
    only_candidate.candidate = {"c"};
    only_baseline.baseline = {"b"};
    picture_one_side(suite, only_candidate, source, added);
    picture_one_side(suite, only_baseline, source, missing);
    EXPECT_EQ(added.width, 1600);
    EXPECT_LE(added.pictures.width, 800);
    EXPECT_TRUE(added.pictures.baseline.empty());
    EXPECT_FALSE(added.pictures.candidate.empty());
    EXPECT_FALSE(missing.pictures.baseline.empty());
    EXPECT_TRUE(missing.pictures.candidate.empty());
}

std::pair<RenderStats, BiasResult> a_ramp_and_a_brighter_one() {
    MemoryRenders m;
    m.put_grey("a", 64, ramp(1));
    m.put_grey("b", 64, ramp(1.5f));
    BiasResult means;
    means.arm_a = 1;
    means.arm_b = 0;
    return {m.read(), means};
}

TEST(SuitePictures, DifferencesAreRelativeToTheBrightness) {
    auto [all, means] = a_ramp_and_a_brighter_one();
    ViewResult out;
    out.smallest = 0.01;
    picture_both_sides({}, all, means, out);
    EXPECT_EQ(out.pictures.width, 64);
    EXPECT_EQ(out.pictures.height, 4);
    // In the brightest column 0.5 / 1.25, less by a hundredth of the mean brightness 1.25 x 31.5 over 1.25 x 63.
    EXPECT_NEAR(out.pictures.scale, 0.4 / 1.005, 2e-4);
    out.smallest = 0.1;
    picture_both_sides({}, all, means, out);
    EXPECT_DOUBLE_EQ(out.pictures.scale, 0.5);  // five times the difference that must be found
}

TEST(SuitePictures, SignificanceIsShownWhereNoiseDoesNotExplainIt) {
    auto [all, means] = a_ramp_and_a_brighter_one();
    ViewResult out;
    picture_both_sides({}, all, means, out);
    EXPECT_TRUE(out.pictures.significance.empty());  // nothing differs
    const std::size_t count = all.tiles.count();
    ASSERT_GT(count, 2u);
    means.tiles.p.assign(count, 0.5);
    means.tiles.quantity.assign(count, 0);
    means.tiles.differs.assign(count, false);
    means.tiles.difference = {std::vector<double>(count, 1)};
    means.tiles.p[0] = 1e-20;
    means.tiles.differs[0] = true;
    means.tiles.different = 1;
    means.tiles.p[1] = std::nan("");
    picture_both_sides({}, all, means, out);
    const std::vector<unsigned char> image = pixels_of(out.pictures.significance);
    const auto red = [&](int x) { return image[3 * static_cast<std::size_t>(x)]; };
    const int side = all.tiles.size;
    EXPECT_GT(red(0), red(2 * side));     // the candidate is brighter there
    EXPECT_NE(red(side), red(2 * side));  // not tested
    EXPECT_EQ(red(2 * side), red(63));
}

TEST(SuitePictures, TheNoiseIsShownWhereItDiffers) {
    auto [all, means] = a_ramp_and_a_brighter_one();
    ViewResult out;
    picture_both_sides({}, all, means, out);
    NoiseResult noise;
    const std::size_t count = all.tiles.count();
    noise.log2_ratio.assign(count, 2);
    noise.distinguished.assign(count, false);
    picture_noise(all, noise, out);
    EXPECT_TRUE(out.pictures.noise.empty());
    noise.distinguished[0] = true;
    noise.log2_ratio[1] = std::nan("");
    picture_noise(all, noise, out);
    const std::vector<unsigned char> image = pixels_of(out.pictures.noise);
    const auto red = [&](int x) { return image[3 * static_cast<std::size_t>(x)]; };
    const int side = all.tiles.size;
    EXPECT_GT(red(0), red(2 * side));     // more noise there
    EXPECT_NE(red(side), red(2 * side));  // no variance
    EXPECT_EQ(red(2 * side), red(63));
}

TEST(SuitePictures, OfManyViewsAreSmaller) {
    MemoryRenders m;
    m.put("a", 1, 400);
    m.put("b", 2, 400);
    const RenderStats all = m.read();
    BiasResult means;
    means.arm_a = 1;
    means.arm_b = 0;
    const auto width = [&](std::size_t views) {
        Suite suite;
        suite.views.resize(views);
        ViewResult out;
        picture_both_sides(suite, all, means, out);
        const ViewPictures& p = out.pictures;
        EXPECT_LE(p.baseline.size() + p.candidate.size() + p.difference.size(), 36'000'000 / views);
        return p.width;
    };
    EXPECT_EQ(width(1), 400);
    EXPECT_LT(width(300), 400);
}

}  // namespace pictures_test
}  // namespace crescent
