// Reads written OpenEXR files back: channels by name, rows from the bottom, every value, the attributes.
#include "render/exr.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
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

/// Writes 8 x 4 pixels of one colour with this header.
void write_colour(const std::string& path, Imf::Header header, const std::array<float, 3>& rgb) {
    std::vector<float> pixels;
    for (std::size_t k = 0; k < 8 * 4; ++k) pixels.insert(pixels.end(), rgb.begin(), rgb.end());
    const Imath::Box2i window = header.dataWindow();
    Imf::FrameBuffer buffer;
    for (std::size_t c = 0; c < 3; ++c) {
        const std::string name(1, "RGB"[c]);
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        float* const origin = pixels.data() + c - 3 * (window.min.x + 8 * window.min.y);
        buffer.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(origin), 12, 12 * 8));
    }
    Imf::OutputFile file(path.c_str(), header);
    file.setFrameBuffer(buffer);
    file.writePixels(4);
}

TEST_F(Exr, ASkyInOtherPrimariesIsConverted) {
    Imf::Header header(8, 4);
    const Imf::Chromaticities aces(
        {0.7347f, 0.2653f}, {0.0f, 1.0f}, {0.0001f, -0.077f}, {0.32168f, 0.33767f});  // SMPTE ST 2065-1
    Imf::addChromaticities(header, aces);
    write_colour(path, header, {0.5f, 0.5f, 0.5f});
    const std::shared_ptr<const RgbImage> grey = read_sky(path);
    for (std::size_t k = 0; k < grey->size(); ++k) EXPECT_NEAR((*grey)[k], 0.5, 1e-4);  // white stays white
    write_colour(path, header, {0.5f, 0.4f, 0.35f});
    const std::shared_ptr<const RgbImage> warm = read_sky(path);
    const std::array expected = {0.6716, 0.3772, 0.3400};  // by the matrices of SMPTE RP 177 and of Bradford
    for (std::size_t k = 0; k < warm->size(); ++k) EXPECT_NEAR((*warm)[k], expected[k % 3], 2e-4) << k;
    Imf::addChromaticities(header, Imf::Chromaticities());  // Rec.709
    write_colour(path, header, {0.5f, 0.4f, 0.35f});
    EXPECT_EQ((*read_sky(path))[0], 0.5f);
}

TEST_F(Exr, APartOfAPictureIsNoSky) {
    const Imath::Box2i whole({0, 0}, {15, 7}), part({4, 2}, {11, 5});
    write_colour(path, Imf::Header(whole, part), {1, 1, 1});
    try {
        read_sky(path);
        ADD_FAILURE() << "a part was taken as the whole";
    } catch (const InputError& error) {
        EXPECT_NE(error.diagnostics().front().message.find("the pixels (4, 2) to (11, 5) of (0, 0) to (15, 7)"),
            std::string::npos);
    }
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
