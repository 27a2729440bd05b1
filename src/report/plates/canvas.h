// The surface of a plate: rectangles, lines, pixel blocks, and text that is measured before it is set. Units are pixels
// of the plate, origin top-left, y down. Colours are sRGB in [0, 1].
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "output/tone_map.h"
#include "report/plates/plates.h"

namespace crescent::plates {

// ---- Fonts installed with the program: a package that contains Inter needs none of the machine's.

/// Makes ../share/crescent/fonts/fonts.conf, seen from the program's folder, Fontconfig's configuration, where that
/// file exists and FONTCONFIG_FILE is not set. Before Fontconfig is first used.
void use_fonts_beside_program();

}  // namespace crescent::plates

typedef struct _cairo cairo_t;  // NOLINT(bugprone-reserved-identifier): Cairo's own name

namespace crescent::plates {

/// A rectangle: its top-left corner and its size.
struct Rect {
    double x = 0, y = 0, w = 0, h = 0;
    /// Its right and bottom edges; the rectangle made smaller by d on each side; whether two rectangles have an inner
    /// point in common.
    double right() const { return x + w; }
    double bottom() const { return y + h; }
    Rect inset(double d) const { return {x + d, y + d, w - 2 * d, h - 2 * d}; }
    bool meets(const Rect& o) const { return x < o.right() && o.x < right() && y < o.bottom() && o.y < bottom(); }
};

/// sRGB and coverage, all in [0, 1].
struct Colour {
    double r = 0, g = 0, b = 0, a = 1;
};
/// Converts 8-bit sRGB to Cairo's form.
Colour colour(const Srgb8& c);

/// How text is set: the font's weight, and its alignment in its box.
enum class Weight { regular = 400, medium = 500, semibold = 600 };
enum class Align { left, centre, right };
enum class Vertical { top, middle, bottom };

/// How text is set. It is reduced from `px` to `least_px` until it fits its box, then wrapped words are ellipsized.
struct Text {
    double px = 18;
    Colour ink;
    Weight weight = Weight::regular;
    Align align = Align::left;
    Vertical vertical = Vertical::top;
    int lines = 1;  // at most
    double least_px = 13;
};

/// The result of setting one piece of text: for tests, which require that nothing is cut or overlaps its neighbour.
struct Setting {
    std::string text;
    Rect box, extents;  // what it was given and what it took
    double px = 0;      // the size it was set at
    bool ellipsized = false;
    Colour ink;
};

/// 8-bit sRGB pixels, rows top-down.
struct Block {
    int width = 0, height = 0;
    std::vector<unsigned char> rgb;
    Block() = default;
    Block(int w, int h) : width(w), height(h), rgb(3 * std::size_t(w) * std::size_t(h)) {}
    /// Pixel (x, y), counted from the top-left.
    void set(int x, int y, const Srgb8& c) {
        unsigned char* p = &rgb[3 * (std::size_t(y) * std::size_t(width) + std::size_t(x))];
        p[0] = c[0];
        p[1] = c[1];
        p[2] = c[2];
    }
};

/// The output of a canvas.
enum class Medium { pixels, svg };

/// A picture being drawn. One thread at a time; several canvases may be drawn at once.
class Canvas {
public:
    /// Throws OutputError if the font Inter is missing. `scale`: pixels per unit; all drawing is in units. Colours of
    /// sheet.h are shown as the theme defines them; blocks of pixels and all other colours are unchanged. Medium::svg
    /// has lines, and letters as outlines, returned by svg(); blocks of pixels cannot be painted there.
    Canvas(int width, int height, const Colour& ground, double scale = 1, Theme theme = Theme::dark,
        Medium medium = Medium::pixels);
    ~Canvas();
    Canvas(const Canvas&) = delete;
    Canvas& operator=(const Canvas&) = delete;

    /// Sets Pango markup in `box`; names from the experiment must have gone through `escaped`. Returns its extents.
    Rect text(const Rect& box, const std::string& markup, const Text& style);
    /// Returns width and height of the markup on one line at style.px.
    Rect measure(const std::string& markup, const Text& style) const;

    /// Shapes, in units of the canvas. `width` is a line's, `dash` the length of a dash and of the gap after it, 0 for
    /// none. Polygons and dots are filled; an arrow has its head at `to`.
    void fill(const Rect& r, const Colour& c);
    void outline(const Rect& r, const Colour& c, double width);
    void line(double x0, double y0, double x1, double y1, const Colour& c, double width, double dash = 0);
    struct Point {
        double x, y;
    };
    /// As the shapes above.
    void polyline(const std::vector<Point>& points, const Colour& c, double width, double dash = 0);
    void polygon(const std::vector<Point>& points, const Colour& c);
    void dot(double x, double y, double radius, const Colour& c);
    void circle(double x, double y, double radius, const Colour& c, double width, double dash = 0);
    void arrow(Point from, Point to, const Colour& c, double width);

    /// Copies pixels one to one with the top-left corner at (x, y), which are whole numbers on the canvas.
    void paint(const Block& block, int x, int y);
    /// Repeats each pixel times x times units with the top-left corner at (x, y) in units, blended with `alpha`. If
    /// that is not a whole number of the canvas's pixels, those get the average of what they cover. Cut at the canvas's
    /// edge.
    void paint(const Block& block, double x, double y, int times, double alpha);

    /// Drawing until unclip() is shown only within `r`; blocks are not cut.
    void clip(const Rect& r);
    void unclip();
    /// Restores the ground; keeps the fonts that were opened.
    void clear(const Colour& ground);
    /// Text takes its place but is not drawn: for tests of the background of text.
    void hide_text(bool hidden) { text_hidden_ = hidden; }

    /// As given to the constructor; width and height in units.
    Theme theme() const { return theme_; }
    int width() const { return width_; }
    int height() const { return height_; }
    /// Returns rows of 32-bit pixels 0x??RRGGBB, top-down, `stride` bytes apart; valid until the next drawing.
    const unsigned char* pixels(int& stride) const;
    const std::vector<Setting>& settings() const { return settings_; }
    const std::vector<Rect>& pictures() const { return pictures_; }
    Picture picture() const;
    /// Returns the document of a canvas of Medium::svg, which cannot be drawn on after that.
    std::string svg();

private:
    struct Surface;
    int width_, height_;
    std::unique_ptr<Surface> surface_;
    Theme theme_;
    bool text_hidden_ = false;
    std::vector<Setting> settings_;
    std::vector<Rect> pictures_;
};

/// Escapes <, > and & for markup.
std::string escaped(std::string_view plain);

}  // namespace crescent::plates
