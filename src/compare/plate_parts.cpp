// Colours in sRGB; a difference of t goes from the middle colour to an end's at |t| = 1, straight in sRGB. A block that
// is shown smaller shows means over its pixels. Places in units of the sheet, a pixel each.
#include "compare/plate_parts.h"

#include <algorithm>
#include <cmath>

namespace crescent::plates {

void header(Canvas& c, bool instrument, const std::string& label) {
    const Colour accent = instrument ? instrument_accent : photograph_accent;
    c.fill({header_band.x, header_band.y + 4, 5, header_band.h - 8}, accent);
    c.text({header_band.x + 17, header_band.y, header_band.w - 17, header_band.h},
        (instrument ? "INSTRUMENT / " : "Khronos PBR Neutral / PHOTO-ONLY / ") + label, label_text);
}

void finish(Canvas& c, const std::string& caption, const std::string& note) {
    c.text(caption_band, caption, with_lines(body_text, 2));
    c.text(footer_band, note, with_px(small_text, 17));
}

Picture finished(Canvas& c, const std::string& caption, const std::string& note) {
    finish(c, caption, note);
    return c.picture();
}

Srgb8 diverging(double t, Theme theme) {
    if (std::isnan(t)) return ground_pixel(theme);
    constexpr double middles[2][3] = {{52, 55, 60}, {226, 228, 230}};
    constexpr double lows[2][3] = {{70, 150, 240}, {20, 90, 190}}, highs[2][3] = {{250, 150, 50}, {200, 90, 0}};
    const bool light = theme == Theme::light;
    const double *middle = middles[light], *low = lows[light], *high = highs[light];
    const double a = std::min(1.0, std::fabs(t));
    Srgb8 out{};
    for (std::size_t k = 0; k < 3; ++k)
        out[k] = static_cast<unsigned char>(std::lround(middle[k] + a * ((t < 0 ? low : high)[k] - middle[k])));
    return out;
}

Block nearest_block(const Box& box, const Fit& f, const std::function<Srgb8(int, int)>& colour) {
    Block out(f.out_w, f.out_h);
    for (int y = 0; y < f.out_h; ++y)
        for (int x = 0; x < f.out_w; ++x)
            out.set(x, y, colour(box.x0 + x * f.in_w / f.out_w, box.y1 - y * f.in_h / f.out_h));
    return out;
}

Block diverging_block(const Box& box, const Fit& f, Theme theme, const std::function<double(int, int)>& value) {
    return nearest_block(box, f, [&](int x, int y) {
        if (!f.reduced) return diverging(value(x, y), theme);
        const int across = std::max(1, f.in_w / f.out_w), down = std::max(1, f.in_h / f.out_h);
        double sum = 0, count = 0;
        for (int j = y; j > std::max(box.y0 - 1, y - down); --j)
            for (int i = x; i < std::min(box.x1 + 1, x + across); ++i)
                if (const double v = value(i, j); !std::isnan(v)) sum += v, count += 1;
        return diverging(count > 0 ? sum / count : std::nan(""), theme);
    });
}

Rect framed(Canvas& c, const Block& block, const Rect& slot) {
    const int x = static_cast<int>(std::floor(slot.x + (slot.w - block.width) / 2)),
              y = static_cast<int>(std::floor(slot.y));
    c.paint(block, x, y);
    const Rect r{double(x), double(y), double(block.width), double(block.height)};
    c.outline(r.inset(-0.5), rule, 1);
    return r;
}

void bar(Canvas& c, const Rect& at, const std::function<Srgb8(double)>& colour, const Ticks& ticks) {
    Block block(static_cast<int>(at.w), static_cast<int>(at.h));
    for (int y = 0; y < block.height; ++y)
        for (int x = 0; x < block.width; ++x) block.set(x, y, colour(1 - (y + 0.5) / block.height));
    framed(c, block, at);
    for (const auto& [share, text] : ticks)
        c.text({at.right() + 10, at.y + at.h * (1 - share) - 12, 84, 24}, text,
            with(with(with_px(small_text, 15), bright), Vertical::middle));
}

std::function<Srgb8(double)> signed_colours(Theme theme) {
    return [theme](double t) { return diverging(2 * t - 1, theme); };
}

}  // namespace crescent::plates
