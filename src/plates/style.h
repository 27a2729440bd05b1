// One palette, one type scale and one grid for all plates, in pixels of the 1280x720 sheet.
#pragma once

#include "plates/canvas.h"

namespace crescent::plates {

inline constexpr int sheet_width = 1280, sheet_height = 720;

// A neutral dark ground, so that photographs keep their tones; text at 17:1 and 8:1 contrast.
inline constexpr Srgb8 ground_bytes{20, 21, 23};
inline constexpr Colour ground{ground_bytes[0] / 255.0, ground_bytes[1] / 255.0, ground_bytes[2] / 255.0};
inline constexpr Colour panel{0.118, 0.125, 0.137};
inline constexpr Colour rule{0.235, 0.247, 0.267};
inline constexpr Colour bright{0.953, 0.953, 0.941};
inline constexpr Colour muted{0.682, 0.702, 0.729};
inline constexpr Colour photograph_accent{0.957, 0.733, 0.373};
inline constexpr Colour instrument_accent{0.431, 0.792, 0.867};
inline constexpr Colour alert{1.0, 0.43, 1.0};
/// For arms in the order of the experiment, told apart by lightness as well as by hue; the first, the baseline, is
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
    {photograph_accent, {0.604, 0.357, 0.000}}, {instrument_accent, {0.000, 0.408, 0.498}},
    {alert, {0.741, 0.000, 0.741}}, {series[0], {0.392, 0.392, 0.392}}, {series[3], {0.710, 0.161, 0.176}},
    {series[4], {0.184, 0.455, 0.118}}, {series[5], {0.439, 0.290, 0.690}}};
/// A colour of this file as a theme shows it, its opacity kept; another stays as it is.
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

inline constexpr Text label_text{20, bright, Weight::medium, Align::left, Vertical::middle, 1, 15};
inline constexpr Text title_text{24, bright, Weight::semibold, Align::left, Vertical::top, 1, 15};
inline constexpr Text body_text{18, bright, Weight::regular, Align::left, Vertical::top, 1, 14};
inline constexpr Text small_text{15, muted, Weight::regular, Align::left, Vertical::top, 1, 12};

/// A text style with one thing changed.
constexpr Text with(Text t, Align a) { return t.align = a, t; }
constexpr Text with(Text t, Vertical v) { return t.vertical = v, t; }
constexpr Text with(Text t, const Colour& c) { return t.ink = c, t; }
constexpr Text with(Text t, Weight w) { return t.weight = w, t; }
constexpr Text with_lines(Text t, int lines) { return t.lines = lines, t; }
constexpr Text with_px(Text t, double px) { return t.px = px, t; }

/// The band cut into `n` equal columns.
inline Rect column(const Rect& band, std::size_t n, std::size_t i) {
    double w = (band.w - gap * double(n - 1)) / double(n);
    return {band.x + double(i) * (w + gap), band.y, w, band.h};
}

}  // namespace crescent::plates
