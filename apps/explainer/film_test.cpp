// Every shot of the video, on a small run: text is readable, nothing is cut off or overlaps its neighbour, no digit is
// hard-coded, captions follow their rules, and frames do not depend on the drawing order.
#include <gtest/gtest.h>

#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "captions.h"
#include "drawing.h"
#include "painter.h"
#include "rasters.h"
#include "shots.h"
#include "tests/support/explainer_data.h"

namespace crescent::explainer {
namespace film_test {

constexpr int small_height = 360;

const Timeline& timeline() {
    static const Timeline made(shots_of(test::small_data()));
    return made;
}

/// Returns the tested frames: the still of every shot, and one every 1.5 seconds.
std::vector<int> looked_at(std::size_t shot) {
    std::vector<int> frames{timeline().still(shot)};
    for (int f = timeline().begin(shot); f < timeline().begin(shot + 1); f += 45) frames.push_back(f);
    return frames;
}

std::string what(std::size_t shot, int frame, const plates::Setting& s) {
    return timeline().shots()[shot].name + " frame " + std::to_string(frame) + ": \"" + s.text + "\" at " +
        std::to_string(s.extents.x) + ", " + std::to_string(s.extents.y);
}

TEST(Film, EveryTextIsUncutAndLargeEnough) {
    Painter painter(timeline(), small_height);
    for (std::size_t k = 0; k < timeline().shots().size(); ++k) {
        for (const int frame : looked_at(k)) {
            painter.draw(frame);
            for (const plates::Setting& s : painter.canvas().settings()) {
                EXPECT_FALSE(s.ellipsized) << what(k, frame, s) << " is cut off";
                EXPECT_GE(s.px, least_px) << what(k, frame, s);
                EXPECT_TRUE(s.extents.x >= 0 && s.extents.y >= 0 && s.extents.right() <= sheet_width &&
                    s.extents.bottom() <= sheet_height)
                    << what(k, frame, s) << " leaves the sheet";
            }
        }
    }
}

TEST(Film, TextsDoNotOverlapOnAnyStill) {
    Painter painter(timeline(), small_height);
    for (std::size_t k = 0; k < timeline().shots().size(); ++k) {
        painter.draw(timeline().still(k));
        const std::vector<plates::Setting>& all = painter.canvas().settings();
        for (std::size_t a = 0; a < all.size(); ++a)
            for (std::size_t b = a + 1; b < all.size(); ++b)
                EXPECT_FALSE(all[a].extents.inset(3).meets(all[b].extents.inset(3)))
                    << what(k, timeline().still(k), all[a]) << " meets " << what(k, timeline().still(k), all[b]);
    }
}

/// Returns WCAG 2.1 relative luminance of 8-bit sRGB or of a colour.
double luminance_of(double r, double g, double b) {
    return 0.2126 * srgb_decode(r) + 0.7152 * srgb_decode(g) + 0.0722 * srgb_decode(b);
}

TEST(Film, StillsHaveEnoughTextContrast) {
    Painter painter(timeline(), small_height);
    painter.canvas().hide_text(true);
    for (std::size_t k = 0; k < timeline().shots().size(); ++k) {
        painter.draw(timeline().still(k));
        const Picture behind = painter.canvas().picture();
        const double scale = behind.height / sheet_height;
        for (const plates::Setting& s : painter.canvas().settings()) {
            std::vector<double> contrasts;
            const double ink = luminance_of(s.ink.r, s.ink.g, s.ink.b);
            for (int y = int(s.extents.y * scale); y < int(s.extents.bottom() * scale); ++y) {
                for (int x = int(s.extents.x * scale); x < int(s.extents.right() * scale); ++x) {
                    const unsigned char* p =
                        &behind.rgb[3 * (std::size_t(y) * std::size_t(behind.width) + std::size_t(x))];
                    const double ground_there = luminance_of(p[0] / 255.0, p[1] / 255.0, p[2] / 255.0);
                    contrasts.push_back((std::max(ink, ground_there) + 0.05) / (std::min(ink, ground_there) + 0.05));
                }
            }
            if (contrasts.empty()) continue;
            EXPECT_GE(quantile(contrasts, 0.1), 4.5) << what(k, timeline().still(k), s);
            EXPECT_GE(s.ink.a, 0.99) << what(k, timeline().still(k), s) << " has not come in yet";
        }
    }
}

TEST(Film, NoDigitIsHardCoded) {
    EXPECT_THROW(Words("off by 6.18"), Bug);
    EXPECT_NO_THROW(Words("off by <span foreground='#112233'>", figure(6.18, 3, "rmse"), "</span>"));
    Painter painter(timeline(), small_height);
    for (std::size_t k = 0; k < timeline().shots().size(); ++k) {
        for (const int frame : looked_at(k)) {
            painter.draw(frame);
            // All text on the canvas went through Words, and every part of it with a digit states its source.
            std::multiset<std::string> texts;
            for (const Words& words : painter.frame().texts()) {
                texts.insert(words.markup());
                for (const Words::Part& part : words.parts()) {
                    const std::string plain = plain_of(part.markup);
                    if (std::ranges::any_of(plain, [](char c) { return c >= '0' && c <= '9'; }))
                        EXPECT_FALSE(part.source.empty()) << plain;
                }
            }
            for (const plates::Setting& s : painter.canvas().settings())
                EXPECT_TRUE(texts.contains(s.text)) << what(k, frame, s) << " was set past Words";
        }
    }
}

TEST(Film, NumbersComeFromTheRun) {
    Data other = test::small_data();
    for (RunMetrics& run : other.metrics.runs)
        for (RegionMetrics& region : run.regions) region.rmse *= 1.37;
    const std::vector<Shot> before = shots_of(test::small_data()), after = shots_of(other);
    int numbers = 0;
    for (std::size_t k = 0; k < before.size(); ++k) {
        for (std::size_t c = 0; c < before[k].cues.size(); ++c) {
            for (const Words::Part& part : before[k].cues[c].words.parts()) {
                if (!part.source.starts_with("rmse.")) continue;
                ++numbers;
                for (const Words::Part& now : after[k].cues[c].words.parts()) {
                    if (now.source == part.source) EXPECT_NE(now.markup, part.markup) << part.source;
                }
            }
        }
    }
    EXPECT_GE(numbers, 6);
}

void expect_valid_timeline(const Timeline& t) {
    for (std::size_t k = 0; k < t.captions().size(); ++k) {
        const Caption& c = t.captions()[k];
        const std::string plain = c.words.plain();
        const std::size_t line_break = plain.find('\n');
        EXPECT_LE(length(plain.substr(0, line_break)), line_length) << plain;
        if (line_break != std::string::npos) {
            EXPECT_LE(length(plain.substr(line_break + 1)), line_length) << plain;
            EXPECT_EQ(plain.find('\n', line_break + 1), std::string::npos) << plain;
        }
        const double silence = c.question ? question_silence : 0;
        EXPECT_LE(double(length(plain)) / (c.to - c.from - silence), reading_speed + 0.01) << plain;
        EXPECT_EQ(c.question, plain.find('?') != std::string::npos)
            << plain << ": a question, and nothing else, is followed by silence";
        if (k > 0) EXPECT_GE(c.from, t.captions()[k - 1].to - 1e-9) << plain;
    }
}

TEST(Film, CaptionsFollowTheirRules) {
    expect_valid_timeline(timeline());
    int questions = 0;
    for (const Caption& c : timeline().captions()) questions += c.question;
    EXPECT_GE(questions, 3);
}

std::vector<std::uint64_t> hashes(int first, int last, int threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, std::size_t(threads));
    ProgressMonitor monitor;
    std::vector<std::uint64_t> out;
    for_each_frame(timeline(), small_height, first, last, monitor, [&](const Raster& r) { out.push_back(r.hash); });
    return out;
}

TEST(Film, FramesDoNotDependOnThreadsOrOrder) {
    for (std::size_t k = 0; k < timeline().shots().size(); ++k) {
        const int first = timeline().begin(k) + 60, last = std::min(first + 36, timeline().begin(k + 1));
        const std::vector<std::uint64_t> one = hashes(first, last, 1);
        EXPECT_EQ(one, hashes(first, last, 2)) << timeline().shots()[k].name;
        Painter alone(timeline(), small_height);
        alone.draw(last - 1);
        EXPECT_EQ(raster_of(alone.canvas())->hash, one.back()) << timeline().shots()[k].name;
    }
}

TEST(Film, UnchangedFramesWouldBeDrawnTheSame) {
    Painter running(timeline(), small_height);
    int taken = 0;
    for (int frame = 0; frame < timeline().frames(); frame += 11) {
        if (running.draw(frame) || ++taken % 7 != 0) continue;
        Painter fresh(timeline(), small_height);
        fresh.draw(frame);
        EXPECT_EQ(raster_of(fresh.canvas())->hash, raster_of(running.canvas())->hash) << frame;
    }
    EXPECT_GT(taken, 20);
}

TEST(Film, RastersAreRowsOfRedGreenBlue) {
    Canvas canvas(4, 2, {1, 0, 0.2});
    const auto raster = raster_of(canvas);
    ASSERT_EQ(raster->bytes.size(), 4u * 2 * 3);
    for (std::size_t i = 0; i < raster->bytes.size(); ++i)
        EXPECT_EQ(raster->bytes[i], (std::array<unsigned char, 3>{255, 0, 51})[i % 3]) << i;
}

TEST(Film, MissingPartsOfAnExperimentAreReported) {
    Experiment e = test::small_experiment();
    std::erase_if(e.arms, [](const ArmPlan& a) { return a.name == "phong"; });
    e.regions.resize(1);
    try {
        cast_of(e);
        FAIL();
    } catch (const InputError& error) {
        const std::string texts = error.what();
        EXPECT_NE(texts.find("'phong'"), std::string::npos) << texts;
        EXPECT_NE(texts.find("two regions"), std::string::npos) << texts;
    }
}

}  // namespace film_test
}  // namespace crescent::explainer
