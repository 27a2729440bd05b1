// The colour bar of turbo scales.
#include <algorithm>
#include <cmath>

#include "color/turbo.h"
#include "pages/axis.h"
#include "plates/sheet.h"

namespace crescent::plates {

void colour_bar(Sheet& sheet, const Rect& bar, double top, bool open_ended) {
    Canvas& c = sheet.canvas;
    int w = static_cast<int>(bar.w), h = static_cast<int>(bar.h);
    Block block(w, h);
    for (int y = 0; y < h; ++y) {
        for (int x = 0; x < w; ++x) block.set(x, y, turbo(1 - (y + 0.5) / h));
    }
    double y0 = std::floor(bar.y), x0 = std::floor(bar.x);
    c.paint(block, static_cast<int>(x0), static_cast<int>(y0));
    c.outline({x0 - 0.5, y0 - 0.5, w + 1.0, h + 1.0}, rule, 1);
    Text how = with(with(with_px(small_text, 16), bright), Vertical::middle);
    auto tick = [&](double v, const std::string& text) {
        double y = y0 + h * (1 - v / top);
        c.line(x0 + w, y, x0 + w + 6, y, muted, 1.5);
        c.text({x0 + w + 11, y - 12, 80, 24}, text, how);
    };
    tick(top, (open_ended ? "≥ " : "") + number(top, 3));
    double step = round_up(top / std::clamp(h / 24, 1, 7));
    for (int k = 0; k * step < top; ++k) {
        if (h * (1 - k * step / top) >= 24) tick(k * step, number(k * step, 3));
    }
}

}  // namespace crescent::plates
