// Films -> blocks of pixels that fit a slot. Enlarging repeats pixels a whole number of times, so that noise stays what
// it was; reducing averages areas, for photographs in linear light before the tone mapper, for residuals in radiance.
#pragma once

#include <functional>

#include "render/film.h"
#include "report/plates/canvas.h"

namespace crescent::plates {

/// The three channels of a film or a reference, rows bottom-up. An empty view (width 0) stands for a film not run.
struct View {
    int width = 0, height = 0;
    const float *r = nullptr, *g = nullptr, *b = nullptr, *y = nullptr;
};
/// A film or reference to be drawn; null draws nothing.
View view(const Film* film);
View view(const ReferenceFilm* film);

/// How w x h pixels are brought into a slot: whole-number enlargement (`times`), or reduction to out_w x out_h.
struct Fit {
    int times = 1;  // >= 1; 1 with out == in: one to one
    int out_w = 0, out_h = 0;
    bool reduced = false;
    double ratio() const;  // out_w / in_w
    int in_w = 0, in_h = 0;
};
/// The largest w x h picture that fits a slot, at a whole number of pixels.
Fit fit(int w, int h, double slot_w, double slot_h);
/// "1:1", "×4", "×0.41"; "×0.06 across, ×0.12 up" where one pixel is the least that can be drawn.
std::string to_string(const Fit& f);

/// The box of all pixels.
Box whole(const View& v);
/// `box` cut to the image; the whole image where nothing is left.
Box inside(const Box& box, const View& v);

/// A photograph of `box` through the display chain. A reduced pixel is not a number where any of its sources is not.
Block photograph_block(const View& v, const Box& box, const Fit& f, double exposure);
/// value(x, y) in image coordinates through turbo, 0..1 -> its ends.
Block turbo_block(const Box& box, const Fit& f, const std::function<double(int, int)>& value);

/// Pixels of `box` with a channel that is not finite.
std::uint64_t not_finite(const View& v, const Box& box);

}  // namespace crescent::plates
