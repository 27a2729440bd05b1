// Mistakes in a user's file: each is found at its place, with a helpful message.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiment/experiment.h"

namespace crescent {
namespace mistakes_test {

using testing::HasSubstr;

// One key per line, so that a case can name its place.
const std::string good = R"toml(seed = 5
n = 16
[image]
width = 64
height = 32
[camera]
eye = [0, 1, 5]
target = [0, 1, 0]
up = [0, 1, 0]
vfov_deg = 40
[shapes.ball]
kind = "sphere"
center = [0, 1, 0]
radius = 0.5
rho_d = [0.1, 0.2, 0.3]
rho_s = 0.1
s = 32
[shapes.brick]
kind = "box"
min = [-1, 0, -1]
max = [1, 1, 1]
rho_d = [0.1, 0.2, 0.3]
[shapes.board]
kind = "quad"
corner = [0, 0, 0]
edge_u = [1, 0, 0]
edge_v = [0, 1, 0]
rho_d = [0.1, 0.2, 0.3]
[disks.key]
center = [1, 3, 1]
normal = [0, -1, 0]
radius = 0.2
radiance = [9, 8, 7]
[arms.cosine]
n = [4, 16]
[arms.phong]
n = [4, 16]
[exponent]
arm = "phong"
s = [8, 32]
shape = "ball"
[regions.H]
box = [3, 3, 9, 9]
[furnaces.white]
arm = "cosine"
shape = "ball"
n = 64
[plates.pair]
kind = "columns"
runs = [{ arm = "cosine" }, { arm = "phong", n = 4 }]
[assertions]
ok.check = "rmse.H(phong) < rmse.H(cosine)"
)toml";

struct Mistake {
    std::string old_text, new_text;  // an edit of the valid file
    unsigned line, column;
    std::string phrase;
    std::size_t mistakes = 1;
};
void PrintTo(const Mistake& m, std::ostream* out) { *out << "'" << m.old_text << "' -> '" << m.new_text << "'"; }

std::string edited(const Mistake& m) {
    std::string text = good;
    if (m.old_text.empty()) return text + m.new_text;
    const auto at = text.find(m.old_text);
    EXPECT_NE(at, std::string::npos) << m.old_text;
    return text.replace(at, m.old_text.size(), m.new_text);
}

class AMistake : public testing::TestWithParam<Mistake> {};

TEST_P(AMistake, IsFoundWhereItStandsInWordsThatHelp) {
    const Mistake& m = GetParam();
    try {
        (void)parse(edited(m), "x.toml");
        FAIL() << "accepted: " << m.new_text;
    } catch (const InputError& error) {
        const Diagnostic& first = error.diagnostics().front();
        EXPECT_EQ(to_string(first.location), to_string(SourceLocation{"x.toml", m.line, m.column})) << error.what();
        EXPECT_THAT(first.message, HasSubstr(m.phrase)) << error.what();
        EXPECT_EQ(error.diagnostics().size(), m.mistakes) << error.what();
    }
}

TEST(Overrides, OfANameThatTwoTablesHaveAreAmbiguous) {
    const std::string text =
        std::string(good) + "[furnaces.cosine]\narm = \"cosine\"\nshape = \"ball\"\nn = 64\n";  // and an arm
    EXPECT_NO_THROW((void)parse(text, "x.toml", {"furnaces.cosine.n=32"}));
    try {
        (void)parse(text, "x.toml", {"cosine.n=32"});
        FAIL() << "one of two is changed";
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("'cosine.n' is ambiguous: expected"));
        EXPECT_THAT(error.what(), HasSubstr("arms.cosine.n"));
        EXPECT_THAT(error.what(), HasSubstr("furnaces.cosine.n"));
    }
}

/// Appended to the file: their first line is 53.
const Mistake combinations[] = {
    {"", "[arms.both]\nkind = \"mix\"\nof = [\"cosine\", \"phong\"]\n", 54, 8, "did you mean 'mis'?"},
    {"", "[arms.both]\nkind = \"mixture\"\nof = [\"cosine\", \"fong\"]\n", 55, 17, "did you mean 'phong'?"},
    {"", "[arms.both]\nkind = \"mixture\"\nof = [\"cosine\", \"phong\"]\nweights = [0.5, 0.25]\n", 56, 11,
        "expected weights from 0 to 1 whose sum is one, found 0.5, 0.25 with sum 0.75"},
    {"", "[arms.both]\nkind = \"mixture\"\nof = [\"cosine\", \"phong\"]\nweights = [1.5, -0.5]\n", 56, 11,
        "expected weights from 0 to 1"},
    {"", "[arms.both]\nkind = \"mixture\"\nof = [\"cosine\", \"phong\"]\nweights = [1]\n", 56, 11,
        "expected 2 weights, one for each of 'of', found 1"},
    {"", "[arms.both]\nkind = \"mixture\"\nof = [\"cosine\", \"phong\"]\nweights = [\"roh_s\", \"rest\"]\n", 56, 11,
        "did you mean 'rho_s'?"},
    {"", "[arms.both]\nkind = \"mixture\"\nof = [\"cosine\", \"phong\"]\nweights = [\"p1\", \"rest\"]\n", 56, 11,
        "unknown name 'p1'"},
    {"", "[arms.both]\nkind = \"mis\"\nof = [\"cosine\", \"phong\"]\nweights = [\"p1/(p1+p2)\", \"p2/p1\"]\n", 56, 11,
        "whose sum is one"},
    {"", "[arms.both]\nkind = \"mis\"\nof = [\"cosine\", \"phong\"]\nheuristic = \"power\"\nweights = [0.5, 0.5]\n", 57,
        11, "expected weights or a heuristic, found both"},
    {"", "[arms.both]\nkind = \"mis\"\nof = [\"cosine\", \"mis-power\"]\n", 55, 17, "is two samplers with weights"},
    {"", "[arms.both]\nkind = \"mis\"\nof = [\"cosine\", \"both\"]\n", 55, 17, "found the arm itself"},
    {"", "[arms.both]\nkind = \"ris\"\nof = [\"cosine\"]\n", 53, 7, "missing key 'candidates'"},
    {"", "[arms.both]\nkind = \"ris\"\nof = [\"cosine\"]\ncandidates = 4\ntarget = \"prodct\"\n", 57, 10,
        "did you mean 'product'?"},
    {"", "[arms.both]\nkind = \"mis\"\nof = [\"cosine\", \"phong\"]\nprobabilities = [0.5, 0.5]\n", 56, 17,
        "expected draw = \"one\""},
    {"", "[arms.both]\nof = [\"cosine\", \"phong\"]\n", 54, 6, "expected a kind beside it"},
    {"", "[arms.pt]\nsampler = \"rendrer\"\n", 54, 11, "did you mean 'renderer'?"},
    {"", "[arms.pt]\nsampler = \"renderer\"\n[arms.material]\nsampler = \"cosine\"\n", 55, 7,
        "expected the sampler 'material', which the arm 'pt' combines, or another name"},
    {"", "[arms.both]\nkind = \"mis\"\nof = [\"cosine\"]\n", 55, 6, "expected 2 to 16 samplers, found 1"},
};

const Mistake keys_and_types[] = {
    {"seed = 5", "sead = 5", 1, 1, "did you mean 'seed'?"},
    {"radius = 0.5", "radius = 0.5\nradis = 1", 15, 1, "unknown key 'radis' in [shapes.ball]"},
    {"[image]", "[images]\n[image]", 3, 2, "did you mean 'image'?"},
    {"radius = 0.5\n", "", 11, 9, "missing key 'radius' in [shapes.ball]: expected a number from 1e-06"},
    {"[camera]\neye = [0, 1, 5]\ntarget = [0, 1, 0]\nup = [0, 1, 0]\nvfov_deg = 40\n", "", 1, 1,
        "missing a table [camera]"},
    {"seed = 5", "seed = 5\nseed = 6", 2, 8, "cannot redefine"},
    {"[shapes.brick]", "[shapes.ball]", 18, 1, "duplicate name"},
    {"width = 64", "width = 64.0", 4, 9, "expected an integer from 1 to 16384 (pixels), found 64.0"},
    {"width = 64", "width = \"64\"", 4, 9, "found the text '64'"},
    {"width = 64", "width = 1979-05-27", 4, 9, "found a date or time"},
    {"seed = 5", "seed = true", 1, 8, "found true"},
    {"eye = [0, 1, 5]", "eye = [0, 1]", 7, 7, "expected 3 numbers [x, y, z]"},
    {"eye = [0, 1, 5]", "eye = 3", 7, 7, "found 3"},
    {"eye = [0, 1, 5]", "eye = [0, 1, \"5\"]", 7, 14, "found the text '5'"},
    {"eye = [0, 1, 5]", "eye = []", 7, 7, "found a list of 0"},
    {"[exponent]", "[[exponent]]", 38, 1, "expected a table [exponent], found a list of 1"},
    {"kind = \"sphere\"", "kind = \"spere\"", 12, 8, "did you mean 'sphere'?"},
    {"kind = \"box\"", "kind = \"mesh\"", 19, 8, "README.md says what a scene can be"},
    {"kind = \"box\"", "kind = 3", 19, 8, "expected one of sphere, box"},
    {"min = [-1, 0, -1]", "min = [-1, 0, -1]\nradius = 1", 21, 1, "a box has no key 'radius'"},
    {"min = [-1, 0, -1]", "min = [1e300, 0, -1]", 20, 8, "found 1e+300"},
    {"runs = [{", "runs = [3, {", 50, 9, "plates.pair.runs.0: expected a table, found 3"},
    {"n = 4 }]", "n = 4, m = 2 }]", 50, 53, "unknown key 'm' in [plates.pair.runs.1]"},
    {"runs = [{ arm = \"cosine\" }, { arm = \"phong\", n = 4 }]", "runs = 3", 50, 8,
        "expected a list of tables, found 3"},
    {"[regions.H]", "[regions.\"H/I\"]", 42, 10, "become file names", 2},
    {"[regions.H]", "[regions.\"../H\"]", 42, 10, "become file names", 2},
    {"", "over = 3\n", 53, 1, "expected a table [assertions.over], found 3"},
    {"", "[[plates.pair.extra]]\n", 53, 15, "unknown key 'extra' in [plates.pair]"},
    {"rho_s = 0.1", "rho_s =", 16, 8, "not TOML"},
    {"", "[assertions.a]\ncheck = \"y_mean(cosine) > 0\"\nname = \"b\"\n", 55, 1,
        "unknown key 'name' in [assertions.a]"},
    {"", "[assertions.a]\ncheck = \"y_mean(cosine, n=4, n=16) > 0\"\n", 54, 9, "expected one n=, found two"},
};

const Mistake values[] = {
    {"width = 64", "width = 0", 4, 9, "from 1 to 16384"},
    {"width = 64", "width = 16385", 4, 9, "from 1 to 16384"},
    {"vfov_deg = 40", "vfov_deg = 180", 10, 12, "above 0 and below 180 (degrees)"},
    {"radius = 0.5", "radius = -0.5", 14, 10, "found -0.5"},
    {"radius = 0.5", "radius = nan", 14, 10, "numbers are finite"},
    {"eye = [0, 1, 5]", "eye = [0, inf, 5]", 7, 11, "numbers are finite"},
    {"rho_s = 0.1", "rho_s = 1.5", 16, 9, "from 0 to 1"},
    {"rho_d = [0.1, 0.2, 0.3]", "rho_d = [0.1, 1.2, 0.3]", 15, 15, "from 0 to 1, found 1.2"},
    {"s = 32\n", "s = 0\n", 17, 5, "above 0"},
    {"seed = 5", "seed = 4294967296", 1, 8, "from 0 to 4294967295"},
    {"seed = 5", "seed = -1", 1, 8, "found -1"},
    {"seed = 5", "seeds = 0", 1, 9, "from 1 to 4096"},
    {"seed = 5", "exposure = 0", 1, 12, "above 0"},
    {"seed = 5", "title = \"a\\nb\"", 1, 9, "one line of text"},
    {"n = 64", "n = 16777217", 47, 5, "from 1 to 16777216"},
    {"n = [4, 16]", "n = [16, 4]", 35, 10, "found 4 after 16"},
    {"n = [4, 16]", "n = [4, 16, 16]", 35, 13, "found 16 again"},
    {"n = [4, 16]", "n = []", 35, 5, "expected ascending integers"},
    {"normal = [0, -1, 0]", "normal = [0, -2, 0]", 31, 10, "expected a unit vector, found length 2"},
    {"normal = [0, -1, 0]", "normal = [0, 0, 0]", 31, 10, "found the zero vector"},
    {"up = [0, 1, 0]", "up = [0, 1, 0.1]", 9, 6, "the unit vector is [0, 0.99503"},
    {"up = [0, 1, 0]", "up = [0, 0, 1]", 9, 6, "not parallel to the view"},
    {"target = [0, 1, 0]", "target = [0, 1, 5]", 8, 10, "other than camera.eye"},
    {"box = [3, 3, 9, 9]", "box = [9, 3, 3, 9]", 43, 7, "an inverted box"},
    {"box = [3, 3, 9, 9]", "box = [3, 4, 9, 3]", 43, 7, "an empty box"},
    {"box = [3, 3, 9, 9]", "box = [3, 3, 64, 9]", 43, 7, "x from 0 to 63 and y from 0 to 31"},
    {"box = [3, 3, 9, 9]", "box = [-1, 3, 9, 9]", 43, 7, "found [-1, 3, 9, 9]"},
    {"box = [3, 3, 9, 9]", "box = [0, 0, 4294967300, 4294967300]", 43, 7,
        "expected pixels from 0 to 16383, found [0, 0, 4294967300"},
    {"box = [3, 3, 9, 9]", "box = [3, 3, 9223372036854775807, 9]", 43, 7, "expected pixels from 0 to 16383"},
    {"box = [3, 3, 9, 9]", "box = [-9223372036854775808, 3, 9, 9]", 43, 7, "expected pixels from 0 to 16383"},
    {"kind = \"columns\"", "kind = \"columns\"\ncrop = [40, 20, 4294967352, 34]", 50, 8,
        "expected pixels from 0 to 16383"},
    {"seed = 5", "seed = 4294967296", 1, 8, "expected an integer from 0 to 4294967295"},
    {"n = [4, 16]", "n = [4, 18446744073709551616]", 35, 29, "not representable in 64 bits"},
    {"kind = \"columns\"", "kind = \"columns\"\ncrop = [0, 0, 99, 9]", 50, 8, "expected a box on the image"},
    {"max = [1, 1, 1]", "max = [1, 0, 1]", 21, 7, "above min on every axis, found y no higher on y"},
    {"edge_v = [0, 1, 0]", "edge_v = [2, 0, 0]", 27, 10, "not parallel to edge_u"},
    {"edge_u = [1, 0, 0]", "edge_u = [0, 0, 0]", 26, 10, "expected an edge with a length"},
    {"[furnaces.white]\narm = \"cosine\"", "[arms.reference]\nsampler = \"cosine\"\n[furnaces.white]\narm = \"cosine\"",
        44, 7, "films/reference.exr is where those of the references go"},
    {"[furnaces.white]\narm = \"cosine\"", "[arms.phong-s8]\nsampler = \"cosine\"\n[furnaces.white]\narm = \"cosine\"",
        44, 7, "where those of phong at s = 8 go"},
};

const Mistake names[] = {
    {"arm = \"phong\"\ns", "arm = \"phnog\"\ns", 39, 7,
        "no arm 'phnog': expected one of cosine, phong; did you mean 'phong'?"},
    {"arm = \"cosine\"\nshape", "arm = \"uniform\"\nshape", 45, 7, "no arm 'uniform'"},
    {"shape = \"ball\"\n[regions", "shape = \"bal\"\n[regions", 41, 9, "did you mean 'ball'?"},
    {"shape = \"ball\"\n[regions", "shape = \"brick\"\n[regions", 41, 9, "with an s of its own"},
    {"box = [3, 3, 9, 9]", "shape = \"bal\"", 43, 9, "no shape 'bal'"},
    {"box = [3, 3, 9, 9]", "mesh = \"ball\"", 43, 8, "'ball' is a shape: expected shape = \"ball\""},
    {"box = [3, 3, 9, 9]", "shape = \"ball\"\nmesh = \"ball\"", 43, 9, "a region has one object"},
    {"[arms.phong]\n", "[arms.phong]\nsampler = \"fong\"\n", 37, 11, "no sampler 'fong'"},
    {"[arms.cosine]\n", "[arms.cosin]\nsampler = \"cosine\"\n", 46, 7, "did you mean 'cosin'?", 3},
    {"phong\", n = 4", "phong\", n = 5", 50, 50, "the arm 'phong' has no sample count n = 5: expected one of 4, 16"},
    {"phong\", n = 4", "phong\", s = 9", 50, 50, "no run phong n=16 s=9"},
    {"phong\", n = 4", "phong\", n = 4, s = 8", 50, 57, "a run of the exponent control: phong n=16 s = 8, 32"},
    {"kind = \"columns\"", "kind = \"hero\"", 50, 1, "expected 1 for a plate of kind hero, found 2"},
    {"[disks.key]", "[disks.ball]", 29, 8, "duplicate name 'ball'"},
    {"s = 32\n[shapes.brick]", "[shapes.brick]", 11, 9, "missing key 's' in [shapes.ball]"},
    {"rho_s = 0.1", "rho_s = 0.1\nbrdf = \"ggx\"", 11, 9, "missing key 'alpha'"},
    {"n = [4, 16]\n[arms.phong]", "n = [4, 17]\n[arms.phong]\nn = []\n[arms.mixture]", 37, 5, "ascending integers"},
};

const Mistake checks[] = {
    {"rmse.H(phong) <", "rms.H(phong) <", 52, 12, "did you mean 'rmse'?"},
    {"rmse.H(phong) <", "rmse.G(phong) <", 52, 12, "no region 'G': expected one of H"},
    {"rmse.H(phong) <", "rmse(phong) <", 52, 12, "expected rmse.REGION(ARM, n=N, s=S)"},
    {"rmse.H(phong) <", "rmse.H(fong) <", 52, 12, "no arm 'fong'"},
    {"rmse.H(phong) <", "rmse.H(phong, n=5) <", 52, 12, "no sample count n = 5"},
    {"rmse.H(phong) <", "rmse.H(phong, n=16, s=9) <", 52, 12, "no run phong n=16 s=9"},
    {"rmse.H(phong) <", "rmse.H(phong, m=16) <", 52, 12, "expected n= or s="},
    {"rmse.H(phong) <", "rmse.H(phong <", 52, 12, "expected ')'"},
    {"rmse.H(phong) <", "rmse.H(phong) =", 52, 12, "expected <, <=, >, >= or =="},
    {"rmse.H(phong) <", "rmse.H(phong) < 3 <", 52, 12, "expected nothing more"},
    {"rmse.H(phong) < rmse.H(cosine)", "1 < 2", 52, 12, "found two numbers"},
    {"rmse.H(phong) < rmse.H(cosine)", "", 52, 12, "expected a quantity or a number at the end"},
    {"< rmse.H(cosine)", "< furnace(black)", 52, 12, "no furnace 'black': expected one of white"},
    {"< rmse.H(cosine)", "< shape_pixels(bal)", 52, 12, "no shape 'bal'"},
    {"< rmse.H(cosine)", "< plate_bytes(par)", 52, 12, "did you mean 'pair'?"},
    {"< rmse.H(cosine)\"", "< tail.H(cosine)\"\nok.over = \"median\"", 52, 12, "tail is not measured at every seed"},
    {"ok.check = \"rmse.H(phong) < rmse.H(cosine)\"", "ok.over = \"median\"", 52, 1,
        "missing key 'check' in [assertions.ok]"},
    {"ok.check = \"rmse.H(phong) < rmse.H(cosine)\"", "ok.check = \"bad(phong) == 0\"\nok.over = \"medium\"", 53, 11,
        "did you mean 'median'?"},
    {"[assertions]\nok.check", "[[assertions]]\ncheck", 51, 1, "missing key 'name' in [[assertions]]"},
    {"[assertions]\nok.check",
        "[[assertions]]\nname = \"a\"\ncheck = \"bad(phong) == 0\"\n[[assertions]]\nname = \"a\"\ncheck", 55, 8,
        "the first is at x.toml:52:8"},
};
INSTANTIATE_TEST_SUITE_P(Combinations, AMistake, testing::ValuesIn(combinations));
INSTANTIATE_TEST_SUITE_P(KeysAndTypes, AMistake, testing::ValuesIn(keys_and_types));
INSTANTIATE_TEST_SUITE_P(Values, AMistake, testing::ValuesIn(values));
INSTANTIATE_TEST_SUITE_P(Names, AMistake, testing::ValuesIn(names));
INSTANTIATE_TEST_SUITE_P(Checks, AMistake, testing::ValuesIn(checks));

/// Returns the message for the good file with other values.
std::string mistake_with(const std::vector<std::string>& overrides) {
    try {
        (void)parse(good, "x.toml", overrides);
    } catch (const InputError& error) { return error.what(); }
    return "";
}

TEST(Mistakes, MagnitudesThatSinglePrecisionLosesAreRefused) {
    EXPECT_THAT(mistake_with({"key.radiance=[0, 1e-30, 0]"}), HasSubstr("disks.key.radiance: expected 0, or"));
    EXPECT_THAT(mistake_with({"fill.radiance=[9e-10, 0, 0]"}), HasSubstr("fill.radiance: expected 0, or"));
    EXPECT_THAT(mistake_with({"brick.rho_d=[1e-20, 0, 0]"}), HasSubstr("shapes.brick.rho_d: expected 0, or"));
    EXPECT_THAT(mistake_with({"ball.rho_s=1e-7"}), HasSubstr("shapes.ball.rho_s: expected 0, or"));
    EXPECT_EQ(mistake_with({"key.radiance=[0, 1e-9, 1e-20]", "brick.rho_d=[0, 0, 0]", "ball.rho_d=[1e-6, 0, 0]"}), "");
    EXPECT_THAT(mistake_with({"ball.brdf=ggx", "ball.alpha=9.9e-5"}), HasSubstr("a number from 0.0001 to 1"));
    EXPECT_EQ(mistake_with({"ball.brdf=ggx", "ball.alpha=1e-4"}), "");
}

TEST(Mistakes, CombinationsOfManySamplersAreRefusedAtOnce) {
    const auto levels = [](int count) {
        std::vector<std::string> overrides = {"arms.m0={kind = \"mixture\", of = [\"cosine\", \"uniform\"]}"};
        for (int k = 1; k <= count; ++k)
            overrides.push_back(fmt::format("arms.m{0}={{kind = \"mixture\", of = [\"m{1}\", \"m{1}\"]}}", k, k - 1));
        return overrides;
    };
    EXPECT_EQ(mistake_with(levels(5)), "");
    EXPECT_THAT(mistake_with(levels(6)), HasSubstr("arms.m6.of: expected at most 64 samplers, found more"));
    EXPECT_THAT(mistake_with(levels(60)), HasSubstr("arms.m60.of: expected at most 64 samplers, found more"));
}

TEST(Mistakes, AnArmThatReachesNoLightIsRefused) {
    for (const char* sampler : {"sky", "light-triangle"})
        EXPECT_THAT(mistake_with({std::string("arms.other.sampler=") + sampler}), HasSubstr("arms.other: the sampler"));
    EXPECT_EQ(mistake_with({"arms.other.sampler=light-area"}), "");
    EXPECT_THAT(mistake_with({"arms.other.sampler=light-area", "key.radiance=[0, 0, 0]", "fill.radiance=[1, 1, 1]"}),
        HasSubstr("arms.other: the sampler 'light-area' reaches only disks and lights"));
    const auto combined = [](const char* of, const char* kind = "mixture") {
        return fmt::format("arms.other={{kind = \"{}\", of = {}}}", kind, of);
    };
    for (const char* kind : {"mixture", "mis"})
        EXPECT_THAT(mistake_with({combined("[\"sky\", \"light-triangle\"]", kind)}),
            HasSubstr("arms.other: the samplers sky, light-triangle reach only triangles that emit and a sky"));
    EXPECT_THAT(mistake_with({"arms.inner={kind = \"mixture\", of = [\"sky\", \"sky\"]}",
                    combined("[\"inner\", \"light-triangle\"]")}),
        HasSubstr("arms.other: the samplers inner, light-triangle reach only"));
    EXPECT_EQ(mistake_with({combined("[\"sky\", \"cosine\"]")}), "");
}

TEST(Mistakes, TheFileWithoutOneIsAccepted) { EXPECT_NO_THROW((void)parse(good, "x.toml")); }

TEST(Mistakes, AllAreReportedAtOnceInFileOrder) {
    std::string text = good;
    text.replace(text.find("box = [3, 3, 9, 9]"), 18, "box = [9, 3, 3, 9]");
    text.replace(text.find("width = 64"), 10, "width = -4");
    text.replace(text.find("normal = [0, -1, 0]"), 19, "norml = [0, -1, 0]");
    try {
        (void)parse(text, "x.toml", {"seed=-1"});
        FAIL();
    } catch (const InputError& error) {
        std::vector<std::string> at;
        for (const Diagnostic& c : error.diagnostics()) at.push_back(to_string(c.location));
        EXPECT_THAT(
            at, testing::ElementsAre("x.toml:4:9", "x.toml:29:8", "x.toml:31:1", "x.toml:43:7", "--set seed=-1"));
    }
}

TEST(Mistakes, TheFirstNameGivenTwiceIsReported) {
    std::string text = good;
    text.replace(text.find("[shapes.board]"), 14, "[shapes.ball]");
    text.replace(text.find("vfov_deg = 40"), 13, "vfov_deg = 40\nvfov_deg = 41");
    try {
        (void)parse(text, "x.toml");
        FAIL();
    } catch (const InputError& error) {
        ASSERT_EQ(error.diagnostics().size(), 1u) << error.what();
        EXPECT_EQ(to_string(error.diagnostics()[0].location), "x.toml:11:12");
    }
}

TEST(Mistakes, MissingFileAndFolderAreInputErrors) {
    EXPECT_THROW((void)load("/nowhere/at/all.toml"), InputError);
    EXPECT_THROW((void)load("/"), InputError);
}

TEST(Mistakes, TooManyDiskLightsAreRejected) {
    std::string text = good;
    for (int k = 0; k < 64; ++k)
        text += fmt::format(
            "\n[disks.more{}]\ncenter = [{}, 3, 0]\nnormal = [0, -1, 0]\nradius = 0.1\nradiance = [1, 1, 1]\n", k, k);
    const std::size_t last = text.rfind("\n[disks.more63]");
    const auto line = 2 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(last), '\n');
    EXPECT_NO_THROW((void)parse(text.substr(0, last), "x.toml"));
    try {
        (void)parse(text, "x.toml");
        FAIL();
    } catch (const InputError& error) {
        EXPECT_EQ(std::string(error.what()),
            fmt::format("x.toml:{}:8: disks and lights: expected at most 64, found 65", line));
    }
}

TEST(Mistakes, JunkIsRefusedAndDoesNotCrash) {
    const auto repeated = [](const std::string& what, int times) {
        std::string all;
        for (int i = 0; i < times; ++i) all += what;
        return all;
    };
    for (const std::string& text : {std::string(), std::string(1, '\0'), repeated("[", 100000),
             "a = " + repeated("[", 100000), repeated("a.", 100000) + "a = 1", "[" + repeated("a.", 100000) + "a]",
             "a = " + repeated("{a=", 1000), repeated("a", 5 << 20), repeated("\xff\xfe", 1000),
             "[shapes]\n" + repeated("x", 100000) + " = 1", repeated("[[plates.a.runs]]\n", 5000)})
        EXPECT_THROW((void)parse(text, "junk"), InputError);
}

}  // namespace mistakes_test
}  // namespace crescent
