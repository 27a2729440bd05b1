#include "plates/plates.h"

#include <gtest/gtest.h>
#include <png.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <random>
#include <thread>

#include "meters/meters.h"
#include "plates/sheet.h"

namespace crescent {
namespace {

using plates::Rect;
using plates::Setting;
using plates::Sheet;

constexpr PlateKind all_kinds[] = {PlateKind::hero,     PlateKind::gallery,   PlateKind::columns, PlateKind::ladder,
                                   PlateKind::exponent, PlateKind::surround,  PlateKind::reference,
                                   PlateKind::heat,     PlateKind::rose,      PlateKind::meters};
constexpr PlateKind photographs[] = {PlateKind::hero,   PlateKind::gallery,  PlateKind::columns,
                                     PlateKind::ladder, PlateKind::exponent, PlateKind::surround};

// An experiment with noise for films: what plates need, and nothing else.
struct World {
    Experiment e;
    Metrics metrics;
    ShapeMap shapes;
    std::map<std::string, Film> films;
    ReferenceFilm reference;

    World(int w, int h) : reference(w, h, 32) {
        e.title = "test";
        e.seed = 7;
        e.image = {w, h};
        Shape sphere;
        sphere.material.rho_s = 0.12;
        sphere.material.s = 32;
        sphere.material.rho_d = {0.1, 0.1, 0.1};
        e.shapes = {sphere};
        e.regions = {{"H", {w / 2, h / 2, w / 2 + w / 8, h / 2 + h / 8}, {}}, {"S", {w / 8, h / 8, w / 2, h / 2}, {}}};
        reference.y.assign(reference.size(), 0.2f);
        for (const char* arm : {"uniform", "cosine", "phong"}) add_arm(arm, arm);
        for (const ArmPlan& a : e.arms) {
            for (const Region& r : e.regions) metrics.ladders.push_back({a.name, r.name, 32, a.n, {2, 1}, -0.5, -0.6, -0.4, false});
        }
    }

    void add_arm(const std::string& name, const std::string& sampler) {
        e.arms.push_back({name, sampler, {4, 64}, {}});
        for (std::uint64_t n : {4, 64}) add_film(name, n);
    }

    void add_film(const std::string& arm, std::uint64_t n) {
        Film f(e.image.width, e.image.height, n);
        std::mt19937 random(unsigned(n) + 31 * unsigned(arm.size()));
        for (std::size_t i = 0; i < f.size(); ++i) {
            f.r[i] = f.g[i] = f.b[i] = f.y[i] = 0.2f + 0.3f * float(random()) / float(random.max());
        }
        RunMeter m;
        m.key = {arm, n, 32, e.seed};
        for (const Region& r : e.regions) m.regions.push_back({r.name, 1.234, 0.5, 10, {}});
        m.fireflies = 12345;
        metrics.runs.push_back(m);
        for (const char* meter : {"rmse.H", "rmse.S", "fireflies", "var.H", "horizon_frac", "y_mean"}) {
            metrics.bands.push_back({m.key, meter, 1.2, {1.1, 1.2, 1.3, 16, false}, 1.25, 0.4});
        }
        films[to_string(m.key)] = std::move(f);
    }

    PlatePlan plan(PlateKind kind, std::size_t runs) const {
        PlatePlan p;
        p.name = "plate", p.kind = kind;
        p.caption = "A caption that stands alone under the picture, long enough to need a second line of the sheet, so "
                    "that wrapping is seen to work and nothing runs off.";
        for (std::size_t i = 0; i < runs; ++i) p.runs.push_back({e.arms[i % e.arms.size()].name, i % 2 ? 4u : 64u, 0});
        return p;
    }

    PlateInputs inputs() const {
        return {e, metrics, shapes,
                [this](const RunKey& k) -> const Film* {
                    auto at = films.find(to_string(k));
                    return at == films.end() ? nullptr : &at->second;
                },
                [this](double s) { return s == 32 ? &reference : nullptr; }, "CPU"};
    }

    std::vector<Setting> settings(const PlatePlan& p) const {
        PlateInputs in = inputs();
        Sheet sheet(p, in);
        plates::draw(sheet);
        return sheet.canvas.settings();
    }
};

bool has(const std::vector<Setting>& settings, const std::string& words) {
    for (const Setting& s : settings) {
        if (s.text.find(words) != std::string::npos) return true;
    }
    return false;
}

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

TEST(Plates, Every_kind_is_1280_by_720_and_the_same_bytes_twice_on_any_thread) {
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

TEST(Plates, No_text_is_cut_small_or_runs_into_its_neighbour) {
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

TEST(Plates, Long_names_stay_in_their_boxes) {
    World world(960, 540);
    for (std::size_t i = 0; i < 3; ++i) {
        std::string name = "an arm whose author had a good deal to say about it & <more> " + std::to_string(i);
        world.add_arm(name, "phong");
        std::swap(world.e.arms[i], world.e.arms.back());
    }
    world.e.regions[0].name = "the highlight crescent as the key light draws it on the sphere";
    for (RunMeter& run : world.metrics.runs) run.regions[0].region = world.e.regions[0].name;
    for (PlateKind kind : all_kinds) {
        SCOPED_TRACE(int(kind));
        PlatePlan plan = world.plan(kind, 3);
        for (int i = 0; i < 5; ++i) plan.caption += plan.caption.substr(0, 120);
        std::vector<Setting> settings = world.settings(plan);
        expect_on_sheet(settings);
        expect_apart(settings);
    }
}

TEST(Plates, Any_size_of_image_and_any_number_of_runs_is_drawn) {
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

TEST(Plates, An_experiment_without_regions_is_drawn_whole) {
    World world(64, 64);
    world.e.regions.clear();
    for (PlateKind kind : all_kinds) EXPECT_NO_THROW(draw_plate(world.plan(kind, 2), world.inputs())) << int(kind);
}

TEST(Plates, A_photograph_says_so_and_carries_no_measured_number) {
    World world(96, 54);
    for (PlateKind kind : photographs) {
        std::vector<Setting> settings = world.settings(world.plan(kind, 2));
        EXPECT_TRUE(has(settings, "PHOTO-ONLY")) << int(kind);
        EXPECT_FALSE(has(settings, "RMSE")) << int(kind);
        EXPECT_FALSE(has(settings, "INSTRUMENT")) << int(kind);
    }
    for (PlateKind kind : {PlateKind::reference, PlateKind::heat, PlateKind::rose, PlateKind::meters}) {
        std::vector<Setting> settings = world.settings(world.plan(kind, 2));
        EXPECT_TRUE(has(settings, "INSTRUMENT")) << int(kind);
        EXPECT_FALSE(has(settings, "PHOTO-ONLY")) << int(kind);
    }
}

TEST(Plates, A_pixel_that_is_not_a_number_is_magenta_and_counted) {
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

TEST(Plates, A_run_that_was_not_made_is_named_on_the_plate) {
    World world(96, 54);
    PlatePlan plan = world.plan(PlateKind::columns, 2);
    plan.runs[1].n = 1024;
    EXPECT_TRUE(has(world.settings(plan), "cosine n=1024 s=32 was not run"));
}

TEST(Heat, Prints_the_98th_percentile_of_all_pixels_shown) {
    World world(96, 54);
    PlatePlan plan = world.plan(PlateKind::heat, 2);
    plan.crop = Box{10, 10, 49, 29};
    std::vector<double> all;
    for (const PlateRun& run : plan.runs) {
        const Film& film = world.films.at(to_string(RunKey{run.arm, run.n, 32, 7}));
        for (int y = 10; y <= 29; ++y) {
            for (int x = 10; x <= 49; ++x) all.push_back(std::abs(double(film.y[std::size_t(y * 96 + x)]) - double(0.2f)));
        }
    }
    EXPECT_TRUE(has(world.settings(plan), "p98 = " + plates::number(quantile(all, 0.98)) + " "));
}

TEST(Rose, States_the_peaks_of_the_densities) {
    World world(96, 54);
    PlatePlan plan;
    plan.kind = PlateKind::rose;
    plan.runs = {{"cosine", 0, 0}, {"phong", 0, 0}};
    std::vector<Setting> settings = world.settings(plan);
    EXPECT_TRUE(has(settings, "peak 0.318 sr"));   // 1/pi
    EXPECT_TRUE(has(settings, "peak 5.25 sr"));    // 33/(2 pi)
    EXPECT_TRUE(has(settings, "= 16.5 × Cosine"));
    EXPECT_TRUE(has(settings, "not Blinn, not GGX VNDF"));
}

TEST(Words, A_label_says_once_what_the_runs_share) {
    World world(8, 8);
    EXPECT_EQ(plates::runs_label({{"phong", 256, 32, 7}}, world.e), "Phong-IS N=256 s=32");
    EXPECT_EQ(plates::runs_label({{"uniform", 64, 32, 7}, {"cosine", 64, 32, 7}}, world.e), "Uniform | Cosine N=64 s=32");
    EXPECT_EQ(plates::runs_label({{"cosine", 4, 32, 7}, {"cosine", 16, 32, 7}}, world.e), "Cosine N=4 | 16 s=32");
}

TEST(Words, Numbers_are_set_with_true_minus_and_powers) {
    EXPECT_EQ(plates::number(-0.25), "−0.25");
    EXPECT_EQ(plates::number(1.5e-9), "1.5·10<sup>−9</sup>");
    EXPECT_EQ(plates::figure(2, 4), "2.000");
    EXPECT_EQ(plates::figure(14402, 4).find('.'), std::string::npos);
    EXPECT_EQ(plates::number(std::nan("")), "not a number");
}

TEST(Font, Its_absence_names_the_package) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    auto without_fonts = [] {
        std::string config = testing::TempDir() + "/no-fonts.conf";
        std::ofstream(config) << "<?xml version='1.0'?><fontconfig><dir>/nonexistent</dir></fontconfig>";
        setenv("FONTCONFIG_FILE", config.c_str(), 1);
        try {
            World world(8, 8);
            draw_plate(world.plan(PlateKind::hero, 1), world.inputs());
        } catch (const OutputError& e) {
            std::_Exit(std::strstr(e.what(), "fonts-inter") ? 3 : 1);
        }
        std::_Exit(0);
    };
    EXPECT_EXIT(without_fonts(), testing::ExitedWithCode(3), "");
}

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
    d.width = int(png_get_image_width(png, info)), d.height = int(png_get_image_height(png, info));
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

TEST(Png, Carries_the_pixels_and_the_provenance_and_no_date) {
    Picture p{3, 2, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 255}};
    Decoded d = decode(encode_png(p, {{"experiment", "gallery.toml"}, {"title", "ω and ρ"}}));
    EXPECT_EQ(d.width, 3);
    EXPECT_EQ(d.height, 2);
    EXPECT_EQ(d.rgb, p.rgb);
    EXPECT_EQ(d.text["experiment"], "gallery.toml");
    EXPECT_EQ(d.text["title"], "ω and ρ");
    EXPECT_FALSE(d.dated);
}

}  // namespace
}  // namespace crescent
