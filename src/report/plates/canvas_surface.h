// Cairo's surface and context, Pango's layout: for the files of this folder that draw.
#pragma once

#include <pango/pangocairo.h>

#include <memory>
#include <string>

#include "report/plates/canvas.h"

namespace crescent::plates {

struct Unref {
    void operator()(gpointer object) const { g_object_unref(object); }
};

struct Canvas::Surface {
    cairo_surface_t* image = nullptr;
    cairo_t* cr = nullptr;
    double scale = 1;
    Theme theme = Theme::dark;
    std::unique_ptr<PangoLayout, Unref> layout;

    std::string document;  // of Medium::svg, once finished

    Surface(int width, int height, double scale, Theme theme, Medium medium);
    ~Surface();
    Surface(const Surface&) = delete;
    Surface& operator=(const Surface&) = delete;

    void ink(const Colour& c);
    /// Lays out markup at `px`; width < 0: unbounded.
    Rect lay(const std::string& markup, const Text& how, double px, double width);
};

}  // namespace crescent::plates
