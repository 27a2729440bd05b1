// Valid files: overrides on the command line, inherited values, stable hashes, and a manual that agrees with the
// parser.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "experiment/experiment.h"
#include "experiment/identity.h"
#include "experiment/json_schema.h"
#include "experiment/overrides.h"
#include "experiment/published.h"
#include "experiment/schema.h"
#include "experiment/schema_table.h"
#include "tests/support/scene_text.h"

namespace crescent {
namespace experiment_test {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string folder = std::string(CRESCENT_SOURCE_DIR) + "/experiments/";
Experiment gallery(const std::vector<std::string>& overrides = {}) { return load(folder + "gallery.toml", overrides); }

std::string complaint(const std::vector<std::string>& overrides) {
    try {
        (void)gallery(overrides);
    } catch (const InputError& error) { return error.what(); }
    return "";
}

TEST(Experiments, TheGalleryHoldsTheNote) {
    const Experiment e = gallery();
    EXPECT_EQ(e.image.width, 960);
    EXPECT_EQ(e.seed, 329363537u);
    EXPECT_EQ(e.reference.seed, 1374605335u);
    EXPECT_EQ(e.plates.size(), 11u);
    EXPECT_GE(e.assertions.size(), 24u);
    EXPECT_EQ(e.furnaces.size(), 3u);
    EXPECT_EQ(e.s(), 32);
    EXPECT_THAT(e.find_arm("uniform")->n, ElementsAre(64u));
    EXPECT_THAT(e.find_arm("phong")->n, ElementsAre(4u, 16u, 64u, 256u));
    EXPECT_THAT(e.exponent->s, ElementsAre(8, 32, 128));
    EXPECT_EQ(e.exponent->n, 64u);
    EXPECT_EQ(to_string(e.place_of("shapes.sphere.radius")).substr(folder.size()), "gallery.toml:39:10");
}

TEST(Experiments, AllOfThemAreGood) {
    for (const char* name : {"gallery", "two-lamps", "empty-room", "three-glosses"})
        EXPECT_NO_THROW((void)load(folder + name + ".toml")) << name;
}

TEST(Experiments, ShapesStandInFileOrder) {
    std::vector<std::string> names;
    for (const Shape& shape : gallery().shapes) names.push_back(shape.name);
    EXPECT_THAT(names, ElementsAre("sphere", "plinth", "foot", "floor", "wall", "canvas", "rail"));
}

TEST(Skies, HaveAPairedReference) {
    const std::string scene = test::view_text + test::ball_text + R"(
[sky]
file = "images/sky.exr"
rotation = 45
[arms.sky]
n = 4
)";
    const auto parsed = [&](const std::string& more) { return parse(scene + more, "folder/a.toml"); };
    const auto complaint = [&](const std::string& more) -> std::string {
        try {
            (void)parsed(more);
        } catch (const InputError& error) { return error.what(); }
        return "";
    };
    const Experiment e = parsed("");
    EXPECT_EQ(e.sky->file, "folder/images/sky.exr");
    EXPECT_EQ(e.sky->rotation, 45);
    EXPECT_EQ(e.sky->scale, 1);
    EXPECT_EQ(e.reference.kind, ReferenceKind::paired);
    EXPECT_EQ(e.reference.n, paired_samples);
    EXPECT_EQ(parsed("[reference]\nn = 7\n").reference.n, 7u);
    EXPECT_EQ(missed_light(e.arms[0], e), "");
    EXPECT_EQ(missed_light({"a", "light-area", {4}, {}}, e), "the sky");
    EXPECT_EQ(hash(parse(canonical_text(e), "b.toml")), hash(parse(canonical_text(e), "c.toml")));
    EXPECT_THAT(complaint("[reference]\nkind = \"quadrature\"\n"), HasSubstr("\"paired\""));
    EXPECT_THAT(complaint("[reference]\nmonte_carlo = true\n"), HasSubstr("reference.monte_carlo"));
    EXPECT_THAT(complaint("[fill]\nradius = 1\n"), HasSubstr("unknown key"));
    Experiment pinned = e, moved = e;
    pinned.sky->content = moved.sky->content = "0123456789abcdef";
    moved.sky->file = "elsewhere.exr";
    EXPECT_EQ(hash(pinned), hash(moved));
    moved.sky->content = "0123456789abcdee";
    EXPECT_NE(hash(pinned), hash(moved));
}

TEST(Renderers, CombineTheMaterialWithEveryKindOfLight) {
    const std::string scene = test::view_text + test::ball_text + "[arms.pt]\nsampler = \"renderer\"\nn = 4\n";
    const std::string disk = "[disks.d]\ncenter = [0, 3, 0]\nnormal = [0, -1, 0]\nradius = 1\nradiance = [1, 1, 1]\n",
                      sky = "[sky]\nfile = \"sky.exr\"\n";
    const auto arm = [&](const std::string& lights) { return parse(scene + lights, "a.toml").arms.at(0); };
    EXPECT_EQ(arm(test::fill_text).sampler, "material");
    EXPECT_FALSE(arm(test::fill_text).is_combination());
    EXPECT_THAT(arm(disk).combination.of, ElementsAre("material", "light-solid-angle"));
    EXPECT_THAT(arm(sky).combination.of, ElementsAre("material", "sky"));
    EXPECT_THAT(
        arm(disk + sky + "[meshes.lamp]\nfile = \"l.mesh\"\nrho_d = [0, 0, 0]\nemission = [1, 1, 1]\n").combination.of,
        ElementsAre("material", "light-solid-angle", "sky", "light-triangle"));
    const std::string written = R"(
[arms.pt]
kind = "mis"
of = ["material", "sky"]
n = 4
)";
    EXPECT_EQ(
        hash(parse(scene + sky, "a.toml")), hash(parse(test::view_text + test::ball_text + sky + written, "b.toml")));
    EXPECT_EQ(canonical_text(parse(canonical_text(parse(scene + sky, "a.toml")), "a.toml")),
        canonical_text(parse(scene + sky, "a.toml")));
}

TEST(WhatIfs, AreOneLineEach) {
    EXPECT_EQ(gallery({"seed=7"}).seed, 7u);
    EXPECT_EQ(gallery({"firefly_k=2.5"}).firefly_k, 2.5);
    EXPECT_EQ(gallery({"key.radius=0.3"}).disks[0].radius, 0.3);
    EXPECT_EQ(gallery({"sphere.rho_d=[0,0,0]"}).shapes[0].material.rho_d, (Rgb{0, 0, 0}));
    EXPECT_EQ(gallery({"H.box=[500,390,560,440]"}).find_region("H")->box.x1, 560);
    EXPECT_EQ(gallery({"fill.radiance.1=9"}).fill[1], 9);
    EXPECT_EQ(gallery({"key.radiance[2]=9"}).disks[0].radiance[2], 9);
    EXPECT_EQ(gallery({"reference.kind=note"}).reference.kind, ReferenceKind::note);
    EXPECT_EQ(gallery({"title=hello there"}).title, "hello there");
    EXPECT_EQ(std::get<shapes::Panel>(gallery({"canvas.depth = 0.1"}).find_shape("canvas")->form).depth, 0.1);
    EXPECT_EQ(gallery({"assertions.'region H has pixels'.over=median"}).assertions.size(), gallery().assertions.size());
    EXPECT_THAT(gallery({"arms.second={sampler=\"cosine\", n=9}"}).find_arm("second")->n, ElementsAre(9u));
}

TEST(WhatIfs, ExponentAppliesToAllThatNameNone) {
    const Experiment e = gallery({"sphere.s=64"});
    EXPECT_EQ(e.s(), 64);
    for (const Shape& shape : e.shapes) EXPECT_EQ(shape.material.s, 64) << shape.name;
    EXPECT_EQ(e.plates[0].runs[0].s, 0);
    EXPECT_EQ(to_string(e.assertions.back().check.left), "fireflies(phong, n=64)");
}

TEST(WhatIfs, OfNMoveEveryRunThatNamesNone) {
    const Experiment e = gallery({"n=256"});
    EXPECT_THAT(e.find_arm("uniform")->n, ElementsAre(256u));
    EXPECT_EQ(to_string(e.assertions.back().check.left), "fireflies(phong, n=256)");
    const Experiment ladder = gallery({"phong.n=[2,8]"});
    EXPECT_EQ(to_string(ladder.assertions.back().check.left), "fireflies(phong, n=8)");
    for (const PlatePlan& plate : ladder.plates) {
        if (plate.name == "ladder-phong") { EXPECT_EQ(plate.runs.size(), 2u); }
    }
}

TEST(WhatIfs, MeetTheChecksOfTheFile) {
    EXPECT_THAT(
        complaint({"sphere.s=many"}), HasSubstr("--set sphere.s=many: shapes.sphere.s: expected a number above 0"));
    EXPECT_THAT(complaint({"spere.s=3"}), HasSubstr("did you mean 'sphere'?"));
    EXPECT_THAT(complaint({"shapes.spere.s=3"}), HasSubstr("did you mean 'sphere'?"));
    EXPECT_THAT(complaint({"sphere.radis=3"}), HasSubstr("did you mean 'radius'?"));
    EXPECT_THAT(complaint({"image.width=480"}), HasSubstr("x from 0 to 479"));
    EXPECT_THAT(complaint({"key.normal=[0,-2,0]"}), HasSubstr("found length 2"));
    EXPECT_THAT(complaint({"sphere.rho_d.3=1"}), HasSubstr("expected an index from 0 to 2"));
    EXPECT_THAT(complaint({"sphere"}), HasSubstr("expected path=value"));
    EXPECT_THAT(complaint({"sphere.s="}), HasSubstr("expected a value"));
    EXPECT_THAT(complaint({"sphere.s=[1"}), HasSubstr("not TOML"));
    EXPECT_THAT(complaint({"published=nowhere.json"}), HasSubstr("No such file"));
    EXPECT_THAT(complaint({"seed.x=1"}), HasSubstr("no 'x' in 'seed'"));
    EXPECT_THAT(complaint({"seed=-1", "sphere.s=0"}),
        testing::AllOf(HasSubstr("--set seed=-1"), HasSubstr("--set sphere.s=0")));
}

TEST(AnotherS, ChangesTheShapeAndAllThatInheritIt) {
    const Experiment e = load(folder + "three-glosses.toml").with_s(7);
    EXPECT_EQ(e.s(), 7);
    EXPECT_EQ(e.find_shape("gloss")->material.s, 7);
    EXPECT_EQ(e.find_shape("floor")->material.s, 7);
    EXPECT_EQ(e.find_shape("lacquer")->material.s, 600);
    EXPECT_EQ(load(folder + "empty-room.toml").s(), 16);
}

TEST(AnotherS, IsAskedForWhereAnArmNeedsOne) {
    const std::string room = test::view_text + test::fill_text + test::floor_text;
    EXPECT_EQ(parse(room + "[arms.cosine]\nn = 4\n", "room").s(), 0);
    EXPECT_THROW((void)parse(room + "[arms.phong]\nn = 4\n", "room"), InputError);
}

/// Returns a valid value of a key, as TOML.
std::string example(const Key& key) {
    const double x = key.range.low > 0 ? key.range.low : 1;
    switch (key.type) {
        case Type::text:
        case Type::texts: return "\"text\"";
        case Type::check: return "\"bad(cosine) == 0\"";
        case Type::word: return '"' + key.words.front() + '"';
        case Type::flag: return "true";
        case Type::integer: return "1";
        case Type::number:
        case Type::gray: return fmt::format("{}", x);
        case Type::factors: return "[1, 2, 3]";
        case Type::matrix: return "[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]";
        case Type::point:
        case Type::color: return "[1, 1, 1]";
        case Type::direction: return "[0, 0.6, 0.8]";
        case Type::numbers: return "[1.5, 2]";
        case Type::integers:
        case Type::counts: return "[1, 2]";
        case Type::formulas: return "[0.5, \"rest\"]";
        case Type::box: return "[0, 0, 0, 0]";
        case Type::sampler: return "\"cosine\"";
        case Type::arm: return "\"nobody\"";
        case Type::shape: return "\"nothing\"";
    }
    return "";
}

/// Sets every key of a section to a valid value, which the parser accepts. Returns the number of keys.
std::size_t take_every_key(const Section& section, const std::string& path) {
    std::size_t count = section.keys.size();
    const std::string prefix = path.empty() ? "" : path + ".";
    for (const Key& key : section.keys) {
        const std::string at = prefix + std::string(key.name),
                          message = complaint({fmt::format("{}={}", at, example(key))});
        EXPECT_THAT(message, testing::Not(HasSubstr("unknown key"))) << at;
        EXPECT_THAT(message, testing::Not(HasSubstr(fmt::format("{}: expected {}", at, expectation(key))))) << at;
        EXPECT_FALSE(key.means.empty()) << at;
        EXPECT_EQ(key.need == Requirement::required, key.default_value.empty()) << at;
        EXPECT_THAT(schema_text(), HasSubstr(fmt::format("  {}: ", key.name)));
    }
    for (const Section& sub : section.sections) {
        const std::string name(sub.name);
        count += take_every_key(sub,
            prefix +
                (sub.many == Multiplicity::one           ? name
                        : sub.many == Multiplicity::list ? name + ".0"
                        : name == "plates"               ? "plates.hero"
                                                         : name + ".probe"));
    }
    return count;
}

TEST(TheSchema, NamesTheKeysThatTheParserTakes) { EXPECT_GT(take_every_key(schema(), ""), schema().keys.size()); }

TEST(TheSchema, TellsEditorsOfEveryKey) {
    const std::string json = schema_json();
    std::size_t describe = 0;
    for (std::size_t at = 0; (at = json.find(" Expects ", at)) != std::string::npos; ++at) ++describe;
    // A titled family is described twice: as tables under names and as a list.
    std::size_t titled = 0;
    for (const Section& section : schema().sections)
        titled += section.many == Multiplicity::titled ? section.keys.size() : 0;
    EXPECT_EQ(describe, take_every_key(schema(), "") + titled);
}

TEST(TheSchema, JoinsTheKindsThatTakeAKeyInWords) {
    EXPECT_EQ(alternatives("sphere"), "sphere");
    EXPECT_EQ(alternatives("sphere disk"), "sphere or disk");
    EXPECT_EQ(alternatives("quad panel triangle"), "quad, panel or triangle");
    EXPECT_EQ(alternatives("a b c d"), "a, b, c or d");
}

TEST(TheSchema, FitsEightyColumns) {
    std::size_t start = 0;
    const std::string text = schema_text();
    for (std::size_t end; (end = text.find('\n', start)) != std::string::npos; start = end + 1)
        EXPECT_LE(end - start, 80u) << text.substr(start, end - start);
}

TEST(PublishedFigures, AreLookedUpByArmNSAndMeter) {
    const auto published = load_published(folder + "published.json");
    ASSERT_TRUE(published);
    EXPECT_EQ(published->find("cosine", 64, 32, "rmse.H"), 7.65562);
    EXPECT_EQ(published->find("phong", 256, 32, "rmse.S"), 1.75473);
    EXPECT_EQ(published->find("phong", 64, 128, "fireflies"), 587);
    EXPECT_EQ(published->find("phong", 65, 32, "rmse.H"), std::nullopt);
    EXPECT_EQ(published->furnace("phong_combined"), 0.193);
    EXPECT_FALSE(load_published(""));
}

TEST(Overrides, GiveATextThatIsReadTheSame) {
    const std::string text = "title = \"a \\\"b\\\" \\\\\"\nn = 4\n" + test::view_text + test::ball_text +
        test::fill_text +
        "[arms.cosine]\n[arms.uniform]\n[plates.hero]\nkind = \"hero\"\nruns = [{arm = \"cosine\"}]\n";
    const std::vector<std::string> changes = {
        "n=16", "ball.radius=0.1", "arms.uniform.n=[1, 2]", "fill.radiance=[1, 2, 3e-3]"};
    const std::string changed = text_with_overrides(text, "a.toml", changes);
    EXPECT_EQ(canonical_text(parse(changed, "a.toml")), canonical_text(parse(text, "a.toml", changes)));
    EXPECT_EQ(canonical_text(parse(changed, "a.toml", {"n=64"})),
        canonical_text(parse(text, "a.toml", {changes[0], changes[1], changes[2], changes[3], "n=64"})));
    EXPECT_THROW((void)text_with_overrides(text, "a.toml", {"nothing.at.all=3"}), InputError);
}

TEST(PublishedFigures, OfTheWrongFormAreTheReadersMistake) {
    const auto message = [](const char* text) -> std::string {
        try {
            (void)parse_published(text, "p.json");
        } catch (const InputError& error) { return error.what(); }
        return "";
    };
    EXPECT_THAT(message("{\n  \"runs\": [}"), HasSubstr("p.json:2:12: not JSON"));
    EXPECT_THAT(message("[]"), HasSubstr("expected an object"));
    EXPECT_THAT(message("{\"runs\": [{\"arm\": 3}]}"), HasSubstr("/runs/0: expected an object with arm"));
    EXPECT_THAT(message("{\"runs\": [3]}"), HasSubstr("/runs/0: expected an object with arm"));
    EXPECT_THAT(message("{\"runs\": [{\"arm\": \"a\", \"n\": 4, \"s\": 1, \"rmse.H\": null}]}"),
        HasSubstr("/runs/0/rmse.H: expected a number"));
    EXPECT_THAT(message("{\"furnaces\": {\"a\": \"b\"}}"), HasSubstr("/furnaces/a: expected a number"));
    EXPECT_THAT(message("{\"rums\": []}"), HasSubstr("/rums"));
    EXPECT_EQ(message("{}"), "");
}

}  // namespace experiment_test
}  // namespace crescent
