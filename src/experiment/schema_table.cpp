// The table itself. Lengths in scene units (m), y up; radiance in W/(sr m^2) as linear Rec.709; angles in degrees.
#include "experiment/schema_table.h"

#include "experiment/input_files.h"
#include "experiment/schema.h"

namespace crescent {

namespace {

constexpr Range free_range{-1e6, 1e6};  // coordinates: float kernels resolve steps below a millimetre in this range
constexpr Range length_range{1e-6, 1e6};
constexpr Range factor_range{-1e6, 1e6};
constexpr Range unit_range{0, 1};  // albedos
constexpr Range alpha_range{least_alpha, 1};
constexpr Range exponent_range{0, 1e6, true};
constexpr Range radiance_range{0, 1e9};       // its square times a weight of a thousand fits a float
constexpr Range count_range{1, 16777216};     // 2^24 samples per pixel
constexpr Range seed_range{0, 4294967295.0};  // 32 bits
constexpr Range pixel_range{0, 16383};
constexpr Range none{};

constexpr Requirement required = Requirement::required, optional = Requirement::optional,
                      defaulted = Requirement::defaulted;

Section image() {
    return {.name = "image",
        .many = Multiplicity::one,
        .need = required,
        .means = "The picture that is computed; pixel (0, 0) is bottom-left, one ray per pixel centre.",
        .family = in<&Experiment::image, Experiment>,
        .keys = {{"width", Type::integer, {1, 16384}, "pixels", required, "", "Columns.", to<&Image::width>},
            {"height", Type::integer, {1, 16384}, "pixels", required, "", "Rows.", to<&Image::height>}},
        .sections = {}};
}

Section camera() {
    return {.name = "camera",
        .many = Multiplicity::one,
        .need = required,
        .means = "A pinhole camera.",
        .family = in<&Experiment::camera, Experiment>,
        .keys = {{"eye", Type::point, free_range, "m", required, "", "Its position.", to<&Camera::eye>},
            {"target", Type::point, free_range, "m", required, "", "The point in the middle of the picture.",
                to<&Camera::target>},
            {"up", Type::direction, none, "", defaulted, "[0, 1, 0]",
                "What is up in the picture; not parallel to the view.", to<&Camera::up>},
            {"vfov_deg", Type::number, {.low = 0, .high = 180, .low_open = true, .high_open = true}, "degrees",
                required, "", "Vertical field of view.", to<&Camera::vfov_deg>}},
        .sections = {}};
}

/// A vector that is stored only where it was given: the default is not written.
template <class Owner, auto Member, auto... Path> constexpr Slot placement_slot = {
    [](void* object, const Value& value) { assign(member_of<Path..., Member>(*static_cast<Owner*>(object)), value); },
    [](const void* object, Value& value) {
        const Vec3d v = member_of<Path..., Member>(*static_cast<const Owner*>(object));
        return (v.x != 0 || v.y != 0 || v.z != 0) && fetch(v, value);
    }};
template <class Owner, auto... Path>
constexpr Slot scale_slot = {[](void* object, const Value& value) {
                                 const std::vector<double>& n = value.numbers;
                                 Vec3d& scale = member_of<Path..., &Placement::scale>(*static_cast<Owner*>(object));
                                 scale = n.size() == 1 ? Vec3d{n[0], n[0], n[0]} : Vec3d{n[0], n[1], n[2]};
                             },
    [](const void* object, Value& value) {
        const Vec3d v = member_of<Path..., &Placement::scale>(*static_cast<const Owner*>(object));
        if (v.x == 1 && v.y == 1 && v.z == 1) return false;
        if (v.x == v.y && v.y == v.z) value.numbers = {v.x};
        else value.numbers = {v.x, v.y, v.z};
        return true;
    }};

/// One number if the lobe has no colour.
template <class Owner> constexpr Slot specular = {[](void* object, const Value& value) {
                                                      const std::vector<double>& n = value.numbers;
                                                      const bool is_grey = n.size() == 1;
                                                      static_cast<Owner*>(object)->material.set_specular(
                                                          is_grey ? Rgb{n[0], n[0], n[0]} : Rgb{n[0], n[1], n[2]});
                                                  },
    [](const void* object, Value& value) {
        const Material& m = static_cast<const Owner*>(object)->material;
        if (m.specular) value.numbers.assign(m.specular->begin(), m.specular->end());
        else value.numbers = {m.rho_s};
        return true;
    }};

/// The keys of a shape's or mesh's material.
template <class Owner> std::vector<Key> material_keys() {
    return {{"rho_d", Type::color, unit_range, "", required, "", "Diffuse albedo: f = rho_d/pi + rho_s lobe.",
                to<&Owner::material, &Material::rho_d>},
        {"rho_s", Type::gray, unit_range, "", defaulted, "0", "Albedo of the lobe; 0: a Lambert surface.",
            specular<Owner>},
        {"s", Type::number, exponent_range, "", optional, "the experiment's s; needed where rho_s > 0",
            "Exponent of the lobe. On a Lambert surface it only steers the arms.", to<&Owner::material, &Material::s>},
        {"brdf", Type::word, none, "", defaulted, "\"phong\"", "Which lobe.", to<&Owner::material, &Material::brdf>,
            lobe_names()},
        {"alpha", Type::number, alpha_range, "", optional, "sqrt(2/(s+2)); required for a lobe of microfacets",
            "Roughness of a lobe of microfacets, not remapped.", to<&Owner::material, &Material::alpha>}};
}

Section shape_tables() {
    std::vector<Key> keys = {kind_key<Shapes, &Shape::form>()}, colors;
    for (Key& key : parameter_keys<Shapes, &Shape::form>())
        (key.type == Type::color ? colors : keys).push_back(std::move(key));
    for (Key& key : material_keys<Shape>()) keys.push_back(std::move(key));
    keys.insert(keys.end(), colors.begin(), colors.end());
    keys.push_back(
        {"occludes", Type::flag, none, "", defaulted, "false", "Whether it hides the lights.", to<&Shape::occludes>});
    return {.name = "shapes",
        .many = Multiplicity::named,
        .need = optional,
        .means = "What the camera sees; needed where there is no mesh.",
        .family = in<&Experiment::shapes, Experiment>,
        .keys = std::move(keys),
        .sections = {}};
}

/// The members that place an object: its own, or those of its placement.
template <class Owner, auto... Path> std::vector<Key> placement_keys() {
    return {{"scale", Type::factors, factor_range, "", optional, "1", "Scaling, along each axis or of all.",
                scale_slot<Owner, Path...>},
        {"rotate", Type::point, {-1e6, 1e6}, "degrees", optional, "[0, 0, 0]",
            "Rotation after the scaling: about the x, then the y, then the z axis, counterclockwise.",
            placement_slot<Owner, &Placement::rotate, Path...>},
        {"translate", Type::point, free_range, "m", optional, "[0, 0, 0]", "Translation after the rotation.",
            placement_slot<Owner, &Placement::translate, Path...>},
        {"matrix", Type::matrix, {-1e6, 1e6}, "", optional, "none",
            "In place of these three: 3 rows of 4 numbers, the last of each the translation (m).",
            to_owner<Owner, Path..., &Placement::matrix>}};
}

Section mesh_tables() {
    std::vector<Key> keys = {{"file", Type::text, none, "", required, "",
        "A .mesh file next to this file or in a folder there; `crescent import` makes one of a model.",
        to<&MeshObject::file>}};
    for (Key& key : placement_keys<MeshObject, &MeshObject::placement>()) keys.push_back(std::move(key));
    for (Key& key : material_keys<MeshObject>()) keys.push_back(std::move(key));
    keys.push_back({texture_keys[0].name, Type::text, none, "", optional, "none",
        "An OpenEXR image, or a packed one (.image), next to this file or in a folder there, whose texels multiply "
        "rho_d.",
        to<texture_keys[0].texture, &Texture::file>});
    keys.push_back({texture_keys[1].name, Type::text, none, "", optional, "none", "The same for alpha: a grey image.",
        to<texture_keys[1].texture, &Texture::file>});
    keys.push_back({"emission", Type::color, radiance_range, "W/(sr m^2)", defaulted, "[0, 0, 0]",
        "Radiance of its front sides: its triangles are area lights.", to<&MeshObject::emission>});
    keys.push_back({"two_sided", Type::flag, none, "", defaulted, "false", "Emits from the back too.",
        to<&MeshObject::two_sided>});
    keys.push_back({"content", Type::text, none, "", optional, "not checked",
        "Hash of the mesh and its textures, 16 hexadecimal digits; others are refused.", to<&MeshObject::content>});
    const Section instances = {.name = "instances",
        .many = Multiplicity::list,
        .need = optional,
        .means =
            "Where copies of the mesh are, each placed after the mesh's own placement; none: the mesh is there once.",
        .family = in<&MeshObject::instances>,
        .keys = placement_keys<Placement>(),
        .sections = {}};
    return {.name = "meshes",
        .many = Multiplicity::named,
        .need = optional,
        .means = "Triangle meshes from files. They hide all lights, and each other.",
        .family = in<&Experiment::meshes, Experiment>,
        .keys = std::move(keys),
        .sections = {instances}};
}

Section disks() {
    return {.name = "disks",
        .many = Multiplicity::named,
        .need = optional,
        .means = "Disks that shine; sampled rays meet them, the camera does not see them.",
        .family = in<&Experiment::disks, Experiment>,
        .keys = {{"center", Type::point, free_range, "m", required, "", "Centre.", to<&DiskLight::center>},
            {"normal", Type::direction, none, "", required, "", "The side that shines.", to<&DiskLight::normal>},
            {"radius", Type::number, length_range, "m", required, "", "Radius.", to<&DiskLight::radius>},
            {"radiance", Type::color, radiance_range, "W/(sr m^2)", required, "", "Radiance.",
                to<&DiskLight::radiance>},
            {"two_sided", Type::flag, none, "", defaulted, "false", "Emits from both sides.",
                to<&DiskLight::two_sided>}},
        .sections = {}};
}

Section light_tables() {
    std::vector<Key> keys = {kind_key<LightKinds, &Light::form>()};
    for (Key& key : parameter_keys<LightKinds, &Light::form>()) keys.push_back(std::move(key));
    keys.push_back(
        {"radiance", Type::color, radiance_range, "W/(sr m^2)", required, "", "Radiance.", to<&Light::radiance>});
    return {.name = "lights",
        .many = Multiplicity::named,
        .need = optional,
        .means =
            "Lights of any kind; [disks.NAME] is another way to write a disk. They come after the disks of such "
            "tables.",
        .family = in<&Experiment::lights, Experiment>,
        .keys = std::move(keys),
        .sections = {}};
}

Section fill() {
    return {.name = "fill",
        .many = Multiplicity::one,
        .need = optional,
        .means = "Light from every direction in which no other light is met.",
        .family = {},
        .keys = {{"radiance", Type::color, radiance_range, "W/(sr m^2)", defaulted, "[0, 0, 0]", "Radiance.",
            to_owner<Experiment, &Experiment::fill>}},
        .sections = {}};
}

Section sky() {
    return {.name = "sky",
        .many = Multiplicity::one,
        .need = optional,
        .means = "An image sky: light from infinitely far away where nothing hides it, see docs/conventions.md.",
        .family = in<&Experiment::sky, Experiment>,
        .keys = {{"file", Type::text, none, "", required, "",
                     "A latitude-longitude image, OpenEXR, Radiance HDR or packed (.image), relative to this file; "
                     "twice as "
                     "wide "
                     "as high, at most 8192 x 4096.",
                     to<&SkyLight::file>},
            {"layer", Type::text, none, "", optional, "the first part of the file",
                "The layer of an OpenEXR file with several, as `compare --layer` names it: R, G and B, or Y.",
                to<&SkyLight::layer>},
            {"rotation", Type::number, {-360, 360}, "degrees", defaulted, "0",
                "About the y axis, counterclockwise seen from above.", to<&SkyLight::rotation>},
            {"scale", Type::number, {0, 1e9, true}, "", defaulted, "1", "Factor of the image's radiance.",
                to<&SkyLight::scale>},
            {"visible", Type::flag, none, "", defaulted, "true",
                "Whether the camera sees it where no surface is; such pixels have no geometry.",
                to<&SkyLight::visible>},
            {"content", Type::text, none, "", optional, "not checked",
                "Hash of the image, 16 hexadecimal digits; another image is refused.", to<&SkyLight::content>}},
        .sections = {}};
}

/// The words of an enumeration, in its order; `last` is its last value. A value is read as the index of its word.
template <auto last, std::size_t n> std::vector<std::string> words_to(const char* const (&words)[n]) {
    static_assert(n == static_cast<std::size_t>(last) + 1, "an enumeration has one word for each value");
    return {words, words + n};
}

Section arms() {
    return {.name = "arms",
        .many = Multiplicity::named,
        .need = required,
        .means = "The samplers to compare. All use the same random numbers; sample counts are prefixes of one stream.",
        .family = in<&Experiment::arms>,
        .keys = {{"exec", Type::text, none, "", optional, "none",
                     "In place of a sampler: a command that starts a program which draws, see docs/plugins.md.",
                     to<&ArmPlan::exec>},
            {"plugin", Type::text, none, "", optional, "none",
                "Instead of a sampler: a shared library that draws, next to this file; see docs/plugins.md.",
                to<&ArmPlan::plugin>},
            {"python", Type::text, none, "", optional, "none",
                "In place of a sampler: one in Python, FILE.py:NAME beside this file; see docs/plugins.md.",
                to<&ArmPlan::python>},
            {"kind", Type::word, none, "", optional, "none",
                "In place of a sampler: a combination of samplers, see docs/samplers.md.",
                to<&ArmPlan::combination, &CombinationPlan::kind>,
                words_to<CombinationKind::ris>({"mis", "mixture", "ris"})},
            {"of", Type::texts, none, "", required, "", "What is combined: arms, or built-in samplers.",
                to<&ArmPlan::combination, &CombinationPlan::of>, {}, "mis mixture ris"},
            {"heuristic", Type::word, none, "", optional, "\"balance\"", "Weights of the directions.",
                to<&ArmPlan::combination, &CombinationPlan::heuristic>,
                words_to<MisHeuristic::power>({"balance", "power"}), "mis"},
            {"draw", Type::word, none, "", optional, "\"every\"",
                "A sample has directions of every sampler, or of one that is chosen.",
                to<&ArmPlan::combination, &CombinationPlan::draw>, words_to<MisDraw::one>({"every", "one"}), "mis"},
            {"weights", Type::formulas, none, "", optional, "equal; of mis: the heuristic",
                "One of each in 'of', numbers or formulas; their sum is one.",
                to<&ArmPlan::combination, &CombinationPlan::weights>, {}, "mis mixture"},
            {"weights_python", Type::text, none, "", optional, "none",
                "A function of Python for the weights, \"FILE.py:NAME\", relative to this file; for runs in Python.",
                to<&ArmPlan::combination, &CombinationPlan::weights_python>, {}, "mis"},
            {"probabilities", Type::formulas, none, "", optional, "equal",
                "With which draw = \"one\" chooses each; their sum is one.",
                to<&ArmPlan::combination, &CombinationPlan::probabilities>, {}, "mis"},
            {"samples", Type::counts, {1, 1024}, "directions", optional, "one of each",
                "Directions of each in a sample of draw = \"every\".",
                to<&ArmPlan::combination, &CombinationPlan::samples>, {}, "mis"},
            {"candidates", Type::integer, {1, 4096}, "directions", required, "",
                "Candidates of a sample, of each in 'of' in turn.",
                to<&ArmPlan::combination, &CombinationPlan::candidates>, {}, "ris"},
            {"target", Type::text, none, "", optional, "\"product\"",
                "What a candidate is chosen by: \"product\" f L cos without shadows, \"brdf\" f cos, or an arm or "
                "sampler whose density is the target.",
                to<&ArmPlan::combination, &CombinationPlan::target>, {}, "ris"},
            {"sampler", Type::sampler, none, "", defaulted, "the arm's own name",
                "Which sampler it is; \"renderer\": material with those of the scene's lights, by the balance "
                "heuristic.",
                to<&ArmPlan::sampler>},
            {"n", Type::integers, count_range, "samples/pixel", optional, "the experiment's n",
                "The ladder, ascending; one integer is a ladder of one.", to<&ArmPlan::n>}},
        .sections = {}};
}

Section exponent() {
    return {.name = "exponent",
        .many = Multiplicity::one,
        .need = optional,
        .means = "The exponent control: one arm again at other s, in pdf, BRDF and reference alike.",
        .family = in<&Experiment::exponent>,
        .keys = {{"arm", Type::arm, none, "", required, "", "The arm.", to<&ExponentControl::arm>},
            {"n", Type::integer, count_range, "samples/pixel", optional, "the experiment's n",
                "A sample count of that arm.", to<&ExponentControl::n>},
            {"s", Type::numbers, exponent_range, "", required, "", "The exponents, ascending.",
                to<&ExponentControl::s>},
            {"shape", Type::shape, none, "", required, "", "The shape whose s is the experiment's s.",
                to<&ExponentControl::shape>}},
        .sections = {}};
}

/// A box that is stored only where it was given: the default depends on the image.
constexpr Slot region_box = {[](void* object, const Value& value) {
                                 Region& region = *static_cast<Region*>(object);
                                 assign(region.box, value);
                                 region.has_box = true;
                             },
    [](const void* object, Value& value) {
        const Region& region = *static_cast<const Region*>(object);
        return region.has_box && fetch(region.box, value);
    }};

/// The name of an object, which none has by default.
template <std::string Region::* member> constexpr Slot region_object = {
    [](void* object, const Value& value) { assign(static_cast<Region*>(object)->*member, value); },
    [](const void* object, Value& value) {
        const std::string& name = static_cast<const Region*>(object)->*member;
        return !name.empty() && fetch(name, value);
    }};

Section regions() {
    return {.name = "regions",
        .many = Multiplicity::named,
        .need = optional,
        .means = "Where errors are measured: in the pixels of a box, of an object, or of an object within a box.",
        .family = in<&Experiment::regions>,
        .keys = {{"box", Type::box, pixel_range, "pixels", optional, "the whole image",
                     "[x0, y0, x1, y1], both ends inside, origin bottom-left.", region_box},
            {"mesh", Type::shape, none, "", optional, "all objects", "Only pixels in which the camera sees this mesh.",
                region_object<&Region::mesh>},
            {"shape", Type::shape, none, "", optional, "all objects",
                "Only pixels in which the camera sees this shape.", region_object<&Region::shape>}},
        .sections = {}};
}

Section reference() {
    return {.name = "reference",
        .many = Multiplicity::one,
        .need = optional,
        .means = "What the metrics compare with.",
        .family = in<&Experiment::reference>,
        .keys = {{"kind", Type::word, none, "", defaulted, "\"quadrature\"",
                     "Converged integration, the article's Monte Carlo, or two independent estimates, the default for "
                     "a scene "
                     "with a sky or meshes.",
                     to<&ReferencePlan::kind>, words_to<ReferenceKind::paired>({"quadrature", "note", "paired"})},
            {"n", Type::integer, count_range, "samples/pixel", optional, "256",
                "Of each of the two estimates of paired.", to<&ReferencePlan::n>},
            {"monte_carlo", Type::flag, none, "", defaulted, "false",
                "Whether the article's is computed in addition to the quadrature.", to<&ReferencePlan::monte_carlo>},
            {"seed", Type::integer, seed_range, "", defaulted, "1", "Of the Monte Carlo reference.",
                to<&ReferencePlan::seed>},
            {"lobe_spp", Type::integer, count_range, "samples/pixel", defaulted, "32",
                "Samples of the lobe for lobe x fill.", to<&ReferencePlan::lobe_spp>},
            {"disk_spp", Type::integer, count_range, "samples/pixel", defaulted, "96", "Samples on each light.",
                to<&ReferencePlan::disk_spp>}},
        .sections = {}};
}

Section furnaces() {
    return {.name = "furnaces",
        .many = Multiplicity::named,
        .need = optional,
        .means = "White furnaces: L_i = 1 all around, R = n. Expected: rho_d + rho_s, or rho_s of the lobe alone.",
        .family = in<&Experiment::furnaces>,
        .keys = {{"arm", Type::arm, none, "", required, "", "The arm.", to<&FurnacePlan::arm>},
            {"part", Type::word, none, "", defaulted, "\"combined\"", "The whole BRDF or its lobe.",
                to<&FurnacePlan::part>, words_to<FurnacePart::lobe>({"combined", "lobe"})},
            {"shape", Type::shape, none, "", required, "", "Whose material.", to<&FurnacePlan::shape>},
            {"n", Type::integer, count_range, "samples", required, "", "Samples.", to<&FurnacePlan::n>}},
        .sections = {}};
}

Section plates() {
    const Section runs = {.name = "runs",
        .many = Multiplicity::list,
        .need = optional,
        .means = "What the plate shows, from left to right.",
        .family = in<&PlatePlan::runs>,
        .keys = {{"arm", Type::arm, none, "", required, "", "The arm.", to<&PlateRun::arm>},
            {"n", Type::integer, count_range, "samples/pixel", optional,
                "the experiment's n; hero: the highest count; ladder: every count", "A sample count of that arm.",
                to<&PlateRun::n>},
            {"s", Type::number, exponent_range, "", optional, "the experiment's s; exponent: every s of the control",
                "An exponent of the exponent control.", to<&PlateRun::s>}},
        .sections = {}};
    return {.name = "plates",
        .many = Multiplicity::named,
        .need = optional,
        .means = "The pictures; a plate's name is its file's name.",
        .family = in<&Experiment::plates>,
        .keys = {{"kind", Type::word, none, "", required, "", "Which picture.", to<&PlatePlan::kind>,
                     [] {
                         std::vector<std::string> words;
                         for (const PlateInfo& plate : plate_infos) words.emplace_back(plate.name);
                         return words;
                     }()},
            {"crop", Type::box, pixel_range, "pixels", optional, "the first region; surround: the last",
                "The part that is enlarged.", to<&PlatePlan::crop>},
            {"caption", Type::text, none, "", defaulted, "\"\"", "The caption under the picture.",
                to<&PlatePlan::caption>}},
        .sections = {runs}};
}

/// The text until it is parsed. Another text is another assertion.
constexpr Slot comparison = {[](void* object, const Value& value) {
                                 auto& plan = *static_cast<AssertionPlan*>(object);
                                 plan.text = value.text;
                                 plan.check = {};
                             },
    [](const void* object, Value& value) {
        const auto& plan = *static_cast<const AssertionPlan*>(object);
        value.text = plan.check.op.empty() ? plan.text : to_string(plan.check);
        return true;
    }};

Section assertions() {
    return {.name = "assertions",
        .many = Multiplicity::titled,
        .need = optional,
        .means = "What must hold; also written [[assertions]] with a key 'name'.",
        .family = in<&Experiment::assertions>,
        .keys = {{"check", Type::check, none, "", required, "",
                     "A comparison, e.g. \"rmse.H(phong) < rmse.H(cosine)\".", comparison},
            {"over", Type::word, none, "", defaulted, "\"seed\"",
                "At the experiment's seed, or medians over all seeds.", to<&AssertionPlan::median>,
                {"seed", "median"}}},
        .sections = {}};
}

}  // namespace

const Section& schema() {
    static const Section root = {.name = "",
        .many = Multiplicity::one,
        .need = required,
        .means = "The experiment.",
        .family = {},
        .keys = {{"title", Type::text, none, "", defaulted, "\"untitled\"", "One line.", to<&Experiment::title>},
            {"seed", Type::integer, seed_range, "", defaulted, "1", "The first seed, shared by all arms.",
                to<&Experiment::seed>},
            {"seeds", Type::integer, {1, 4096}, "", defaulted, "1",
                "How many seeds the bands are made of; the first is `seed`.", to<&Experiment::seeds>},
            {"n", Type::integer, count_range, "samples/pixel", optional, "an arm's highest sample count",
                "Samples per pixel if an arm, a plate, a check or the exponent control gives no n.",
                to<&Experiment::n>},
            {"exposure", Type::number, {0, 1e6, true}, "", defaulted, "1",
                "Radiance is multiplied by it before the tone map.", to<&Experiment::exposure>},
            {"theme", Type::word, none, "", optional, "\"dark\"", "Ground and inks of plates.", to<&Experiment::theme>,
                {"dark", "light"}},
            {"firefly_k", Type::number, {0, 1e6, true}, "", defaulted, "4",
                "A firefly is a pixel with |Y - Y_ref| > firefly_k Y_ref.", to<&Experiment::firefly_k>},
            {"flip_seeds", Type::integer, {1, 4096}, "", optional, "1",
                "How many seeds FLIP is measured of, from the first; it takes longer than all other metrics.",
                to<&Experiment::flip_seeds>},
            {"note_evidence", Type::flag, none, "", defaulted, "false",
                "Whether the article's explanations of the Phong arm are measured.", to<&Experiment::note_evidence>},
            {"published", Type::text, none, "", optional, "none", "A JSON of published figures, relative to this file.",
                to<&Experiment::published>}},
        .sections = {image(), camera(), shape_tables(), mesh_tables(), disks(), light_tables(), sky(), fill(), arms(),
            exponent(), regions(), reference(), furnaces(), plates(), assertions()}};
    return root;
}

}  // namespace crescent
