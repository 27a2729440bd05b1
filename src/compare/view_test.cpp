// Renders that do not fit each other, and files that change, as arms, pairs and reference.
#include "compare/view.h"

#include <cstring>
#include <gmock/gmock.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <utime.h>

#include "compare/renders.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/written_exr.h"

namespace crescent {
namespace view_test {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class Views : public ScratchFolder {
protected:
    /// Writes three renders with constant channels: "a0.exr" to "a2.exr" of arm a.
    void write_arm(const std::string& arm, WrittenExr exr, float brightness = 1) {
        for (int k = 0; k < 3; ++k) {
            const float y = brightness + 0.01f * static_cast<float>(k + arm[0]);
            exr.channels = {};
            exr.constant = {{"R", y}, {"G", 2 * y}, {"B", 4 * y}};
            exr.write(path(arm + std::to_string(k) + ".exr"));
        }
    }
    RenderStats read(std::vector<CompareFlag> flags = {}, const RenderSource& source = {}) const {
        flags.insert(flags.begin(), {{"arms", "a", "files"}, path("a?.exr"), false, "--arm"});
        ProgressMonitor monitor;
        return read_all(plan_of(flags), monitor, source);
    }
    /// Returns a render as it is compared.
    Render compared(const RenderStats& all, const char* file) const { return all.source.read(path(file), ""); }
    static CompareFlag align() { return {{"align"}, "display", false, "--align display"}; }
    static CompareFlag crop() { return {{"crop"}, "true", true, "--crop"}; }
    /// Flags that use the other renders as an arm, as a paired arm, as the reference.
    std::vector<std::vector<CompareFlag>> ways() const {
        const CompareFlag arm{{"arms", "b", "files"}, path("b?.exr"), false, "--arm"};
        return {
            {arm}, {arm, {{"pair"}, "true", true, "--pair"}}, {{{"reference"}, path("b?.exr"), false, "--reference"}}};
    }
};

TEST_F(Views, DataWindowsThatDifferAreRefusedAlignedOrCropped) {
    WrittenExr exr;
    write_arm("a", exr);
    exr.data = {{2, 0}, {22, 12}};
    write_arm("b", exr);
    for (std::vector<CompareFlag> way : ways()) {
        EXPECT_THAT(refusal([&] { return read(way); }),
            AllOf(
                HasSubstr("b0.exr: data windows differ by (2, 0)"), HasSubstr("--align display"), HasSubstr("--crop")));
        way.push_back(align());
        const RenderStats aligned = read(way);
        EXPECT_EQ(aligned.width, 21);
        EXPECT_EQ(compared(aligned, "b0.exr").r[1], 0.0f);  // outside of its data window
        EXPECT_GT(compared(aligned, "b0.exr").r[2], 0.9f);
        way.back() = crop();
        const RenderStats cropped = read(way);
        EXPECT_EQ(cropped.width, 19);
        EXPECT_EQ(cropped.height, 13);
        EXPECT_EQ(cropped.regions.back().pixels.size(), 19u * 13u);
        way.push_back(align());
        EXPECT_THAT(refusal([&] { return read(way); }), HasSubstr("expected one of them"));
    }
    exr.data = exr.display = {{40, 0}, {60, 12}};
    write_arm("b", exr);
    std::vector<CompareFlag> apart = ways()[0];
    apart.push_back(crop());
    EXPECT_THAT(refusal([&] { return read(apart); }), HasSubstr("expected pixels that all renders have"));
}

TEST_F(Views, CroppedPixelsAreThoseOfTheSamePlace) {
    WrittenExr exr;  // the same picture in two windows
    exr.channels = {"R", "G", "B"};
    exr.write(path("a0.exr"));
    exr.data = {{4, 3}, {30, 20}};
    exr.write(path("b0.exr"));
    std::vector<CompareFlag> flags = ways()[0];
    flags.push_back(crop());
    const RenderStats all = read(flags);
    EXPECT_EQ(all.width, 17);
    EXPECT_EQ(all.height, 10);
    EXPECT_EQ(compared(all, "a0.exr").r, compared(all, "b0.exr").r);
    EXPECT_EQ(compared(all, "a0.exr").r[0], WrittenExr::value(0, 4, 12));
}

TEST_F(Views, AHugeFrameAroundAFewPixelsIsRefused) {
    WrittenExr exr;
    exr.display = {{0, 0}, {59999, 59999}};
    write_arm("a", exr);
    EXPECT_THAT(refusal([&] { return read(); }), HasSubstr("display window"));
    EXPECT_EQ(read({crop()}).width, 21);
}

TEST_F(Views, PrimariesAreConvertedToThoseOfTheFirst) {
    WrittenExr exr;
    write_arm("b", exr);
    Imf::addChromaticities(exr.more, {{0.713f, 0.293f}, {0.165f, 0.83f}, {0.128f, 0.044f}, {0.32168f, 0.33767f}});
    write_arm("a", exr);
    for (const std::vector<CompareFlag>& way : ways()) {
        const RenderStats all = read(way);
        const double y = 1 + 0.01 * 'a';  // the brightness of a0; Y by the weights of ACES AP1
        EXPECT_NEAR(compared(all, "a0.exr").y(0), y * (0.2722287 + 2 * 0.6740818 + 4 * 0.0536895), 1e-4);
        const Render other = compared(all, "b0.exr");
        const Rgb rgb = transformed(conversion({}, all.primaries), {1, 2, 4});
        EXPECT_NEAR(other.r[0] / other.g[0], rgb[0] / rgb[1], 1e-5);
        EXPECT_THAT(
            all.warnings, ::testing::Contains(AllOf(HasSubstr("(the first of 3 files)"), HasSubstr("primaries"))));
    }
}

TEST_F(Views, AFileThatChangesBetweenReadingsIsRefused) {
    WrittenExr exr;
    const auto changes = std::vector<std::pair<const char*, std::function<void(const std::string&)>>>{
        {"other pixels",
            [&](const std::string& file) {
                WrittenExr other = exr;
                other.constant = {{"R", 3.0f}, {"G", 3.0f}, {"B", 3.0f}};
                other.channels = {};
                other.write(file);
            }},
        {"another size",
            [&](const std::string& file) {
                WrittenExr other = exr;
                other.data = other.display = {{0, 0}, {9, 5}};
                other.write(file);
            }},
        {"cut off", [&](const std::string& file) { std::filesystem::resize_file(file, 400); }},
        {"its time",
            [&](const std::string& file) {
                const utimbuf long_ago{0, 0};
                ASSERT_EQ(::utime(file.c_str(), &long_ago), 0);
            }},
        {"another file",
            [&](const std::string& file) {
                std::filesystem::copy(file, path("copy"));
                std::filesystem::rename(path("copy"), file);
            }},
        {"gone", [&](const std::string& file) { std::filesystem::remove(file); }}};
    for (const auto& [what, change] : changes)
        for (const std::vector<CompareFlag>& way : ways())
            for (const char* which : {"a1.exr", "b2.exr"}) {
                SCOPED_TRACE(what);
                write_arm("a", exr);
                write_arm("b", exr);
                int readings = 0;
                RenderSource source;
                source.read = [&](const std::string& file, const std::string& layer) {
                    if (++readings == 7) change(path(which));  // three of a, three of b, then all again
                    return read_render(file, layer);
                };
                EXPECT_THAT(refusal([&] { return read(way, source); }), StartsWith(path(which) + ": "));
            }
}

TEST_F(Views, AFileThatIsNotRegularIsRefusedAtOnce) {
    ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
    EXPECT_THAT(refusal([&] { return read_render(path("pipe")); }), HasSubstr("pipe"));
    EXPECT_THAT(refusal([&] { return read_render("/dev/zero"); }), HasSubstr("device"));
    std::filesystem::create_directory(path("folder"));
    EXPECT_THAT(refusal([&] { return read_render(path("folder")); }), HasSubstr("folder"));
    const int s = ::socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, path("socket").c_str(), sizeof address.sun_path - 1);
    ASSERT_EQ(::bind(s, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    EXPECT_THAT(refusal([&] { return read_render(path("socket")); }), HasSubstr("socket"));
    ::close(s);
}

TEST_F(Views, EqualWarningsAreMerged) {
    WrittenExr exr;
    for (int k = 0; k < 12; ++k) {
        exr.channels = {"R", "G"};
        exr.constant = {{"B", -1.0f - static_cast<float>(k)}};
        exr.write(path(fmt::format("a{:c}.exr", 'a' + k)));
    }
    EXPECT_THAT(read().warnings,
        ElementsAre(AllOf(HasSubstr("aa.exr (the first of 12 files): 273 pixels with a negative channel"))));
}

TEST_F(Views, MasksApplyToTheImageRegardlessOfTheirOrigin) {
    WrittenExr exr;
    exr.data = {{2, 1}, {17, 12}};
    write_arm("a", exr);
    std::string mask = "Pf\n21 13\n-1.0\n";
    for (int i = 0; i < 21 * 13; ++i) {
        const float on = i % 21 == 4 ? 1.0f : 0.0f;
        mask.append(reinterpret_cast<const char*>(&on), sizeof on);
    }
    const CompareFlag flag{{"masks", "column", "file"}, write("mask.pfm", mask), false, "--mask"};
    EXPECT_EQ(read({flag}).regions[0].pixels,
        (std::vector<std::uint32_t>{4, 25, 46, 67, 88, 109, 130, 151, 172, 193, 214, 235, 256}));
    EXPECT_EQ(read({flag, crop()}).regions[0].pixels.front(), 2u);  // column 4 of the frame
    const CompareFlag small{{"masks", "m", "file"}, write("small.pfm", "Pf\n1 1\n-1.0\n1234"), false, "--mask"};
    EXPECT_THAT(refusal([&] { return read({small}); }), HasSubstr("expected 21 x 13 pixels as the renders have"));
}

}  // namespace view_test
}  // namespace crescent
