// Cairo draws on RGB24 pixels or as SVG into a string; Pango sets Inter unhinted, in grey, glyphs at unrounded places,
// tabular figures throughout. That Inter is there is asked by the name of its family.
#include "plates/canvas_surface.h"

#include <cairo-svg.h>
#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "base/errors.h"
#include "plates/style.h"

namespace crescent::plates {

namespace {

constexpr const char* family = "Inter";

struct FreeDescription {
    void operator()(PangoFontDescription* d) const { pango_font_description_free(d); }
};
struct FreeOptions {
    void operator()(cairo_font_options_t* o) const { cairo_font_options_destroy(o); }
};
using Description = std::unique_ptr<PangoFontDescription, FreeDescription>;

Description describe(double px, Weight weight) {
    Description d{pango_font_description_new()};
    pango_font_description_set_family(d.get(), family);
    pango_font_description_set_weight(d.get(), static_cast<PangoWeight>(weight));
    pango_font_description_set_absolute_size(d.get(), px * PANGO_SCALE);
    return d;
}

// Asks by name: a font map hands out another family in silence, or ends the program where it has none at all.
void require_font(PangoFontMap* map) {
    PangoFontFamily** families = nullptr;
    int count = 0;
    pango_font_map_list_families(map, &families, &count);
    bool found = false;
    for (int i = 0; i < count; ++i) found |= std::strcmp(pango_font_family_get_name(families[i]), family) == 0;
    g_free(families);
    if (!found) {
        throw OutputError(std::string("plates are set in the font ") + family +
            ", which this machine does not have: install the package fonts-inter");
    }
}

void replace_all(std::string& text, std::string_view what, const std::string& by) {
    for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size())) {
        text.replace(at, what.size(), by);
    }
}

// <sup> and <sub> as plain spans of a size and a rise: Pango's own forms leave their scale behind when text is
// ellipsized within them. Tabular figures throughout.
std::string spans(std::string markup, double px) {
    auto open = [&](double rise) {
        return fmt::format("<span size='70%' rise='{}'>", std::lround(rise * px * PANGO_SCALE));
    };
    replace_all(markup, "<sup>", open(0.36));
    replace_all(markup, "<sub>", open(-0.16));
    replace_all(markup, "</sup>", "</span>");
    replace_all(markup, "</sub>", "</span>");
    return "<span font_features='tnum=1'>" + markup + "</span>";
}

PangoAlignment to_pango(Align a) {
    return a == Align::left ? PANGO_ALIGN_LEFT : a == Align::right ? PANGO_ALIGN_RIGHT : PANGO_ALIGN_CENTER;
}

cairo_status_t append(void* document, const unsigned char* bytes, unsigned int count) {
    static_cast<std::string*>(document)->append(reinterpret_cast<const char*>(bytes), count);
    return CAIRO_STATUS_SUCCESS;
}

}  // namespace

Canvas::Surface::Surface(int width, int height, double pixels_a_unit, Theme how, Medium medium)
    : scale(pixels_a_unit), theme(how) {
    require_font(pango_cairo_font_map_get_default());
    image = medium == Medium::svg ? cairo_svg_surface_create_for_stream(append, &document, width, height)
                                  : cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
    if (medium == Medium::svg) cairo_svg_surface_set_document_unit(image, CAIRO_SVG_UNIT_PX);
    cr = cairo_create(image);
    cairo_scale(cr, scale, scale);
    layout.reset(pango_cairo_create_layout(cr));
    PangoContext* context = pango_layout_get_context(layout.get());
    // Grey antialiasing and no hinting: the same outlines whatever the desktop's settings are.
    std::unique_ptr<cairo_font_options_t, FreeOptions> options{cairo_font_options_create()};
    cairo_font_options_set_antialias(options.get(), CAIRO_ANTIALIAS_GRAY);
    cairo_font_options_set_hint_style(options.get(), CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options.get(), CAIRO_HINT_METRICS_OFF);
    pango_cairo_context_set_font_options(context, options.get());
    pango_cairo_context_set_resolution(context, 96);
    pango_context_set_round_glyph_positions(context, FALSE);
    pango_context_set_language(context, pango_language_from_string("en"));
}
void Canvas::Surface::ink(const Colour& c) {
    const Colour shown = themed(c, theme);
    cairo_set_source_rgba(cr, shown.r, shown.g, shown.b, shown.a);
}

Canvas::Surface::~Surface() {
    layout.reset();
    cairo_destroy(cr);
    cairo_surface_destroy(image);
}

Rect Canvas::Surface::lay(const std::string& markup, const Text& how, double px, double width) {
    PangoLayout* l = layout.get();
    pango_layout_set_font_description(l, describe(px, how.weight).get());
    pango_layout_set_ellipsize(l, PANGO_ELLIPSIZE_NONE);
    pango_layout_set_height(l, -1);
    pango_layout_set_width(l, width < 0 ? -1 : static_cast<int>(std::ceil(width * PANGO_SCALE)));
    pango_layout_set_wrap(l, PANGO_WRAP_WORD);
    pango_layout_set_alignment(l, to_pango(how.align));
    pango_layout_set_line_spacing(l, how.lines > 1 ? 1.12f : 0.0f);
    std::string text = spans(markup, px);
    pango_layout_set_markup(l, text.c_str(), static_cast<int>(text.size()));
    PangoRectangle r;
    pango_layout_get_extents(l, nullptr, &r);
    return {double(r.x) / PANGO_SCALE, double(r.y) / PANGO_SCALE, double(r.width) / PANGO_SCALE,
        double(r.height) / PANGO_SCALE};
}

}  // namespace crescent::plates
