// Shared by all plates: the sheet with its header, caption and footer, and the film of a run.
#pragma once

#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "experiment/experiment.h"
#include "render/film.h"
#include "report/plates/canvas.h"
#include "report/plates/plates.h"
#include "report/plates/raster.h"

namespace crescent::plates {

// ---- One palette, one type scale and one grid for all plates, in pixels of the 1280x720 sheet.

inline constexpr double radians_per_degree = std::numbers::pi / 180;
inline constexpr int sheet_width = 1280, sheet_height = 720;

// A neutral dark ground, so that photographs keep their tones; text at 17:1 and 8:1 contrast.
inline constexpr Srgb8 ground_bytes{20, 21, 23};
inline constexpr Colour ground{ground_bytes[0] / 255.0, ground_bytes[1] / 255.0, ground_bytes[2] / 255.0};
inline constexpr Colour panel{0.118, 0.125, 0.137};
inline constexpr Colour rule{0.235, 0.247, 0.267};
inline constexpr Colour bright{0.953, 0.953, 0.941};
inline constexpr Colour muted{0.682, 0.702, 0.729};
inline constexpr Colour photograph_accent{0.957, 0.733, 0.373};
inline constexpr Colour backend_accent{0.431, 0.792, 0.867};
inline constexpr Colour alert{1.0, 0.43, 1.0};
/// For arms in the order of the experiment, distinguished by lightness as well as by hue; the first, the baseline, is
/// grey.
inline constexpr Colour series[] = {{0.80, 0.80, 0.80}, {0.431, 0.792, 0.867}, {0.957, 0.733, 0.373},
    {0.929, 0.502, 0.494}, {0.616, 0.827, 0.506}, {0.769, 0.651, 0.925}};
inline constexpr std::size_t series_count = sizeof series / sizeof series[0];
/// For regions, in the order of the experiment.
constexpr Colour region_colour(std::size_t i) { return series[1 + i % (series_count - 1)]; }

/// The same colours on a light ground, text on it at 15:1 and 6:1, lines and names of arms at 4.5:1 or more.
struct Themed {
    Colour dark, light;
};
inline constexpr Themed light_theme[] = {{ground, {0.988, 0.988, 0.984}}, {panel, {0.941, 0.945, 0.949}},
    {rule, {0.804, 0.816, 0.831}}, {bright, {0.098, 0.106, 0.118}}, {muted, {0.345, 0.369, 0.400}},
    {photograph_accent, {0.604, 0.357, 0.000}}, {backend_accent, {0.000, 0.408, 0.498}}, {alert, {0.741, 0.000, 0.741}},
    {series[0], {0.392, 0.392, 0.392}}, {series[3], {0.710, 0.161, 0.176}}, {series[4], {0.184, 0.455, 0.118}},
    {series[5], {0.439, 0.290, 0.690}}};
/// Returns a colour of this file as a theme shows it, with its opacity; other colours are unchanged.
constexpr Colour themed(const Colour& c, Theme theme) {
    if (theme == Theme::light)
        for (const Themed& t : light_theme)
            if (t.dark.r == c.r && t.dark.g == c.g && t.dark.b == c.b) return {t.light.r, t.light.g, t.light.b, c.a};
    return c;
}
/// The ground as a pixel of a block.
inline Srgb8 ground_pixel(Theme theme) {
    if (theme == Theme::dark) return ground_bytes;
    const auto byte = [](double v) { return static_cast<unsigned char>(255 * v + 0.5); };
    const Colour c = themed(ground, theme);
    return {byte(c.r), byte(c.g), byte(c.b)};
}

// Margins, and the bands of the sheet from top to bottom.
inline constexpr double margin = 32, gap = 20;
inline constexpr double sheet_inner = sheet_width - 2 * margin;
inline constexpr Rect header_band{margin, 20, sheet_inner, 32};
inline constexpr Rect content_band{margin, 64, sheet_inner, 540};
inline constexpr Rect caption_band{margin, 616, sheet_inner, 51};
inline constexpr Rect footer_band{margin, 680, sheet_inner, 20};

inline constexpr Text label_text{.px = 20,
    .ink = bright,
    .weight = Weight::medium,
    .align = Align::left,
    .vertical = Vertical::middle,
    .lines = 1,
    .least_px = 15};
inline constexpr Text title_text{.px = 24,
    .ink = bright,
    .weight = Weight::semibold,
    .align = Align::left,
    .vertical = Vertical::top,
    .lines = 1,
    .least_px = 15};
inline constexpr Text body_text{.px = 18,
    .ink = bright,
    .weight = Weight::regular,
    .align = Align::left,
    .vertical = Vertical::top,
    .lines = 1,
    .least_px = 14};
inline constexpr Text small_text{.px = 15,
    .ink = muted,
    .weight = Weight::regular,
    .align = Align::left,
    .vertical = Vertical::top,
    .lines = 1,
    .least_px = 12};

/// A text style with one thing changed.
constexpr Text with(Text t, Align a) { return t.align = a, t; }
constexpr Text with(Text t, Vertical v) { return t.vertical = v, t; }
constexpr Text with(Text t, const Colour& c) { return t.ink = c, t; }
constexpr Text with(Text t, Weight w) { return t.weight = w, t; }
constexpr Text with_lines(Text t, int lines) { return t.lines = lines, t; }
constexpr Text with_px(Text t, double px) { return t.px = px, t; }

/// Returns column i of the band, cut into `n` equal columns.
inline Rect column(const Rect& band, std::size_t n, std::size_t i) {
    double w = (band.w - gap * double(n - 1)) / double(n);
    return {band.x + double(i) * (w + gap), band.y, w, band.h};
}

// ---- The words and numbers on plates, all read from the experiment: arm names, densities, labels; all returned text
// is Pango markup.

/// Returns a run of the plan with the experiment's own s and seed filled in.
RunKey key_of(const PlateRun& run, const Experiment& e);
std::vector<RunKey> keys_of(const PlatePlan& plan, const Experiment& e);

/// Returns the label of a built-in sampler ("light-area (NEE)"); an arm with another name keeps it.
std::string arm_name(const std::string& arm, const Experiment& e);
/// Returns the name of samplers/all.h that the arm uses, "" if the experiment has no such arm.
std::string sampler_of(const std::string& arm, const Experiment& e);
/// Returns "n" or "R", the centre of the arm's density; "" if it is neither.
std::string axis_of(const std::string& arm, const Experiment& e);
/// Returns "p(ω) = (s+1)/(2π) (ω·R)<sup>s</sup>"; for an arm that combines two, their weights.
std::string density_formula(const std::string& arm, const Experiment& e);
/// Returns the same density with the value of `s`.
std::string density_formula_at(const std::string& arm, double s, const Experiment& e);

/// Returns "phong N=256 s=32", or for several runs "uniform | cosine | phong N=64 s=32": common parts appear once, and
/// s only if it identifies a run. For an arm that combines two techniques N counts pairs.
std::string runs_label(const std::vector<RunKey>& runs, const Experiment& e, bool with_n = true);

/// Returns how the reference was computed: "by quadrature, no samples" or its sample counts and seed.
std::string reference_words(const Experiment& e);

/// Formats at most `digits` significant digits, with a true minus, ∞ and "not a number" in words; powers of ten as
/// superscripts.
std::string number(double v, int digits = 4);
/// Formats exactly `digits` significant digits, trailing zeros kept, so that columns of a table align; 0 is "0", and
/// larger numbers keep all digits before the point up to 10^7.
std::string figure(double v, int digits = 4);
/// Formats 12345678 as "12 345 678" with thin spaces.
std::string count(std::uint64_t v);

/// Joins the parts with `separator`.
std::string joined(const std::vector<std::string>& parts, std::string_view separator);

inline constexpr const char* radiance_unit = "W·sr<sup>−1</sup>·m<sup>−2</sup>";

/// A plate being drawn.
struct Sheet {
    const PlatePlan& plan;
    const PlateInputs& in;
    Canvas canvas;
    std::uint64_t not_finite = 0;    // pixels shown that are NaN
    std::vector<std::string> notes;  // for the footer, markup
    std::vector<Rect> tags;          // name tags of regions so far

    Sheet(const PlatePlan& p, const PlateInputs& i, Medium medium = Medium::pixels)
        : plan(p), in(i), canvas(sheet_width, sheet_height, ground, 1, i.theme, medium) {}
    /// The experiment whose runs the plate shows.
    const Experiment& experiment() const { return in.experiment; }
};

/// Writes "Khronos PBR Neutral / PHOTO-ONLY / `what`", and `stream` ("seed 7") at the right: a photograph has no
/// measured number on it.
void photograph_header(Sheet& sheet, const std::string& what, const std::string& stream);
/// Writes "INSTRUMENT `name` / `what`" and names the back end in the footer. `of_films`: the plate was read from films,
/// which any back end may have computed; else it is the CPU's, and the back end of the run's films is named too.
void backend_header(
    Sheet& sheet, const std::string& name, const std::string& what, const std::string& stream, bool of_films = true);
/// Names in the footer the arms of the plate that cannot reach all light of the scene, so that their errors stop
/// falling.
void note_biased_arms(Sheet& sheet);
/// "seed 7", "one stream, seed 7" for several runs.
std::string stream_words(const std::vector<RunKey>& runs);
/// Returns the reference's own seed, "" if it is not sampled.
std::string reference_stream(const Experiment& e);
/// Draws caption and footer; called last, when the notes are known.
void finish(Sheet& sheet);

/// Paints `box` of a view at the centre-top of `slot` and frames it; counts pixels that are not finite. A run without a
/// film gives a framed note. Returns the rectangle of the picture.
Rect paint_photograph(Sheet& sheet, const View& v, const Box& box, const Rect& slot);
/// Paints a framed empty picture that states what is missing.
Rect paint_missing(Sheet& sheet, const Rect& slot, const std::string& why);
/// Paints a block centred across the slot at its top, with a hairline around it.
Rect paint_framed(Sheet& sheet, const Block& block, const Rect& slot);

/// Returns the colour of an arm, the same on every plate.
Colour arm_colour(const std::string& arm, const Experiment& e);

/// Draws a frame over a picture, on a halo of the sheet's ground, so that it is visible at any brightness.
void outline_over(Canvas& canvas, const Rect& r, const Colour& ink);

/// Returns where image box `box` lies in the picture of `frame`.
Rect on_picture(const Rect& picture, const Box& frame, const Box& box);

/// Draws the name of an outlined region on a tag at one of its corners, on the picture and clear of earlier tags; none
/// if there is no such place.
void name_tag(Sheet& sheet, const Rect& picture, const Rect& outline, const std::string& name, const Colour& c);

/// Draws a vertical turbo bar from 0 to `top` with ticks at round numbers, on `bar`; the labels are to its right.
/// With `decades` it is logarithmic and begins that many powers of ten below `top`.
void colour_bar(Sheet& sheet, const Rect& bar, double top, bool open_ended, int decades = 0);

// The painters of the list in experiment/experiment.h; several kinds may share one.
#define CRESCENT_PAINTER(name, painter, ...) void draw_##painter(Sheet& sheet);
CRESCENT_PLATES(CRESCENT_PAINTER)
#undef CRESCENT_PAINTER

/// Draws by kind onto an empty sheet; shared by draw_plate and the tests of the layout.
void draw(Sheet& sheet);

/// The same for draw_preview: its name and its caption, and the picture.
PlatePlan preview_plan(const Experiment& e);
void paint_preview(Sheet& sheet);

// ---- The column of facts next to a single picture: a title, its density, then names and values in two columns.

inline constexpr double facts_width = 232;
/// Left of the facts: the place of a single picture, 960x540 like the published one.
inline constexpr Rect picture_slot{content_band.x, content_band.y, sheet_inner - facts_width - 24, content_band.h};
inline constexpr Rect facts_slot{
    content_band.x + sheet_inner - facts_width, content_band.y, facts_width, content_band.h};

/// A line of the facts next to a picture.
struct Fact {
    std::string name, value;
};
/// The line of an exponent; none in a scene without one, whose s is 0.
std::vector<Fact> exponent_facts(double s);
/// Appends " s=32" to a text, nothing in a scene without an exponent.
std::string with_exponent(const std::string& text, double s);
/// Returns the y under the last line.
double facts(Sheet& sheet, const std::string& title, const std::string& under_title, const std::vector<Fact>& list);

}  // namespace crescent::plates
