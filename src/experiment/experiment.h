// An experiment as it is written: every number of a run, in the units of its key. Lengths in scene units (m), radiance
// in W/(sr m^2), angles in degrees, albedos in [0, 1]; y is up; the camera space is right-handed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/errors.h"
#include "base/vec.h"
#include "experiment/assertion.h"
#include "experiment/published.h"
#include "output/tone_map.h"
#include "samplers/combination_plan.h"
#include "samplers/sampler_adapter.h"
#include "scene/scene_data.h"

namespace crescent {

/// Reads a whole text file of at most 4 MiB; `what` names it in the InputError if it cannot be read.
std::string read_text(const std::string& path, std::string_view what);

}  // namespace crescent

// ---- The list of plates (figures) that an experiment can request. To add one, add a file in plates/ with its painter,
// draw_PAINTER(Sheet&), and a line here; the list determines the keys of experiments and their schema, `crescent list
// plates`, the painters, the report and the tests.
//
// plate(name, painter, fewest runs, most runs, look, what it shows)

// clang-format off: one a line
#define CRESCENT_PLATES(plate) \
    plate(hero, still, 1, 1, photograph, "one run, at 1:1 if it fits") \
    plate(gallery, still, 0, 1, photograph, "the converged reference") \
    plate(columns, strip, 1, 4, photograph, "runs side by side, each with a part enlarged") \
    plate(ladder, strip, 1, 64, photograph, "the sample counts of arms side by side, each with a part enlarged") \
    plate(exponent, strip, 1, 4, photograph, "the runs of the exponent control, each with a part enlarged") \
    plate(surround, strip, 1, 4, photograph, "a part of runs enlarged, side by side") \
    plate(reference, reference, 0, 1, backend, "the reference with the regions, and their means") \
    plate(heat, heat, 1, 4, backend, "where runs differ from the reference, on one scale") \
    plate(rose, rose, 1, 4, backend, "densities in the plane of the normal and R, and over the hemisphere") \
    plate(meters, meters, 0, 64, drawing, "the table of what was measured, and RMSE against N")
// clang-format on

namespace crescent {

#define CRESCENT_NAME(name, ...) name,
/// One of the plates, by its name in an experiment.
enum class PlateKind { CRESCENT_PLATES(CRESCENT_NAME) };
#undef CRESCENT_NAME

/// A photograph is tone mapped and has no numbers on it; `backend` plates show the float films; a drawing consists only
/// of lines and text and is written as SVG too.
enum class PlateLook { photograph, backend, drawing };

/// The data of a plate in the lists of plates.
struct PlateInfo {
    std::string_view name;
    std::size_t least, most;  // runs that it shows
    PlateLook look;
    std::string_view shows;
};

/// By PlateKind.
#define CRESCENT_INFO(name, painter, least, most, look, shows) PlateInfo{#name, least, most, PlateLook::look, shows},
inline constexpr std::array plate_infos = {CRESCENT_PLATES(CRESCENT_INFO)};
#undef CRESCENT_INFO
constexpr const PlateInfo& plate_info(PlateKind kind) { return plate_infos[static_cast<std::size_t>(kind)]; }

/// One sampler with its sample counts, which are prefixes of one stream.
struct ArmPlan {
    std::string name;              // as it appears in films and tables
    std::string sampler;           // a word of samplers/all.h; "": what exec, plugin or python names
    std::vector<std::uint64_t> n;  // ascending samples per pixel
    SourceLocation location;
    // A command, the file of a shared library, a sampler in Python as "FILE.py:NAME" or "module:NAME".
    std::optional<std::string> exec = {}, plugin = {}, python = {};
    CombinationPlan combination = {};  // of other arms and samplers
    bool is_external() const { return exec || plugin || python; }
    bool is_combination() const { return combination.kind.has_value(); }
};

/// The exponent control: `arm` repeated at each s, which changes the pdf, the BRDF and the reference.
struct ExponentControl {
    std::string arm;
    std::uint64_t n = 0;
    std::vector<double> s;
    std::string shape;  // whose s is used: SceneData::s_of
    SourceLocation location;
};

/// Named pixels in which errors are measured.
struct Region {
    std::string name;
    Box box;  // the whole image if the file gives none
    SourceLocation location;
    bool has_box = true;      // whether the file gives it
    std::string mesh, shape;  // whose pixels they are; "": those of any
    int surface = any_surface;

    /// Returns the pixels that are measured.
    Area area() const { return {box, surface}; }
    /// Returns the name of the object whose pixels they are; "": all pixels of the box.
    const std::string& object() const { return mesh.empty() ? shape : mesh; }
};

/// The deterministic quadrature, the article's Monte Carlo estimate, or two independent estimates.
enum class ReferenceKind { quadrature, note, paired };

/// The reference of the metrics. The quadrature is always computed, except if the kind is `paired`.
struct ReferencePlan {
    ReferenceKind kind = ReferenceKind::quadrature;  // the one that the metrics use
    std::uint64_t n = 0;          // samples per pixel of each estimate of `paired`; 0: paired_samples
    bool monte_carlo = false;     // whether the article's is computed too if the metrics do not use it
    std::uint32_t seed = 0;       // of the references that are sampled
    std::uint64_t lobe_spp = 32;  // Phong-sampled lobe x fill
    std::uint64_t disk_spp = 96;  // samples on each light
};

inline constexpr std::uint64_t paired_samples = 256;

/// The whole BRDF, or its lobe without the Lambert part.
enum class FurnacePart { combined, lobe };

/// White furnace: L_i = 1, R = n. Expected: rho_d + rho_s; for the lobe alone, rho_s (as Y).
struct FurnacePlan {
    std::string name;
    std::string arm;
    FurnacePart part = FurnacePart::combined;
    std::string shape;  // whose material is used
    std::uint64_t n = 0;
    SourceLocation location;
};

/// One figure. `runs` names what it shows; crops are boxes in image pixels, or the whole frame.
struct PlateRun {
    std::string arm;
    std::uint64_t n = 0;
    double s = 0;  // 0: the experiment's own
};
struct PlatePlan {
    std::string name;  // file name without .png
    PlateKind kind = PlateKind::hero;
    std::vector<PlateRun> runs;
    std::optional<Box> crop;
    std::string caption;  // shown alone under the picture
    SourceLocation location;
};

/// A comparison that must hold. Quantities are looked up by name (see metrics/assertions.h).
struct AssertionPlan {
    std::string name;
    std::string text;     // as in the file, e.g. "rmse.H(phong) < rmse.H(cosine)"
    Comparison check;     // the same, parsed; every n is filled in
    bool median = false;  // over seeds, else at the published seed
    SourceLocation location;
};

/// A scene, and the computations requested for it.
struct Experiment : SceneData {
    std::string file;  // as given
    std::string title;
    std::vector<std::string> overrides;  // PATH=VALUE, as given
    std::uint32_t seed = 0;
    std::uint64_t n = 0;  // default samples per pixel; 0: none given
    int seeds = 1;        // number of seeds of the bands; the first is `seed`
    double exposure = 1;
    std::optional<Theme> theme;  // of plates; none: dark
    double firefly_k = 4;
    int flip_seeds = 0;          // how many seeds FLIP is measured of, from the first; 0: one
    bool note_evidence = false;  // whether the article's explanations are tested by measurements
    std::vector<ArmPlan> arms;
    std::optional<ExponentControl> exponent;
    std::vector<Region> regions;
    ReferencePlan reference;
    std::vector<FurnacePlan> furnaces;
    std::vector<PlatePlan> plates;
    std::vector<AssertionPlan> assertions;
    std::optional<std::string> published;          // path of a JSON of published figures, resolved against `file`
    std::optional<Published> figures;              // its content, once read: by load(), else by run(), like meshes
    std::map<std::string, SourceLocation> places;  // "camera.eye" -> place in the file

    /// Returns this experiment with another s: for the shape that s() is read from and all that inherit it.
    Experiment with_s(double s) const;
    /// Returns the default n of an arm: the experiment's own if `arm` has that sample count, else the arm's highest.
    std::uint64_t n_of(const ArmPlan& arm) const;
    /// Returns "shapes.NAME" or "meshes.NAME".
    std::string surface_path(std::size_t surface) const;
    const ArmPlan* find_arm(std::string_view name) const;
    const Region* find_region(std::string_view name) const;
    /// Returns where a key was written; for a missing key, the place of its table.
    SourceLocation place_of(const std::string& path) const;
};

/// Reads and checks a whole file; throws one InputError with every mistake in it. `overrides` are "path=value" as given
/// to --set.
Experiment load(const std::string& path, const std::vector<std::string>& overrides = {});
/// The same from text; `name` is the file's name in messages.
Experiment parse(std::string_view text, const std::string& name, const std::vector<std::string>& overrides = {});

/// Returns the experiment with its files read: published values, meshes and its sky, where it names some and has none
/// yet. Throws InputError.
Experiment with_files(Experiment experiment);

/// Returns the keys with types, units, ranges and defaults, made from the table that parses them.
std::string schema_text();

// ---- Values derived from an experiment: names of its films, warnings, properties of its samplers, tables of its
// lights.

// ---- The names of film files.

/// Returns the file for the films of an arm at exponent s under films/, without .exr: the arm's name, followed by s if
/// it is not the experiment's own. The references have a file in the same folder.
std::string film_file(std::string_view arm, double s, double own_s);
inline constexpr std::string_view reference_file = "reference";

// ---- Warnings: valid but probably unintended values, shown in the summary and in the report.

/// Returns one line each for surfaces whose rho_d + rho_s is above 1 in a channel, so that they reflect more than they
/// receive, and for a `note_evidence` without anything to measure.
std::vector<std::string> warnings_of(const Experiment& experiment);

// ---- The shape and arm that `note_evidence` is measured on, or why there is none.

/// Returns the exponent control's shape, else the first with a Phong lobe; null if it has no Phong lobe or there is
/// none.
const Shape* evidence_shape(const Experiment& experiment);
/// Returns "no arm has the sampler 'phong'", ...; "" if note_evidence has an arm and a surface to measure.
std::string why_no_evidence(const Experiment& experiment);

// ---- Properties of the arms of an experiment in its scene, from SamplerInfo (samplers/info.h): for plates and
// reports.

/// Returns the directions that an arm draws per sample: 2 if it combines two techniques and N counts pairs.
int techniques_of(const ArmPlan& arm);

/// Returns what draws for an arm that is no built-in sampler: "the plugin libx.so", "the balance heuristic of sky and
/// cosine"; "" for a built-in sampler.
std::string source_of(const ArmPlan& arm);

/// Returns the light of this scene that an arm cannot reach ("the fill"), so that it is biased here and its error stops
/// falling with N; "" if it reaches all.
std::string missed_light(const ArmPlan& arm, const Experiment& experiment);

/// Returns whether the exponent identifies an arm's run at s: the arm's pdf depends on it, or it is not the
/// experiment's own.
bool tells_s(const std::string& arm, double s, const Experiment& experiment);
/// Returns whether that holds for any arm at the experiment's own s.
bool any_tells_s(const Experiment& experiment);

// ---- The lights of an experiment, from both of its tables, and their paths for --set.

/// A light of [disks.NAME] or of [lights.NAME], and the path of that table for --set: "disks.key".
struct LightTable {
    std::string path;
    Light light;
};
/// Returns all lights of a scene except the fill, in its order: disks first.
std::vector<LightTable> all_lights(const SceneData& scene);

}  // namespace crescent
