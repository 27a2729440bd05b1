// The scene as the experiment gives it: camera, shapes, lights. Lengths in scene units, radiance in W/(sr m^2).
#include <fmt/format.h>

#include <algorithm>

#include "experiment/light_tables.h"
#include "experiment/warnings.h"
#include "report/page.h"

namespace crescent::inline report {
namespace {

using html::words;

std::string vec(const Vec3d& v) {
    return html::value(fmt::format("({}, {}, {})", compact(v.x), compact(v.y), compact(v.z)));
}
std::string rgb(const Rgb& c) {
    if (c[0] == c[1] && c[1] == c[2]) return shortest(c[0]);
    return html::value(fmt::format("({}, {}, {})", compact(c[0]), compact(c[1]), compact(c[2])));
}

std::string value_of(double x) { return shortest(x); }
std::string value_of(bool x) { return x ? "yes" : "no"; }
std::string value_of(const Vec3d& v) { return vec(v); }
std::string value_of(const std::optional<Rgb>& c) { return c ? rgb(*c) : ""; }

/// "centre (0, 1, 0), radius 0.5": the parameters of the kind that `any` holds; those that are not given are left out.
template <class Any> std::string parameters_of(const Any& any) {
    return std::visit(
        []<class Kind>(const Kind& kind) {
            std::string out;
            for (const Parameter<Kind>& parameter : Kind::parameters()) {
                const std::string value =
                    std::visit([&](auto member) { return value_of(kind.*member); }, parameter.member);
                if (value.empty()) continue;
                std::string name(parameter.name);
                std::replace(name.begin(), name.end(), '_', ' ');
                out += fmt::format("{}{} {}", out.empty() ? "" : ", ", name, value);
            }
            return out;
        },
        any);
}

std::string lobe(const Material& m) {
    if (m.rho_s == 0) return "–";
    const std::string share = "<i>ρ</i><sub>s</sub> = " + (m.specular ? rgb(*m.specular) : shortest(m.rho_s));
    const LobeInfo& lobe = lobe_info(m.brdf);
    const bool by_alpha = lobe.parameter == LobeParameter::alpha;
    return fmt::format("{}, {}, {} = {}", share, lobe.label, by_alpha ? "<i>α</i>" : "<i>s</i>",
        shortest((by_alpha ? m.alpha : m.s).value_or(0)));
}

std::string shapes_table(const Page& page) {
    html::Table table("Shapes. Pixels: how many primary rays meet the shape first",
        {words("Shape"), words("Kind"), words("Where"), words("<i>ρ</i><sub>d</sub>"), words("Lobe"),
            words("Blocks the lights"), {"Pixels", true}});
    for (const Shape& shape : page.in.experiment.shapes) {
        const auto found = page.in.metrics.shape_pixels.find(shape.name);
        const bool known = found != page.in.metrics.shape_pixels.end();
        table.row({html::heading(escape(shape.name)), words(std::string(shape.kind())),
            words(parameters_of(shape.form)), words(rgb(shape.material.rho_d)), words(lobe(shape.material)),
            words(shape.occludes ? "yes" : "no"), html::figure(known ? std::to_string(found->second) : "")});
    }
    return table.empty() ? "" : table.str();
}

std::string lights_table(const Experiment& e) {
    html::Table table("Lights. Sampled rays alone meet them; the fill comes from wherever no other light is met",
        {words("Light"), words("Where"), words("Radiance, W/(sr m²)")});
    for (const auto& [path, light] : all_lights(e))
        table.row({html::heading(escape(light.name)),
            words(fmt::format("{}: {}", light.kind(), parameters_of(light.form))), words(rgb(light.radiance))});
    table.row({html::heading("fill"), words("the whole hemisphere"), words(rgb(e.fill))});
    return table.str();
}

}  // namespace

PageSection scene(Page& page) {
    const Experiment& e = page.in.experiment;
    std::string out =
        html::p(fmt::format("The camera stands at {}, looks at {} and sees {}° from top to bottom, {} × {} pixels, one "
                            "primary ray through the centre of each; {} of them meet a surface. Directions are drawn "
                            "once, at that surface: one bounce, no more.",
            vec(e.camera.eye), vec(e.camera.target), shortest(e.camera.vfov_deg), e.image.width, e.image.height,
            page.in.metrics.geometry_pixels));
    std::vector<std::string> warnings;
    for (const std::string& warning : warnings_of(e))
        warnings.push_back("<b class=\"bad\">Warning</b>: " + escape(warning));
    if (!warnings.empty()) out += html::list(warnings);
    out += page.figures.plates(PlateKind::gallery) + shapes_table(page) + lights_table(e);
    return {"scene", "The scene", out};
}

}  // namespace crescent::inline report
