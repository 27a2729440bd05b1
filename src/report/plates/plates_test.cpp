// Every kind of plate, on synthetic experiments and films: nothing cut off, too small or overlapping, equal bytes on
// any thread, no measured number on photographs, faults of runs stated, printed numbers equal to those of the films.
#include "report/plates/plates.h"

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <gtest/gtest.h>
#include <map>
#include <png.h>
#include <thread>

#include "math/statistics.h"
#include "metrics/metrics.h"
#include "report/plates/sheet.h"
#include "tests/support/test_world.h"

namespace crescent::plates {
namespace plates_test {

using plates::Rect;
using plates::Setting;
using plates::World;

std::vector<PlateKind> kinds_where(bool photograph) {
    std::vector<PlateKind> out;
    for (std::size_t k = 0; k < plate_infos.size(); ++k)
        if ((plate_infos[k].look == PlateLook::photograph) == photograph) out.push_back(PlateKind(k));
    return out;
}
const std::vector<PlateKind> photographs = kinds_where(true), backends = kinds_where(false);
const std::vector<PlateKind> all_kinds = [] {
    std::vector<PlateKind> out = photographs;
    out.insert(out.end(), backends.begin(), backends.end());
    return out;
}();

void expect_on_sheet(const std::vector<Setting>& settings) {
    for (const Setting& s : settings) {
        EXPECT_GE(s.extents.x, 31) << s.text;
        EXPECT_LE(s.extents.right(), 1249) << s.text;
        EXPECT_GE(s.extents.y, 16) << s.text;
        EXPECT_LE(s.extents.bottom(), 704) << s.text;
        EXPECT_LE(s.extents.w, s.box.w + 1) << s.text;
    }
}

void expect_apart(const std::vector<Setting>& settings) {
    for (std::size_t i = 0; i < settings.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            EXPECT_FALSE(settings[i].extents.inset(1).meets(settings[k].extents.inset(1)))
                << settings[i].text << " runs into " << settings[k].text;
        }
    }
}

double luminance_of(const plates::Colour& c) {
    const auto linear = [](double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); };
    return 0.2126 * linear(c.r) + 0.7152 * linear(c.g) + 0.0722 * linear(c.b);
}

// WCAG 2.2: text and lines that carry information at 4.5:1.
TEST(Plates, InksOfTheLightThemeStandOutFromItsGround) {
    using namespace plates;
    const double paper = luminance_of(themed(ground, Theme::light));
    EXPECT_GT(paper, 0.9);
    for (const Colour& c : {bright, muted, photograph_accent, backend_accent, alert, series[0], series[1], series[2],
             series[3], series[4], series[5]})
        EXPECT_GE((paper + 0.05) / (luminance_of(themed(c, Theme::light)) + 0.05), 4.5)
            << c.r << " " << c.g << " " << c.b;
    EXPECT_EQ(themed(bright, Theme::dark).r, bright.r);
}

TEST(Plates, LightThemeKeepsEveryWord) {
    World world(96, 54);
    for (PlateKind kind : all_kinds) {
        PlateInputs in = world.inputs();
        in.theme = Theme::light;
        const Picture p = draw_plate(world.plan(kind, 2), in);
        EXPECT_GE(p.rgb[0], 250) << static_cast<int>(kind);
        EXPECT_GE(p.rgb[p.rgb.size() - 1], 250) << static_cast<int>(kind);
    }
}

TEST(Plates, APlateOfLinesIsAnSvgToo) {
    World world(96, 54);
    const std::string svg = draw_plate_svg(world.plan(PlateKind::meters, 2), world.inputs());
    EXPECT_EQ(svg.find("<?xml"), 0u);
    EXPECT_NE(svg.find("</svg>"), std::string::npos);
    EXPECT_TRUE(svg == draw_plate_svg(world.plan(PlateKind::meters, 2), world.inputs()));
    EXPECT_EQ(draw_plate_svg(world.plan(PlateKind::heat, 2), world.inputs()), "");
}

TEST(Plates, EveryKindIsReproducibleAt1280By720) {
    World world(96, 54);
    for (PlateKind kind : all_kinds) {
        PlatePlan plan = world.plan(kind, 2);
        Picture a = draw_plate(plan, world.inputs()), b;
        std::thread([&] { b = draw_plate(plan, world.inputs()); }).join();
        EXPECT_EQ(a.width, 1280);
        EXPECT_EQ(a.height, 720);
        EXPECT_EQ(a.rgb, b.rgb) << int(kind);
        EXPECT_EQ(encode_png(a, {{"seed", "7"}}), encode_png(b, {{"seed", "7"}}));
    }
}

TEST(Plates, NoTextIsCutSmallOrRunsIntoItsNeighbour) {
    World world(960, 540);
    for (PlateKind kind : all_kinds) {
        for (std::size_t runs : {1, 2, 3, 4}) {
            SCOPED_TRACE(testing::Message() << "kind " << int(kind) << ", runs " << runs);
            std::vector<Setting> settings = world.settings(world.plan(kind, runs));
            for (const Setting& s : settings) {
                EXPECT_FALSE(s.ellipsized) << s.text;
                EXPECT_GE(s.px, 14) << s.text;
            }
            expect_on_sheet(settings);
            expect_apart(settings);
        }
    }
}

TEST(Plates, LongNamesStayInTheirBoxes) {
    World world(960, 540);
    for (std::size_t i = 0; i < 3; ++i) {
        std::string name = "an arm whose author had a good deal to say about it & <more> " + std::to_string(i);
        world.add_arm(name, "phong");
        std::swap(world.e.arms[i], world.e.arms.back());
    }
    world.backend =
        "OpenGL 4.5 (Core Profile) of some driver with a long name, on a renderer with a longer one (256 bits)";
    world.e.regions[0].name = "the highlight crescent as the key light draws it on the sphere";
    for (RunMetrics& run : world.metrics.runs) run.regions[0].region = world.e.regions[0].name;
    for (PlateKind kind : all_kinds) {
        SCOPED_TRACE(int(kind));
        PlatePlan plan = world.plan(kind, 3);
        for (int i = 0; i < 5; ++i) plan.caption += plan.caption.substr(0, 120);
        std::vector<Setting> settings = world.settings(plan);
        expect_on_sheet(settings);
        expect_apart(settings);
    }
}

TEST(Plates, EveryInstrumentSaysWhatComputedItsFilms) {
    World world(960, 540);
    world.backend = "GL 4.5, llvmpipe, OSMesa";
    for (PlateKind kind : backends) {
        const std::vector<Setting> settings = world.settings(world.plan(kind, 2));
        EXPECT_TRUE(std::any_of(settings.begin(), settings.end(), [&](const Setting& s) {
            return s.text.find(world.backend) != std::string::npos;
        })) << int(kind);
    }
}

TEST(Plates, AnySizeOfImageAndAnyNumberOfRunsIsDrawn) {
    for (auto [w, h] : {std::pair{8, 8}, {40, 900}, {900, 12}, {1, 1}, {1500, 900}}) {
        World world(w, h);
        for (PlateKind kind : all_kinds) {
            for (std::size_t runs : {0, 1, 5, 20}) {
                SCOPED_TRACE(testing::Message() << w << " x " << h << ", kind " << int(kind) << ", runs " << runs);
                std::vector<Setting> settings = world.settings(world.plan(kind, runs));
                expect_on_sheet(settings);
                expect_apart(settings);
            }
        }
    }
}

TEST(Plates, AnExperimentWithoutRegionsIsDrawnWhole) {
    World world(64, 64);
    world.e.regions.clear();
    for (PlateKind kind : all_kinds) EXPECT_NO_THROW(draw_plate(world.plan(kind, 2), world.inputs())) << int(kind);
}

TEST(Plates, PhotographsHaveNoMeasuredNumber) {
    World world(96, 54);
    for (PlateKind kind : photographs) {
        std::vector<Setting> settings = world.settings(world.plan(kind, 2));
        EXPECT_TRUE(has(settings, "PHOTO-ONLY")) << int(kind);
        EXPECT_FALSE(has(settings, "RMSE")) << int(kind);
        EXPECT_FALSE(has(settings, "INSTRUMENT")) << int(kind);
    }
    for (PlateKind kind : backends) {
        std::vector<Setting> settings = world.settings(world.plan(kind, 2));
        EXPECT_TRUE(has(settings, "INSTRUMENT")) << int(kind);
        EXPECT_FALSE(has(settings, "PHOTO-ONLY")) << int(kind);
    }
}

TEST(Plates, NaNPixelsAreMagentaAndCounted) {
    World world(96, 54);
    for (auto& [name, film] : world.films) film.r[100] = film.y[100] = std::nanf("");
    for (PlateKind kind : {PlateKind::hero, PlateKind::columns, PlateKind::heat}) {
        PlatePlan plan = world.plan(kind, 1);
        plan.crop = Box{0, 0, 95, 20};
        EXPECT_TRUE(has(world.settings(plan), "1 pixel not a number")) << int(kind);
        Picture p = draw_plate(plan, world.inputs());
        bool magenta = false;
        for (std::size_t i = 0; i < p.rgb.size(); i += 3) {
            magenta |= p.rgb[i] == 255 && p.rgb[i + 1] == 0 && p.rgb[i + 2] == 255;
        }
        EXPECT_TRUE(magenta) << int(kind);
    }
    EXPECT_FALSE(has(World(96, 54).settings(world.plan(PlateKind::hero, 1)), "not a number"));
}

TEST(Plates, ARunThatWasNotMadeIsNamedOnThePlate) {
    World world(96, 54);
    PlatePlan plan = world.plan(PlateKind::columns, 2);
    plan.runs[1].n = 1024;
    EXPECT_TRUE(has(world.settings(plan), "cosine n=1024 s=32 was not run"));
}

TEST(Plates, EnlargeTheMiddleOfARegionThatIsTheWholeFrame) {
    World world(96, 54);
    world.e.regions = {{"all", {0, 0, 95, 53}, {}}};
    EXPECT_TRUE(has(world.settings(world.plan(PlateKind::columns, 2)), "crop x 32–63, y 18–35"));
}

TEST(Plates, WrapALongDensityUnderANarrowPicture) {
    World world(960, 540);
    for (std::size_t i = 0; i < world.e.arms.size(); ++i) {
        if (world.e.arms[i].is_combination()) continue;
        world.e.arms[i].sampler = "material";
    }
    for (const Setting& each : world.settings(world.plan(PlateKind::columns, 6))) {
        EXPECT_FALSE(each.ellipsized) << each.text;
        EXPECT_GE(each.px, 13) << each.text;
    }
}

TEST(Plates, OfASceneWithoutAnExponentShowNone) {
    EXPECT_TRUE(exponent_facts(0).empty());
    EXPECT_EQ(with_exponent("Converged reference", 0), "Converged reference");
    EXPECT_EQ(with_exponent("Converged reference", 32), "Converged reference s=32");
}

TEST(Plates, StateWhenTheReferenceIsTooImprecise) {
    World world(96, 54);
    const char* message = "reference not good enough in H";
    world.metrics.references = {{32, "H", {}, {}, 0.1, {}, most_error_share}};
    EXPECT_FALSE(has(world.settings(world.plan(PlateKind::heat, 2)), message));
    world.metrics.references[0].error_share = 2 * most_error_share;
    EXPECT_TRUE(has(world.settings(world.plan(PlateKind::heat, 2)), message));
    EXPECT_TRUE(has(world.settings(world.plan(PlateKind::meters, 2)), message));
}

TEST(Metrics, SevenColumnsFitByFewerBandDigits) {
    World world(96, 54);
    world.e.regions.push_back({"all", {0, 0, 95, 53}, {}});
    for (RunMetrics& m : world.metrics.runs) m.regions.push_back({"all", 1.234, 0.5, 10, {}});
    for (SeedSpread& b : world.metrics.bands)
        if (b.metric == "var.H") {
            b.band.q05 = 7.5968e-4;
            b.band.q95 = 7.8312e-4;
        }
    const std::vector<Setting> settings = world.settings(world.plan(PlateKind::meters, 2));
    EXPECT_TRUE(has(settings, "0.000760 – 0.000783"));
    EXPECT_TRUE(has(settings, "1.100 – 1.300"));
    for (const Setting& each : settings) EXPECT_FALSE(each.ellipsized) << each.text;
}

TEST(Plates, NameTheArmsThatCannotReachAllLight) {
    World world(96, 54);
    world.e.fill = {1, 1, 1};
    const char* message = "out of reach: light-area";
    for (PlateKind kind : {PlateKind::heat, PlateKind::meters})
        EXPECT_FALSE(has(world.settings(world.plan(kind, 2)), "biased"));
    world.add_arm("light-area", "light-area");
    for (PlateKind kind : {PlateKind::heat, PlateKind::meters}) {
        EXPECT_TRUE(has(world.settings(world.plan(kind, 4)), message));
        EXPECT_FALSE(has(world.settings(world.plan(kind, 2)), message)) << "not on this plate";
    }
}

TEST(Heat, PrintsThe98thPercentileOfAllPixelsShown) {
    World world(96, 54);
    PlatePlan plan = world.plan(PlateKind::heat, 2);
    plan.crop = Box{10, 10, 49, 29};
    std::vector<double> all;
    for (const PlateRun& run : plan.runs) {
        const Film& film = world.films.at(to_string(RunKey{run.arm, run.n, 32, 7}));
        for (int y = 10; y <= 29; ++y) {
            for (int x = 10; x <= 49; ++x)
                all.push_back(std::abs(double(film.y[std::size_t(y * 96 + x)]) - double(0.2f)));
        }
    }
    EXPECT_TRUE(has(world.settings(plan), "p98 = " + plates::number(quantile(all, 0.98)) + " "));
}

TEST(Font, ItsAbsenceNamesThePackage) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    auto without_fonts = [] {
        std::string config = testing::TempDir() + "/no-fonts.conf";
        std::ofstream(config) << "<?xml version='1.0'?><fontconfig><dir>/nonexistent</dir></fontconfig>";
        setenv("FONTCONFIG_FILE", config.c_str(), 1);
        try {
            World world(8, 8);
            draw_plate(world.plan(PlateKind::hero, 1), world.inputs());
        } catch (const OutputError& e) { std::_Exit(std::strstr(e.what(), "fonts-inter") ? 3 : 1); }
        std::_Exit(0);
    };
    EXPECT_EXIT(without_fonts(), testing::ExitedWithCode(3), "");
}

// ---- encode_png() read back by libpng: size, pixels, provenance in Latin-1 and other text, no date.

struct Decoded {
    int width = 0, height = 0;
    std::map<std::string, std::string> text;
    std::vector<unsigned char> rgb;
    bool dated = false;
};

Decoded decode(const std::vector<unsigned char>& bytes) {
    struct Source {
        const unsigned char* at;
    } source{bytes.data()};
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_set_read_fn(png, &source, [](png_structp p, png_bytep out, png_size_t n) {
        auto* s = static_cast<Source*>(png_get_io_ptr(p));
        std::memcpy(out, s->at, n);
        s->at += n;
    });
    png_read_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
    Decoded d;
    d.width = int(png_get_image_width(png, info));
    d.height = int(png_get_image_height(png, info));
    png_bytepp rows = png_get_rows(png, info);
    for (int y = 0; y < d.height; ++y) d.rgb.insert(d.rgb.end(), rows[y], rows[y] + 3 * d.width);
    png_textp text = nullptr;
    int count = 0;
    png_get_text(png, info, &text, &count);
    for (int i = 0; i < count; ++i) d.text[text[i].key] = text[i].text;
    d.dated = png_get_valid(png, info, PNG_INFO_tIME) != 0;
    png_destroy_read_struct(&png, &info, nullptr);
    return d;
}

TEST(Png, HasPixelsAndProvenanceButNoDate) {
    Picture p{3, 2, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 255}};
    Decoded d = decode(encode_png(p, {{"experiment", "gallery.toml"}, {"title", "ω and ρ"}}));
    EXPECT_EQ(d.width, 3);
    EXPECT_EQ(d.height, 2);
    EXPECT_EQ(d.rgb, p.rgb);
    EXPECT_EQ(d.text["experiment"], "gallery.toml");
    EXPECT_EQ(d.text["title"], "ω and ρ");
    EXPECT_FALSE(d.dated);
}

}  // namespace plates_test
}  // namespace crescent::plates
