// Reads written OpenEXR files back: channels by name, rows from the bottom, every value, the attributes.
#include "render/exr.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <bit>
#include <filesystem>
#include <limits>
#include <set>

namespace crescent {
namespace exr_test {

constexpr int width = 5, height = 3;

/// Returns rows from the top, in the order of the file.
template <class T>
std::vector<T> channel(const std::string& path, int part, const std::string& name, Imf::PixelType type) {
    Imf::MultiPartInputFile file(path.c_str());
    Imf::InputPart in(file, part);
    std::vector<T> rows(width * height);
    Imf::FrameBuffer buffer;
    buffer.insert(name, Imf::Slice(type, reinterpret_cast<char*>(rows.data()), sizeof(T), sizeof(T) * width));
    in.setFrameBuffer(buffer);
    in.readPixels(0, height - 1);
    return rows;
}

/// Returns a film with different numbers in every pixel of every plane, including the smallest and largest floats.
Film counting_film() {
    Film film(width, height, 16);
    float next = 0.125f;
    for (auto* plane : {&film.r, &film.g, &film.b, &film.y, &film.second_moment, &film.var, &film.largest})
        for (float& v : *plane) v = next += 1.03f;
    std::uint32_t count = 7;
    for (auto* plane : {&film.horizon, &film.light_hits})
        for (std::uint32_t& v : *plane) v = count += 1000003;
    film.r[0] = std::numeric_limits<float>::denorm_min();
    film.g[1] = std::numeric_limits<float>::max();
    film.y[2] = std::numeric_limits<float>::quiet_NaN();
    film.second_moment[3] = std::numeric_limits<float>::infinity();
    film.b[4] = -0.0f;
    return film;
}

template <class T> void expect_plane(const std::vector<T>& film, const std::vector<T>& file, const std::string& name) {
    for (int j = 0; j < height; ++j)
        for (int i = 0; i < width; ++i) {
            const T want = film[static_cast<std::size_t>(j * width + i)],
                    got = file[static_cast<std::size_t>((height - 1 - j) * width + i)];
            EXPECT_EQ(std::bit_cast<std::uint32_t>(want), std::bit_cast<std::uint32_t>(got))
                << name << " at " << i << ", " << j;
        }
}

class Exr : public testing::Test {
protected:
    std::string path =
        (std::filesystem::temp_directory_path() / ("crescent-exr-test-" + std::to_string(::getpid()) + ".exr"))
            .string();
    ~Exr() override { std::filesystem::remove(path); }
};

TEST_F(Exr, AFilmReadBackIsTheFilm) {
    const Film film = counting_film();
    Film second = film;
    second.r[6] = 99;
    write_exr(path, {{"n16", &film}, {"n64", &second}},
        {{"crescent.experiment", "0123456789abcdef"}, {"crescent.seed", "7"}});
    const std::pair<const char*, const std::vector<float>*> floats[] = {{"R", &film.r}, {"G", &film.g}, {"B", &film.b},
        {"luminance.Y", &film.y}, {"second_moment.Y", &film.second_moment}, {"variance.Y", &film.var},
        {"largest.Y", &film.largest}};
    for (const auto& [name, plane] : floats) expect_plane(*plane, channel<float>(path, 0, name, Imf::FLOAT), name);
    expect_plane(film.horizon, channel<std::uint32_t>(path, 0, "horizon.Y", Imf::UINT), "horizon.Y");
    expect_plane(film.light_hits, channel<std::uint32_t>(path, 0, "hits.Y", Imf::UINT), "hits.Y");
    expect_plane(second.r, channel<float>(path, 1, "R", Imf::FLOAT), "second part");
}

TEST_F(Exr, HasTheDocumentedChannelsAndAttributes) {
    const Film film = counting_film();
    write_exr(path, {{"n16", &film}, {"n64", &film}}, {{"crescent.experiment", "0123456789abcdef"}});
    const Imf::MultiPartInputFile file(path.c_str());
    ASSERT_EQ(file.parts(), 2);
    EXPECT_EQ(file.header(0).name(), "n16");
    EXPECT_EQ(file.header(1).name(), "n64");
    std::set<std::string> names;
    for (auto c = file.header(0).channels().begin(); c != file.header(0).channels().end(); ++c) names.insert(c.name());
    EXPECT_EQ(names,
        (std::set<std::string>{
            "R", "G", "B", "luminance.Y", "second_moment.Y", "variance.Y", "largest.Y", "horizon.Y", "hits.Y"}));
    EXPECT_EQ(file.header(0).typedAttribute<Imf::StringAttribute>("crescent.experiment").value(), "0123456789abcdef");
    EXPECT_EQ(file.header(0).dataWindow().max.x, width - 1);
    EXPECT_EQ(file.header(0).dataWindow().max.y, height - 1);
}

TEST(Halves, HaveTheValuesOfTheHalfOfOpenExr) {
    for (std::uint32_t bits = 0; bits < 0x10000; ++bits) {
        half expected;
        expected.setBits(static_cast<std::uint16_t>(bits));
        const float value = value_of_half(static_cast<std::uint16_t>(bits));
        if (std::isnan(float(expected))) EXPECT_TRUE(std::isnan(value)) << bits;
        else EXPECT_EQ(std::bit_cast<std::uint32_t>(value), std::bit_cast<std::uint32_t>(float(expected))) << bits;
    }
}

TEST_F(Exr, ASkyInHalfPrecisionStaysInIt) {
    RgbImage written = {.width = 8, .height = 4, .rgb = {}, .halves = {}};
    for (std::size_t k = 0; k < 3 * written.texels(); ++k) written.rgb.push_back(0.125f * static_cast<float>(k));
    written.hash = hash_of_texels(written);
    write_texture(path, written);
    const std::shared_ptr<const RgbImage> read = read_sky(path);
    EXPECT_TRUE(read->rgb.empty());
    ASSERT_EQ(read->size(), written.size());
    for (std::size_t k = 0; k < read->size(); ++k) EXPECT_EQ((*read)[k], written[k]);
    EXPECT_EQ(read->hash, written.hash);
    EXPECT_EQ(image_file(*read), image_file(written));
    EXPECT_EQ(smallest_number(*read), 0);
    EXPECT_EQ(texel_at(*read, 0.3, 0.6), texel_at(written, 0.3, 0.6));
}

TEST_F(Exr, AReferenceReadBackIsTheReference) {
    ReferenceFilm film(width, height, 32);
    float next = 3;
    for (auto* plane : {&film.r, &film.g, &film.b, &film.y, &film.error})
        for (float& v : *plane) v = next *= 1.07f;
    write_exr(path, std::vector<std::pair<std::string, const ReferenceFilm*>>{{"s32", &film}}, {});
    expect_plane(film.error, channel<float>(path, 0, "error.Y", Imf::FLOAT), "error.Y");
    expect_plane(film.g, channel<float>(path, 0, "G", Imf::FLOAT), "G");
}

}  // namespace exr_test
}  // namespace crescent
