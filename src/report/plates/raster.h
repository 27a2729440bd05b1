// Converts films to blocks of pixels that fit a slot. Enlarging repeats pixels a whole number of times, so that noise
// is unchanged; reducing averages areas, for photographs in linear light before the tone mapper, for residuals in
// radiance.
#pragma once

#include <functional>

#include "render/film.h"
#include "report/plates/canvas.h"

namespace crescent::plates {

/// The three channels of a film or a reference, rows bottom-up. An empty view (width 0) represents a film that was not
/// run.
struct View {
    int width = 0, height = 0;
    const float *r = nullptr, *g = nullptr, *b = nullptr, *y = nullptr;
};
/// A film or reference to draw; for null nothing is drawn.
View view(const Film* film);
View view(const ReferenceFilm* film);

/// How w x h pixels are fitted to a slot: whole-number enlargement (`times`), or reduction to out_w x out_h.
struct Fit {
    int times = 1;  // >= 1; 1 with out == in: one to one
    int out_w = 0, out_h = 0;
    bool reduced = false;
    double ratio() const;  // out_w / in_w
    int in_w = 0, in_h = 0;
};
/// Returns the largest w x h picture that fits a slot, at a whole number of pixels.
Fit fit(int w, int h, double slot_w, double slot_h);
/// Returns "1:1", "×4", "×0.41"; "×0.06 across, ×0.12 up" if one pixel is the smallest size that can be drawn.
std::string to_string(const Fit& f);

/// Returns the box of all pixels.
Box whole(const View& v);
/// Returns `box` cut to the image; the whole image if nothing is left.
Box inside(const Box& box, const View& v);

/// Returns a tone-mapped photograph of `box`. A reduced pixel is NaN if any of its sources is.
Block photograph_block(const View& v, const Box& box, const Fit& f, double exposure);
/// Maps value(x, y) in image coordinates to turbo, from 0 to 1.
Block turbo_block(const Box& box, const Fit& f, const std::function<double(int, int)>& value);

/// Returns the number of pixels of `box` with a channel that is not finite.
std::uint64_t not_finite(const View& v, const Box& box);

}  // namespace crescent::plates
