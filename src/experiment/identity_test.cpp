// An experiment's identity is computed from its values: every value that changes an output changes it, and nothing else
// does.
#include "experiment/identity.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "experiment/experiment.h"
#include "experiment/schema.h"
#include "experiment/schema_table.h"
#include "tests/support/scene_text.h"

namespace crescent {
namespace identity_test {

const std::string folder = std::string(CRESCENT_SOURCE_DIR) + "/experiments/";

const std::string& room = test::room_text;

/// Returns a room with an element of every section and a shape of every kind.
Experiment with_everything() {
    return parse(room + R"toml(
[shapes.lobe]
kind = "sphere"
center = [2, 1, 0]
radius = 0.5
rho_d = [0.1, 0.1, 0.1]
rho_s = 0.2
s = 16
alpha = 0.3
[shapes.box]
kind = "box"
min = [-1, -1, -1]
max = [1, 0, 1]
rho_d = [0.1, 0.1, 0.1]
[shapes.quad]
kind = "quad"
corner = [3, 0, 0]
edge_u = [1, 0, 0]
edge_v = [0, 1, 0]
rho_d = [0.1, 0.1, 0.1]
[shapes.disk]
kind = "disk"
center = [0, 3, 0]
radius = 0.5
normal = [0, 0.6, 0.8]
rho_d = [0.1, 0.1, 0.1]
[shapes.plane]
kind = "plane"
point = [0, 0, 0]
normal = [0.26726, 0.53452, 0.80178]
rho_d = [0.1, 0.1, 0.1]
[shapes.panel]
kind = "panel"
corner = [-3, 0, 0]
edge_u = [1, 0, 0]
edge_v = [0, 1, 0]
depth = 0.1
reveal_rho_d = [0.2, 0.2, 0.2]
rho_d = [0.1, 0.1, 0.1]
[disks.key]
center = [1, 3, 1]
normal = [0, -1, 0]
radius = 0.2
radiance = [9, 8, 7]
[lights.bulb]
kind = "sphere"
center = [2, 3, 1]
radius = 0.2
radiance = [3, 2, 1]
[lights.window]
kind = "rectangle"
corner = [-3, 2, 1]
edge_u = [1, 0, 0]
edge_v = [0, 0, 1]
radiance = [1, 2, 3]
[lights.spot]
kind = "disk"
center = [-1, 3, 1]
normal = [0, -1, 0]
radius = 0.3
two_sided = true
radiance = [1, 1, 3]
[arms.phong]
n = [4, 16]
[exponent]
arm = "phong"
n = 16
s = [8, 16]
shape = "lobe"
[regions.H]
box = [1, 1, 5, 5]
[furnaces.white]
arm = "cosine"
shape = "lobe"
n = 64
[plates.pair]
kind = "columns"
crop = [0, 0, 3, 3]
caption = "a \"pair\" \\ of arms"
runs = [{arm = "cosine"}, {arm = "phong", n = 16, s = 8}]
[plates.climb]
kind = "ladder"
runs = [{arm = "phong"}]
[assertions."a 'quoted' \"name\""]
check = "rmse.H(phong) < rmse.H(cosine, n=4)"
)toml",
        "everything.toml", {"title=All", "n=16", "published=none.json"});
}

/// Returns another value of the same key.
Value changed(const Key& key, Value value) {
    value.flag = !value.flag;
    value.word = key.words.empty() ? value.word : (value.word + 1) % static_cast<int>(key.words.size());
    value.number = std::nextafter(value.number, 1e300);
    if (key.type == Type::integer) value.number = value.number < 2 ? value.number + 2 : std::ceil(value.number + 1);
    for (double& x : value.numbers) x += 1;
    if (key.type == Type::counts) value.numbers.push_back(2);
    value.text += "x";
    value.texts.push_back("x");
    return value;
}

/// Changes each key of each object in turn, except the number of seeds. Returns the number of keys of the table that
/// were tested.
std::size_t change_each(const Section& section, void* object, const Experiment& e, std::uint64_t before) {
    std::size_t met = 0;
    Value value, kind;
    const Key* kinds = section.find_key("kind");
    const std::string own =
        kinds && kinds->slot.load(object, kind) ? kinds->words[static_cast<std::size_t>(kind.word)] : "";
    for (const Key& key : section.keys) {
        if (!has_kind(key, own) || !key.slot.load(object, value)) continue;
        ++met;
        std::vector<std::pair<const Key*, Value>> lost;  // another kind has other parameters
        for (const Key& other : section.keys)
            if (&key == kinds && !other.kinds.empty() && has_kind(other, own))
                if (Value kept; other.slot.load(object, kept)) lost.emplace_back(&other, kept);
        key.slot.store(object, changed(key, value));
        if (&section != &schema() || key.name != "seeds") EXPECT_NE(hash(e), before) << section.name << "." << key.name;
        key.slot.store(object, value);
        for (const auto& [other, kept] : lost) other->slot.store(object, kept);
        EXPECT_EQ(hash(e), before) << section.name << "." << key.name;
    }
    for (const Section& sub : section.sections) {
        if (!sub.family.add) met += change_each(sub, object, e, before);
        else
            for (std::size_t i = 0; i < sub.family.size(object); ++i)
                met += change_each(sub, const_cast<void*>(sub.family.at(object, i)), e, before);
    }
    return met;
}

std::size_t keys_of(const Section& section) {
    std::size_t all = section.keys.size();
    for (const Section& sub : section.sections) all += keys_of(sub);
    return all;
}

TEST(Identity, GreyColourEqualsItsNumber) {
    const auto text_of = [](const char* value) {
        return canonical_text(parse(room, "a.toml", {std::string("ball.rho_s=") + value, "ball.s=9"}));
    };
    EXPECT_EQ(text_of("0.25"), text_of("[0.25, 0.25, 0.25]"));
    EXPECT_NE(text_of("0.25"), text_of("[0.25, 0.25, 0.2]"));
    const std::string coloured = text_of("[0.3, 0.1, 0.7]");
    EXPECT_EQ(coloured, canonical_text(parse(coloured, "b.toml")));
    const Experiment e = parse(coloured, "b.toml");
    EXPECT_DOUBLE_EQ(e.shapes[0].material.rho_s, luminance(Rgb{0.3, 0.1, 0.7}));
}

TEST(Identity, DependsOnEffectiveValuesAlone) {
    const std::uint64_t before = hash(parse(room, "a.toml"));
    EXPECT_EQ(before, hash(parse("# a comment\n\n" + room, "b.toml")));
    EXPECT_EQ(before, hash(parse(room + "sampler = \"cosine\"\n", "a.toml"))) << "a default written out";
    EXPECT_EQ(before, hash(parse(room, "a.toml", {"cosine.n=[4]", "ball.radius=1.0", "seed=1"})));
    EXPECT_EQ(before, hash(parse(room, "a.toml", {"seeds=16"}))) << "more seeds of the same experiment";
    EXPECT_NE(before, hash(parse(room, "a.toml", {"cosine.n=5"})));
    EXPECT_NE(before, hash(parse(room, "a.toml", {"seed=2"})));
    EXPECT_NE(before, hash(parse(room, "a.toml", {"ball.radius=1.0000001"})));
}

TEST(Identity, ChangesWithEachKeyOfTheSchema) {
    Experiment e = with_everything();
    EXPECT_GE(change_each(schema(), &e, e, hash(e)), keys_of(schema()));
}

TEST(Identity, ChangesWithWhatCodeChanges) {
    Experiment e = with_everything();
    const std::uint64_t before = hash(e);
    e.disks[0].radiance[0] *= 10;
    EXPECT_NE(hash(e), before) << "a lamp";
    e = with_everything();
    std::swap(e.shapes[0], e.shapes[1]);
    EXPECT_NE(hash(e), before) << "the order of shapes decides ties";
    e = with_everything();
    e.arms[1].n = {8, 16};
    EXPECT_NE(hash(e), before) << "another ladder of the same length";
    e = with_everything();
    e.shapes[0].material.inherits_s = false;
    EXPECT_NE(hash(e), before) << "an s that the exponent control leaves alone";
    EXPECT_NE(hash(e.with_s(3)), hash(e));
}

TEST(Identity, ChangesWithTheFileOfASampler) {
    const std::filesystem::path file =
        std::filesystem::path(testing::TempDir()) / (std::to_string(getpid()) + "_sampler.py");
    Experiment e = with_everything();
    e.arms[0].python = file.string() + ":sampler";
    const auto hash_with = [&](const char* code) {
        std::ofstream(file) << code;
        return hash(e);
    };
    const std::uint64_t before = hash_with("x = 1\n");
    EXPECT_NE(hash_with("x = 2\n"), before);
    EXPECT_EQ(hash_with("x = 1\n"), before);
    std::filesystem::remove(file);
}

TEST(Identity, RefusesAFileOfASamplerThatIsNoRegularFile) {
    const std::filesystem::path file =
        std::filesystem::path(testing::TempDir()) / (std::to_string(getpid()) + "_pipe.py");
    ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
    Experiment e = with_everything();
    for (const std::string& name : {file.string(), std::string("/dev/zero")}) {
        e.arms[0].plugin = name;
        EXPECT_THROW((void)hash(e), InputError) << name;
        e.arms[0].plugin.reset();
    }
    e.arms[0].python = file.string() + ":sampler";
    EXPECT_THROW((void)hash(e), InputError);
    std::filesystem::remove(file);
}

TEST(Identity, ReadsBackAsItself) {
    for (const char* name : {"gallery", "two-lamps", "empty-room", "three-glosses"}) {
        const Experiment e = load(folder + name + ".toml");
        const std::filesystem::path copy =
            std::filesystem::path(testing::TempDir()) / (std::to_string(getpid()) + ".toml");
        std::ofstream(copy) << canonical_text(e);
        EXPECT_EQ(hash(load(copy)), hash(e)) << canonical_text(e);
        std::filesystem::remove(copy);
    }
    const Experiment e = with_everything();
    EXPECT_EQ(canonical_text(parse(canonical_text(e), "everything.toml")), canonical_text(e));
}

TEST(Identity, HoldsWhatWasPublishedNotWhere) {
    const std::filesystem::path here =
        std::filesystem::path(testing::TempDir()) / ("identity-" + std::to_string(getpid()));
    std::filesystem::create_directories(here);
    std::ofstream(here / "room.toml") << room;
    std::ofstream(here / "a.json") << R"({"runs": [{"arm": "cosine", "n": 4, "s": 0, "y_mean": 0.5}]})";
    std::ofstream(here / "same.json") << R"({"runs": [ {"arm": "cosine", "n": 4, "s": 0, "y_mean": 0.50} ]})";
    std::ofstream(here / "b.json") << R"({"runs": [{"arm": "cosine", "n": 4, "s": 0, "y_mean": 0.6}]})";
    const auto hash_with = [&](const char* file) {
        return hash(load(here / "room.toml", {std::string("published=") + file}));
    };
    EXPECT_EQ(hash_with("a.json"), hash_with("same.json"));
    EXPECT_NE(hash_with("a.json"), hash_with("b.json"));
    EXPECT_NE(hash_with("a.json"), hash(load(here / "room.toml")));
    std::filesystem::remove_all(here);
}

}  // namespace identity_test
}  // namespace crescent
