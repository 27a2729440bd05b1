// The preview: every box of the experiment is listed as it is written, marked at its place, and nothing exceeds the
// sheet.
#include <gtest/gtest.h>

#include <algorithm>

#include "report/plates/sheet.h"
#include "tests/support/test_world.h"

namespace crescent::plates {
namespace preview_test {

struct Drawn {
    std::vector<Setting> settings;
    Picture picture;
    std::string notes;
};

Drawn drawn(const World& world) {
    const PlateInputs in = world.inputs();
    const PlatePlan plan = preview_plan(world.e);
    Sheet sheet(plan, in);
    paint_preview(sheet);
    std::string notes;
    for (const std::string& note : sheet.notes) notes += note + "\n";
    return {sheet.canvas.settings(), sheet.canvas.picture(), notes};
}

long count_of(const Drawn& d, const std::string& words) {
    return std::ranges::count_if(d.settings, [&](const Setting& s) { return s.text.find(words) != std::string::npos; });
}

PlatePlan with_crop(const std::string& name, const Box& crop) {
    PlatePlan plan;
    plan.name = name;
    plan.crop = crop;
    return plan;
}

TEST(Preview, ListsEveryRegionAndCropOnceAsWritten) {
    World world(96, 54);
    world.e.plates = {with_crop("a", {3, 4, 20, 21}), with_crop("b", {3, 4, 20, 21}), with_crop("c", {30, 7, 90, 50})};
    const Drawn d = drawn(world);
    EXPECT_EQ(count_of(d, "[48, 27, 60, 33]"), 1);
    EXPECT_EQ(count_of(d, "[12, 6, 48, 27]"), 1);
    EXPECT_EQ(count_of(d, "[3, 4, 20, 21]"), 1) << "two plates share it";
    EXPECT_EQ(count_of(d, "crop of a, b"), 1);
    EXPECT_EQ(count_of(d, "[30, 7, 90, 50]"), 1);
}

TEST(Preview, StaysOnItsSheetForImagesOfAnyShape) {
    for (const auto& [w, h] : {std::pair{1, 1}, {96, 54}, {7, 300}, {3000, 40}}) {
        World world(w, h);
        for (int i = 0; i < 20; ++i)
            world.e.plates.push_back(with_crop("plate " + std::to_string(i), {0, 0, std::min(i, w - 1), h - 1}));
        const Drawn d = drawn(world);
        for (const Setting& s : d.settings) {
            EXPECT_GE(s.extents.x, 31) << s.text;
            EXPECT_LE(s.extents.right(), 1249) << s.text;
            EXPECT_LE(s.extents.bottom(), 704) << s.text;
        }
        if (w > 20) EXPECT_NE(d.notes.find("of 22 boxes listed"), std::string::npos) << d.notes;
    }
}

/// A corner of region H, 48 to 60 by 27 to 33 of 96 x 54 pixels, has its colour on the picture, whose pixels are
/// nine times as large there.
TEST(Preview, MarksARegionWhereItLies) {
    World world(96, 54);
    World without(96, 54);
    without.e.regions.clear();
    const Picture with_region = drawn(world).picture, plain = drawn(without).picture;
    const PlateInputs in = world.inputs();
    const Fit f = fit(96, 54, 914, 512);
    ASSERT_EQ(f.times, 9);
    int left = 1280, right = 0;
    for (int y = 64; y < 604; ++y)
        for (int x = 78; x < 992; ++x) {
            const std::size_t at = 3 * (std::size_t(y) * 1280 + std::size_t(x));
            const bool differs = !std::equal(&with_region.rgb[at], &with_region.rgb[at] + 3, &plain.rgb[at]);
            if (differs) {
                left = std::min(left, x);
                right = std::max(right, x);
            }
        }
    const int picture_left = 78 + (914 - 96 * 9) / 2;
    EXPECT_NEAR(left, picture_left + 12 * 9, 6) << "of region S";
    EXPECT_NEAR(right, picture_left + 61 * 9, 6) << "of region H";
}

}  // namespace preview_test
}  // namespace crescent::plates
