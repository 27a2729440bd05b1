// What all plates share: the sheet with its header, caption and footer, and the film of a run.
#pragma once

#include <string>
#include <vector>

#include "plates/raster.h"
#include "plates/style.h"
#include "plates/words.h"

namespace crescent::plates {

/// A plate being drawn.
struct Sheet {
    const PlatePlan& plan;
    const PlateInputs& in;
    Canvas canvas;
    std::uint64_t not_finite = 0;    // pixels shown that are not numbers
    std::vector<std::string> notes;  // for the footer, markup
    std::vector<Rect> tags;          // name tags of regions so far

    Sheet(const PlatePlan& p, const PlateInputs& i, Medium medium = Medium::pixels)
        : plan(p), in(i), canvas(sheet_width, sheet_height, ground, 1, i.theme, medium) {}
    const Experiment& experiment() const { return in.experiment; }
};

/// "Khronos PBR Neutral / PHOTO-ONLY / `what`", and `stream` ("seed 7") at the right: no measured number stands on a
/// photograph.
void photograph_header(Sheet& sheet, const std::string& what, const std::string& stream);
/// "INSTRUMENT `name` / `what`"; names the instrument in the footer. `of_films`: what it shows was read off films,
/// which any instrument may have computed; else it is the CPU's, and the films of the run are named beside it.
void instrument_header(
    Sheet& sheet, const std::string& name, const std::string& what, const std::string& stream, bool of_films = true);
/// Names in the footer the arms of the plate that cannot reach all light of the scene, so that their errors stop
/// falling.
void note_biased_arms(Sheet& sheet);
/// "seed 7", "one stream, seed 7" for several runs.
std::string stream_words(const std::vector<RunKey>& runs);
/// The reference's own seed, "" where it is not sampled.
std::string reference_stream(const Experiment& e);
/// Caption and footer; last, when the notes are known.
void finish(Sheet& sheet);

/// Paints `box` of a view at the centre-top of `slot` and frames it; counts what is not finite. A run without a film
/// leaves a framed note. Returns the rectangle of the picture.
Rect paint_photograph(Sheet& sheet, const View& v, const Box& box, const Rect& slot);
/// A framed empty picture that says what is missing.
Rect paint_missing(Sheet& sheet, const Rect& slot, const std::string& why);
/// Paints a block centred across the slot at its top, with a hairline around it.
Rect paint_framed(Sheet& sheet, const Block& block, const Rect& slot);

/// The same colour for an arm on every plate.
Colour arm_colour(const std::string& arm, const Experiment& e);

/// A frame over a picture, on a halo of the sheet's ground, so that it is seen on a picture of any brightness.
void outline_over(Canvas& canvas, const Rect& r, const Colour& ink);

/// Where image box `box` lies in the picture of `shown`.
Rect on_picture(const Rect& picture, const Box& shown, const Box& box);

/// The name of an outlined region on a tag at one of its corners, on the picture and clear of earlier tags; none where
/// there is no such place.
void name_tag(Sheet& sheet, const Rect& picture, const Rect& outline, const std::string& name, const Colour& c);

/// A vertical turbo bar from 0 to `top` with ticks at round numbers, on `bar`; the labels stand to its right.
void colour_bar(Sheet& sheet, const Rect& bar, double top, bool open_ended);

// The painters of the list, experiment/plate_kinds.h; several kinds may share one.
#define CRESCENT_PAINTER(name, painter, ...) void draw_##painter(Sheet& sheet);
CRESCENT_PLATES(CRESCENT_PAINTER)
#undef CRESCENT_PAINTER

/// Draws by kind onto a fresh sheet; what draw_plate and the tests of the layout share.
void draw(Sheet& sheet);

/// The same for draw_preview: what it is called and says under the picture, and the picture.
PlatePlan preview_plan(const Experiment& e);
void paint_preview(Sheet& sheet);

}  // namespace crescent::plates
