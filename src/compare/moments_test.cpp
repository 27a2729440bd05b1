// Moments of renders written to a file and read again.
#include "compare/moments.h"

#include <gtest/gtest.h>

#include <cmath>

#include "compare/moments_reading.h"
#include "math/statistics.h"
#include "tests/support/memory_renders.h"
#include "tests/support/scratch_folder.h"

namespace crescent {
namespace moments_test {

class MomentFiles : public ScratchFolder {
protected:
    /// Four renders in colour, of which one has a pixel that is not finite, and their moments in a file.
    MomentFiles() {
        for (std::uint32_t k = 0; k < 4; ++k)
            for (float& x : renders.put("a" + std::to_string(k), k).r) x *= 2;
        renders.renders["a2"].g[17] = INFINITY;
        written = renders.read({box});
        write_moments(file, written, 0, false);
    }
    /// The statistics of the file, of an image of the same size.
    RenderStats read(const ComparePlan& plan) const {
        RenderStats all;
        all.width = all.height = 16;
        all.bad.assign(256, false);
        all.quantities = colour_quantities;
        all.tiles = written.tiles;
        all.regions = written.regions;
        read_moments_film(file, Render().weights, all, all.arms.emplace_back());
        read_moments_regions(file, plan, all, all.arms[0]);
        return all;
    }
    const CompareFlag box{{"regions", "low", "box"}, "[0, 0, 15, 7]", true, ""};
    const std::string file = path("moments.exr");
    MemoryRenders renders;
    RenderStats written;
};

TEST_F(MomentFiles, AreKnownByTheirHeader) {
    EXPECT_TRUE(has_moments(file));
    EXPECT_FALSE(has_moments(write("other.exr", "\x76\x2f\x31\x01 other")));
    EXPECT_EQ(read_moments_header(file).renders, 4u);
    EXPECT_FALSE(read_moments_header(file).constant);
    EXPECT_THROW((void)read_moments_header(path("other.exr")), InputError);
    write_moments(file, written, 0, true);
    EXPECT_TRUE(read_moments_header(file).constant);
}

TEST_F(MomentFiles, KeepTheMeanAndVarianceOfEachPixel) {
    const RenderStats all = read(renders.plan({box}));
    const MeanFilm &was = written.arms[0].film, &is = all.arms[0].film;
    EXPECT_EQ(is.count, 4u);
    for (std::size_t i = 0; i < 256; ++i) {
        if (i == 17) continue;
        for (std::size_t q = 0; q < colour_quantities; ++q) {
            EXPECT_NEAR(is.of(q).mean[i], was.of(q).mean[i], 1e-6);
            EXPECT_NEAR(is.variance(i, q) / was.variance(i, q), 1, q == 0 ? 1e-6 : 0x1p-9);  // channels in half
        }
    }
    EXPECT_TRUE(all.bad[17]);
    EXPECT_EQ(all.arms[0].not_finite[17], 1u);
    EXPECT_EQ(std::count(all.bad.begin(), all.bad.end(), true), 1);
}

TEST_F(MomentFiles, KeepTheMeansOfRegionsAndTheSpreadOfTiles) {
    const RenderStats all = read(renders.plan({box}));
    const QuantityReadings &was = written.arms[0].quantities[1], &is = all.arms[0].quantities[1];
    EXPECT_EQ(is.largest[0].size(), was.largest[0].size());
    EXPECT_NEAR(is.rise, was.rise, 1e-6);
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(is.regions[k][0], was.regions[k][0], 1e-6);
    for (std::size_t t = 0; t < all.tiles.count(); ++t) {
        std::vector<double> before, after;
        for (std::size_t k = 0; k < 4; ++k) {
            before.push_back(was.tiles[k][t].mean);
            after.push_back(is.tiles[k][t].mean);
        }
        EXPECT_NEAR(mean_interval(after, 0.95).mean, mean_interval(before, 0.95).mean, 1e-6);
        EXPECT_NEAR(mean_interval(after, 0.95).se / mean_interval(before, 0.95).se, 1, 1e-5);
    }
    EXPECT_EQ(all.arms[0].failed_groups[2][1], 1u);
    EXPECT_EQ(all.arms[0].failed_groups[1][1], 0u);
}

TEST_F(MomentFiles, HaveOnlyTheRegionsOfTheirPlan) {
    const CompareFlag other{{"regions", "low", "box"}, "[0, 0, 15, 8]", true, ""};
    written.regions[0].box = Box{0, 0, 15, 8};
    EXPECT_THROW((void)read(renders.plan({other})), InputError);
}

TEST_F(MomentFiles, OddTextsAreRefused) {
    const std::string good = R"({"format": "crescent moments 1", "renders": 4, "constant": false, "quantities": 4,
        "rounding": 0, "regions": [{"name": "frame", "box": [0, 0, 15, 15]}]})";
    const auto mistake = [&](const std::string& from, const std::string& to) {
        std::string text = good;
        text.replace(text.find(from), from.size(), to);
        return refusal([&] { return parse_moments_text(text, file, 16, 16); });
    };
    EXPECT_EQ(parse_moments_text(good, file, 16, 16).renders, 4u);
    for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{{"moments 1", "moments 2"},
             {"4,", "0,"}, {"4,", "1000000000000,"}, {"4,", "-4,"}, {"4,", "4.5,"}, {"\"renders\": 4, ", ""},
             {"false", "1"}, {"\"quantities\": 4", "\"quantities\": 3"}, {"\"rounding\": 0", "\"rounding\": null"},
             {"\"rounding\": 0", "\"rounding\": -1"}, {"\"frame\"", "7"}, {"15, 15", "15, 16"}, {"15, 15", "15"},
             {"15, 15", "15, 1e300"}, {"[0, 0", "[16, 0"}, {"15, 15]}]", "7, 7]}], \"regions\": []"},
             {"[0, 0, 15, 15]", std::string(100'000, '[') + std::string(100'000, ']')}})
        EXPECT_NE(mistake(from, to), "") << from << " -> " << to.substr(0, 40);
}

TEST_F(MomentFiles, DamagedFilesAreRefusedOrGiveFiniteNumbers) {
    const std::string good = bytes_of(file);
    const ComparePlan plan = renders.plan({box});
    int refused = 0;
    for (std::size_t k = 0; k < 400; ++k) {
        std::string bytes = good;
        const std::size_t place = (k * 2654435761u) % bytes.size();
        if (k % 4 == 0) bytes.resize(place);
        else bytes[place] = static_cast<char>(bytes[place] ^ (1 << k % 8));
        write("moments.exr", bytes);
        refused += !refusal([&] { return read_moments_header(file); }).empty();
        (void)refusal([&] {
            const RenderStats all = read(plan);
            for (const double x : all.arms[0].film.planes[0].m2) EXPECT_TRUE(std::isfinite(x));
            return 0;
        });
    }
    EXPECT_GT(refused, 0);
}

}  // namespace moments_test
}  // namespace crescent
