// Failures of contexts, framebuffers and shaders are OutputErrors (exit 3) that contain the driver's message.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "backend.h"
#include "context.h"
#include "tests/support/gl_test_scene.h"

namespace crescent::gl {
namespace context_test {

using testing::AllOf;
using testing::HasSubstr;

template <class Error, class Call> std::string what_of(Call&& call) {
    try {
        call();
    } catch (const Error& e) { return e.what(); }
    return "nothing was thrown";
}

TEST(Shaders, EveryArmHasItsFileAndCompilesOnEveryLobe) {
    for (const std::string& arm : test::all_arms())
        for (const int lobe : {-1, 0, 1, 2})
            EXPECT_NO_THROW(Program(test::context(), estimator_source(arm, lobe, {2}, {1, 1, 1, 1, 1})))
                << arm << " on lobe " << lobe;
}

TEST(Shaders, CompileErrorHasDriverLogAndFile) {
    ShaderSource source;
    source.include("random.glsl");
    source.add("planted.glsl",
        "#include \"math.glsl\"\nout vec4 colour;\nvoid main() { colour = vec4(sincos_turns(0.5)); }\n");
    EXPECT_THAT(what_of<OutputError>([&] { Program(test::context(), source); }),
        AllOf(HasSubstr("does not compile"), HasSubstr("1000 + n: planted.glsl"), HasSubstr("1003"),
            HasSubstr(test::context().renderer())));
}

TEST(Shaders, OneThatDoesNotLinkIsToldToo) {
    ShaderSource source;
    source.add(
        "planted.glsl", "float missing(float x);\nout vec4 colour;\nvoid main() { colour = vec4(missing(0.5)); }\n");
    EXPECT_THAT(what_of<OutputError>([&] { Program(test::context(), source); }),
        AllOf(HasSubstr("does not link"), HasSubstr("missing")));
}

TEST(Framebuffers, AreCompleteRgba32fWithoutSrgbAndMsaa) {
    const Framebuffer composite(test::context(), 1280, 720, 1), film(test::context(), 960, 540, 8);
    for (const Framebuffer* f : {&composite, &film}) {
        f->bind();
        EXPECT_EQ(f->bits(), 32);
        EXPECT_FALSE(f->srgb());
        EXPECT_EQ(f->multisamples(), 0);
    }
}

TEST(Framebuffers, TooManyBuffersAreRejected) {
    EXPECT_THAT(what_of<OutputError>([] { Framebuffer(test::context(), 16, 16, 1000); }), HasSubstr("1000 are needed"));
}

TEST(Framebuffers, TooLargeIsRejectedWithTheDriverLog) {
    GLint largest = 0;
    test::context().gl().GetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
    EXPECT_THAT(what_of<OutputError>([&] { Framebuffer(test::context(), largest + 1, 4, 1); }),
        AllOf(HasSubstr("GL_INVALID_VALUE"), HasSubstr("of a framebuffer")));
    EXPECT_NO_THROW(Framebuffer(test::context(), 16, 16, 1));  // the context still works afterwards
}

TEST(LostContext, EndsTheFilmWithAnErrorThatSaysSo) {
    const Scene scene(test::small_scene());
    ProgressMonitor monitor;
    const std::unique_ptr<Context> mine = open_context({});
    Estimator gl(*mine);
    static_cast<void>(gl.films(scene, "cosine", {4}, 1, monitor));
    mine->release();
    EXPECT_THAT(
        what_of<OutputError>([&] { gl.films(scene, "cosine", {4}, 1, monitor); }), HasSubstr("context was lost"));
}

TEST(Contexts, WrongChoiceIsAnInputErrorWithChoices) {
    EXPECT_THAT(what_of<InputError>([] { open_context({"glx", -1}); }), HasSubstr("expected egl or osmesa"));
    EXPECT_THAT(what_of<InputError>([] { open_context({"osmesa", 0}); }), HasSubstr("OSMesa has no devices"));
    EXPECT_THAT(what_of<InputError>([] { open_context({"egl", 999}); }), HasSubstr("crescent list devices"));
}

TEST(Contexts, MissingLibraryIsNamedWithItsPurpose) {
    EXPECT_THAT(what_of<OutputError>([] { Library("libNoSuchGL.so.7", "--instrument gl", "libnosuch7"); }),
        AllOf(HasSubstr("libNoSuchGL.so.7 cannot be opened"), HasSubstr("--instrument gl"), HasSubstr("No such file"),
            HasSubstr("install the packages libnosuch7")));
}

TEST(GlBackend, IsRegisteredByItsWordAndSaysWhatItRunsOn) {
    const auto kind = find_backend("gl");
    ASSERT_TRUE(kind);
    EXPECT_FALSE(kind->devices().empty());
    const std::shared_ptr<Backend> one = kind->open({});
    EXPECT_THAT(one->name(), AllOf(HasSubstr("GL "), HasSubstr("EGL surfaceless")));
    ASSERT_EQ(one->details().size(), 3u);
    for (const auto& [what, message] : one->details()) EXPECT_FALSE(message.empty()) << what;
    EXPECT_EQ(find_backend("telescope"), nullptr);
}

TEST(Pacer, BudgetFollowsSpeedAndGrowsSlowly) {
    Pacer pacer;
    EXPECT_TRUE(pacer.untried());
    const std::uint64_t first = pacer.budget();
    pacer.took(first, 1e-6);
    EXPECT_EQ(pacer.budget(), 4 * first);  // at any speed
    pacer.took(1'000'000, 2 * Pacer::aim_s);
    EXPECT_LE(pacer.budget(), 500'000u);  // a slower draw takes effect at once
    EXPECT_DOUBLE_EQ(pacer.longest_s(), 2 * Pacer::aim_s);
}

TEST(Rectangles, CoverTheImageOnceAndStaySmall) {
    for (const auto& [width, height, disks, side] :
        {std::tuple{960, 540, 1, 16384}, {7680, 4320, 64, 4096}, {5, 3, 0, 2}, {100000, 1, 2, 16384}}) {
        std::vector<int> times(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
        const auto all = rectangles_of(width, height, {static_cast<std::size_t>(disks)}, side);
        for (const TileBox& box : all) {
            EXPECT_LE(box.x1 - box.x0, side);
            EXPECT_LE(box.y1 - box.y0, side);
            for (int y = box.y0; y < box.y1; ++y)
                for (int x = box.x0; x < box.x1; ++x)
                    ++times[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                        static_cast<std::size_t>(x)];
        }
        EXPECT_EQ(std::count(times.begin(), times.end(), 1), static_cast<std::ptrdiff_t>(times.size()));
    }
    EXPECT_EQ(rectangles_of(960, 540, {1}, 16384).size(), 1u) << "the beauty is one film framebuffer";
}

}  // namespace context_test
}  // namespace crescent::gl
