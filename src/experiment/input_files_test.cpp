// The files of meshes: read once, their content as the identity, with and without them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "experiment/experiment.h"
#include "experiment/identity.h"
#include "tests/support/meshes.h"
#include "tests/support/scene_text.h"

namespace crescent {
namespace input_files_test {

class MeshFiles : public testing::Test {
protected:
    MeshFiles() {
        std::filesystem::create_directories(folder_);
        write("ball.mesh", test::sphere_mesh(9, 7));
        write("other.mesh", test::sphere_mesh(8, 7));
    }
    ~MeshFiles() override { std::filesystem::remove_all(folder_); }

    void write(const char* name, const Mesh& mesh) const {
        std::ofstream(folder_ / name, std::ios::binary) << mesh_file(mesh);
    }
    Experiment parsed(const std::string& text, const std::vector<std::string>& overrides = {}) const {
        return parse(text, (folder_ / "e.toml").string(), overrides);
    }

    const std::filesystem::path folder_ = std::filesystem::path(testing::TempDir()) / "crescent_mesh_files";
    const std::string text_ = test::view_text + test::fill_text + R"(
[meshes.a]
file = "ball.mesh"
rho_d = [0.5, 0.5, 0.5]
[meshes.b]
file = "ball.mesh"
rho_d = [0.5, 0.5, 0.5]
translate = [1, 0, 0]
[arms.cosine]
n = [4]
)";
};

TEST_F(MeshFiles, AreReadAndBuiltOnceWhileTheyAreInUse) {
    const Experiment first = with_files(parsed(text_)), again = with_files(parsed(canonical_text(first)));
    EXPECT_EQ(first.meshes[0].pack, first.meshes[1].pack);
    EXPECT_EQ(first.meshes[0].pack, again.meshes[0].pack);
    write("ball.mesh", test::sphere_mesh(10, 7));
    EXPECT_NE(with_files(parsed(text_)).meshes[0].pack, first.meshes[0].pack);
}

TEST_F(MeshFiles, HaveAContentThatStandsForThem) {
    const Experiment whole = with_files(parsed(text_));
    ASSERT_TRUE(whole.meshes[0].content);
    EXPECT_EQ(hash(parsed(canonical_text(whole))), hash(whole));  // without reading the files
    const Experiment other = with_files(parsed(canonical_text(whole), {"meshes.b.file=other.mesh"}));
    EXPECT_NE(other.meshes[1].content, whole.meshes[1].content);
    EXPECT_NE(hash(other), hash(whole));
    write("ball.mesh", test::sphere_mesh(10, 7));
    try {
        with_files(parsed(canonical_text(whole)));
        FAIL() << "another mesh is read";
    } catch (const InputError& error) {
        EXPECT_THAT(
            error.what(), testing::HasSubstr("meshes.a.content: expected a mesh and textures with the content"));
        EXPECT_GT(error.diagnostics().front().location.line, 0u);
    }
}

/// A sky is found in the folder of the experiment or below it, as a mesh is: no path and no link leads out of it.
TEST_F(MeshFiles, AndSkiesAreBelowTheExperiment) {
    namespace fs = std::filesystem;
    fs::create_directories(folder_ / "inner");
    RgbImage image = {.width = 8, .height = 4, .rgb = std::vector<float>(3 * 8 * 4, 1), .halves = {}};
    image.hash = hash_of_texels(image);
    for (const char* name : {"sky.image", "inner/sky.image"})
        std::ofstream(folder_ / name, std::ios::binary) << image_file(image);
    fs::create_symlink("../sky.image", folder_ / "inner" / "link.image");
    fs::create_symlink("sky.image", folder_ / "inner" / "here.image");
    std::ofstream(folder_ / "inner" / "e.toml")
        << test::view_text + test::ball_text + "[sky]\nfile = \"sky.image\"\n[arms.sky]\nn = 4\n";
    const auto mistake = [&](const std::string& file) -> std::string {
        try {
            (void)load((folder_ / "inner" / "e.toml").string(), {"sky.file=" + file});
            return "";
        } catch (const InputError& error) { return error.what(); }
    };
    for (const char* file : {"sky.image", "here.image", "../inner/sky.image"}) EXPECT_EQ(mistake(file), "");
    for (const std::string& file :
        {std::string("../sky.image"), (folder_ / "sky.image").string(), std::string("link.image")})
        EXPECT_THAT(mistake(file), testing::HasSubstr("expected a file in the folder of the experiment or below it"));
}

}  // namespace input_files_test
}  // namespace crescent
