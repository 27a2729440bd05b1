// error: the standard error of Y in a run, read off its film, through turbo on a scale that ends at its largest.
#include <algorithm>
#include <cmath>

#include "report/plates/sheet.h"

namespace crescent::plates {

void draw_error(Sheet& sheet) {
    const std::vector<RunKey> runs = keys_of(sheet.plan, sheet.experiment());
    backend_header(sheet, "STANDARD ERROR", runs_label(runs, sheet.experiment()), stream_words(runs));
    const Film* film = runs.empty() ? nullptr : sheet.in.film(runs[0]);
    if (!film) {
        paint_missing(sheet, content_band, "no film");
        return;
    }
    const View v = view(film);
    const double largest = std::sqrt(static_cast<double>(*std::max_element(film->var.begin(), film->var.end())));
    const double top = largest > 0 ? largest : 1;
    const Rect slot{content_band.x, content_band.y, content_band.w - 124, content_band.h};
    const Fit f = fit(v.width, v.height, slot.w, slot.h);
    const Rect picture = paint_framed(sheet,
        turbo_block(whole(v), f,
            [&](int x, int y) {
                return std::sqrt(
                           static_cast<double>(film->var[std::size_t(y) * std::size_t(v.width) + std::size_t(x)])) /
                    top;
            }),
        slot);
    colour_bar(sheet, {slot.right() + gap, picture.y, 24, std::max(120.0, picture.h)}, top, false);
    sheet.notes.push_back("0 to " + number(top) + " " + radiance_unit + ", " + to_string(f));
}

}  // namespace crescent::plates
