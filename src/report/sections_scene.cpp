// The scene as the experiment gives it: camera, shapes, lights. Lengths in scene units, radiance in W/(sr m^2).
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "experiment/queries.h"
#include "output/formula.h"
#include "report/page.h"
#include "report/wording.h"
#include "samplers/info.h"
#include "scene/lobes/lobe.h"

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

/// Returns "centre (0, 1, 0), radius 0.5", the parameters of the kind that `any` holds, without those that are not
/// given.
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

std::string textured(const Texture& texture) { return texture.file ? " × " + html::code(*texture.file) : ""; }

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
    for (const MeshObject& mesh : page.in.experiment.meshes) {
        const auto found = page.in.metrics.shape_pixels.find(mesh.name);
        const bool known = found != page.in.metrics.shape_pixels.end();
        std::string where = escape(mesh.file);
        if (mesh.pack) where += fmt::format(", {} triangles", mesh.pack->mesh.triangles.size());
        if (!mesh.instances.empty()) where += fmt::format(", {} instances", mesh.instances.size());
        if (mesh.emits()) where += fmt::format(", emits {} W/(sr m²)", rgb(mesh.emission));
        table.row({html::heading(escape(mesh.name)), words("mesh"), words(where),
            words(rgb(mesh.material.rho_d) + textured(mesh.rho_d_texture)),
            words(lobe(mesh.material) + textured(mesh.alpha_texture)), words("yes"),
            html::figure(known ? std::to_string(found->second) : "")});
    }
    return table.empty() ? "" : table.str();
}

std::string lights_table(const Experiment& e) {
    html::Table table("Lights. Only sampled rays meet them; the fill comes from every direction without another light",
        {words("Light"), words("Where"), words("Radiance, W/(sr m²)")});
    for (const auto& [path, light] : all_lights(e))
        table.row({html::heading(escape(light.name)),
            words(fmt::format("{}: {}", light.kind(), parameters_of(light.form))), words(rgb(light.radiance))});
    if (e.sky)
        table.row({html::heading("sky"),
            words(fmt::format("the image {}, content {}, turned by {}°", html::code(e.sky->file),
                html::code(e.sky->content.value_or("not read")), shortest(e.sky->rotation))),
            words(fmt::format("that of its texels, times {}", shortest(e.sky->scale)))});
    table.row({html::heading("fill"), words("the whole hemisphere"), words(rgb(e.fill))});
    return table.str();
}

}  // namespace

PageSection scene(Page& page) {
    const Experiment& e = page.in.experiment;
    std::string out =
        html::p(fmt::format("The camera is at {}, looks at {} and sees {}° from top to bottom, {} × {} pixels, one "
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

// ---- The densities of the arms with the maps that draw from them, as stated in the samplers' own files.

namespace {

using html::words;

constexpr const char* plain_prose = R"(
<p>Each arm turns two uniform numbers <i>u</i><sub>1</sub>, <i>u</i><sub>2</sub> in (0, 1) into a direction. The azimuth
is 2π<i>u</i><sub>2</sub> for all; they differ in the polar angle θ and in the axis from which it is measured.</p>
)";

constexpr const char* other_prose = R"(
<p>Each arm turns two uniform numbers <i>u</i><sub>1</sub>, <i>u</i><sub>2</sub> in (0, 1) into a direction, and a
two-sample arm does so twice. <i>m</i> is the half vector, of which the direction is a mirror image; <i>y</i> a point
of a light of area <i>A</i> and <i>θ</i><sub>y</sub> the angle there between its normal and the ray; Ω the solid angle
that the directions to a light are drawn from.</p>
)";

std::string sample_counts(const ArmPlan& arm) {
    std::vector<std::string> all;
    for (const std::uint64_t n : arm.n) all.push_back(std::to_string(n));
    return html::join(all);
}

/// Returns whether the density depends only on the polar angle about one direction.
bool plain(const ArmPlan& arm) {
    const SamplerInfo* info = find_arm_info(arm.sampler);
    return info && info->about != PdfAxis::none;
}

/// Returns the arm's name, with its sampler if that differs, and the light that it cannot reach.
std::string name_of(const ArmPlan& arm, const SamplerInfo& info, const Experiment& e) {
    std::string out = escape(arm.name == arm.sampler ? std::string(info.label) : arm.name);
    if (arm.name != arm.sampler) out += ", sampler " + html::code(arm.sampler);
    if (const std::string missed = missed_light(arm, e); !missed.empty())
        out += fmt::format("<br /><small>cannot reach {}: biased here</small>", missed);
    return out;
}

}  // namespace

PageSection densities(Page& page) {
    html::Table table("The densities, the maps that draw from them and the sample counts <i>N</i> of each arm",
        {words("Arm"), words("Density <i>p</i>(ω), 1/sr"), words("Polar angle"), words("Axis"), words("<i>N</i>")});
    const auto& arms = page.in.experiment.arms;
    for (const ArmPlan& arm : arms) {
        const SamplerInfo* info = find_arm_info(arm.sampler);
        if (!info) {
            table.row({html::heading(escape(arm.name)), words("that of " + escape(source_of(arm))), words(""),
                words(""), words(sample_counts(arm))});
            continue;
        }
        table.row({html::heading(name_of(arm, *info, page.in.experiment)),
            words(mathml::in_cell(formula::mathml(info->density))), words(formula::html(info->draw)),
            words(formula::html(info->axis)), words(sample_counts(arm))});
    }
    if (table.empty()) return {};
    const char* prose = std::all_of(arms.begin(), arms.end(), plain) ? plain_prose : other_prose;
    return {"densities", arms.size() == 3 ? "Three densities" : "The densities",
        prose + table.str() + page.figures.plates(PlateKind::rose)};
}

// ---- The question, and the estimator with its metrics.

namespace {

using namespace mathml;

constexpr const char* question_prose = R"(
<p>A renderer computes how much light leaves a point towards the camera. It traces <i>N</i> rays, divides the
contribution of each by the density it was drawn with, and averages. Any density that reaches all of the light gives the
right result in the limit; for finite <i>N</i>, the density decides how noisy the result is, and <em>where</em> in the
picture the noise is.</p>
<p>This run compares {arms}: {names}. Every arm uses one scene and one camera, is compared at equal <i>N</i> and
gets the same random numbers, pixel by pixel and sample by sample. Only the density <math><mi>p</mi></math> differs, so
all differences between the films come from it.{rays}{bias}{regions}</p>
<p>Every value below comes from the linear float films, none from a picture. A value at the {seed} seed is one draw out
of many; its band shows the values of other seeds, and if the samples are too heavy-tailed for a band, the words {heavy}
replace it.</p>
)";

constexpr const char* estimator_prose = R"(
<p>The light that leaves a point towards the camera after one bounce is</p>
{integral}
<p>and its estimate from <i>N</i> directions drawn with density {p} (in 1/sr) is</p>
{estimator}
<p>Three rules hold for every arm. The cosine {cosine} stays in the numerator. A direction at or below the horizon has
weight 0 and still counts in <i>N</i>; no density is rescaled to compensate for it. And a direction is divided by the
density of the arm that drew it, never by another’s.</p>
)";

constexpr const char* brdf_prose = R"(
<p>A glossy surface adds a lobe to its Lambert part, <i>f</i> = <i>ρ</i><sub>d</sub>/π + <i>ρ</i><sub>s</sub> · lobe.
The lobes of this scene, in 1/sr:</p>
)";

constexpr const char* constants_prose = R"(
<p>Similar constants have different meanings. This BRDF’s <i>s</i> + 2 makes its lobe reflect the share
<i>ρ</i><sub>s</sub> of the light at normal incidence; the <i>s</i> + 1 of a density about <i>R</i> makes that integrate
to one. Exchanging them is an error of {slip} at <i>s</i> = {s}.</p>
)";

constexpr const char* metrics_prose = R"(
<h3>What is measured</h3>
<p>All on luminance <i>Y</i> (Rec. 709 weights, linear). Against the reference, over a region <i>A</i>:</p>
{rmse}
<p>Without a reference, from the samples themselves, the variance of a pixel’s mean, averaged over the region:</p>
{variance}
<p>A <b>firefly</b> is a pixel on a surface where {firefly} with <i>k</i> = {k}. The <b>horizon share</b> is the part of
all directions drawn that were below the horizon; <b><i>Y</i><sub>mean</sub></b> is the mean over the frame. <b>FLIP</b> is
the mean of HDR-FLIP over the region, 0 for a picture that looks like the reference and 1 at most (Andersson et al.
2021). The RMSE of the whole frame mixes regions that behave in opposite ways; it is shown only in a footnote.</p>
)";

std::string spelled(std::size_t count) {
    static const char* words[] = {"no arms", "one arm", "two arms", "three arms", "four arms", "five arms", "six arms"};
    return count < 7 ? words[count] : fmt::format("{} arms", count);
}

std::string regions_sentence(const Experiment& e) {
    if (e.regions.empty()) return {};
    std::vector<std::string> names;
    for (const Region& r : e.regions)
        names.push_back(fmt::format("<b>{}</b> ({} × {} pixels)", escape(r.name), r.box.width(), r.box.height()));
    return fmt::format(" Errors are read in {}, {}.",
        e.regions.size() == 1 ? "one region" : "regions that behave differently", html::join(names));
}

/// Returns the lobes of the scene's glossy surfaces, in the list's order.
std::vector<const LobeInfo*> lobes_of(const Experiment& e) {
    std::vector<const LobeInfo*> out;
    for (const LobeInfo& lobe : lobe_infos()) {
        bool used = false;
        for (std::size_t k = 0; k < e.surface_count(); ++k)
            used = used || (e.material(k).rho_s > 0 && e.material(k).brdf == lobe.kind);
        if (used) out.push_back(&lobe);
    }
    return out;
}

std::string brdf_words(const Page& page) {
    const std::vector<const LobeInfo*> lobes = lobes_of(page.in.experiment);
    if (lobes.empty()) return {};
    html::Table table("Lobes of this scene", {html::words("Lobe"), html::words("Value, 1/sr"), html::words("")});
    for (const LobeInfo* lobe : lobes)
        table.row({html::heading(escape(std::string(lobe->label))),
            html::words(in_cell(formula::mathml(lobe->formula))), html::words(formula::html(lobe->summary))});
    std::string out = brdf_prose + table.str();
    const bool about_mirror = std::ranges::any_of(lobes, [](const LobeInfo* l) { return l->about_mirror; });
    if (about_mirror && page.find.s() > 0)
        out += display(mirror(), "R is the outgoing direction mirrored at the normal") +
            fmt::format(constants_prose, fmt::arg("slip", percent(1 / (page.find.s() + 1), 2)),
                fmt::arg("s", shortest(page.find.s())));
    return out;
}

}  // namespace

PageSection question(Page& page) {
    std::vector<std::string> names;
    for (const ArmPlan& arm : page.in.experiment.arms) names.push_back("<b>" + escape(arm.name) + "</b>");
    return {"question", "The question",
        fmt::format(question_prose, fmt::arg("arms", spelled(names.size())), fmt::arg("names", html::join(names)),
            fmt::arg("regions", regions_sentence(page.in.experiment)), fmt::arg("heavy", html::heavy_tail()),
            fmt::arg("seed", page.seed_name()), fmt::arg("rays", ray_words(page.in.experiment)),
            fmt::arg("bias", bias_words(page.in.experiment)))};
}

PageSection estimator_equation(Page& page) {
    const Experiment& e = page.in.experiment;
    std::string out = fmt::format(estimator_prose,
        fmt::arg("integral", display(integral(), "the reflection integral over the upper hemisphere")),
        fmt::arg(
            "estimator", display(mathml::estimator(), "one over N times the sum of f times L times cosine over p")),
        fmt::arg("p", in_line(mi("p"))), fmt::arg("cosine", in_line(row({mi("n"), mo("⋅"), omega()}))));
    out += brdf_words(page);
    out +=
        fmt::format(metrics_prose, fmt::arg("rmse", display(rmse_region(), "root mean square of Y minus Y ref over A")),
            fmt::arg("variance", display(variance(), "sample variance over N")),
            fmt::arg("firefly", in_line(firefly())), fmt::arg("k", shortest(e.firefly_k)));
    return {"estimator", "The estimator", out};
}

// ---- The reference, and the effect of using the Monte Carlo reference of the article instead.

namespace {

using html::words;

constexpr const char* quadrature_prose = R"(
<p>The reference integrates each pixel to convergence: the Lambert term on the fill in closed form, the lobe on the fill
from a table of its albedo, every light by quadrature. It has no seed, and states its own error.</p>
)";

constexpr const char* paired_prose = R"(
<p>The reference is a pair of independent estimates <i>R</i><sub>1</sub> and <i>R</i><sub>2</sub> of every pixel, by
{n} scrambled Sobol points for each way to draw a direction, on a seed of their own ({seed}). The squared error of a film
is the mean of (<i>Y</i> − <i>R</i><sub>1</sub>)(<i>Y</i> − <i>R</i><sub>2</sub>), in which the errors of the reference
cancel in the mean. Where this estimate is negative, the RMSE is below the reference’s error.</p>
)";

constexpr const char* both_prose = R"(
<p>Two references are computed. The quadrature integrates each pixel to convergence and has no seed. The Monte Carlo one
adds an analytic Lambert term for the fill, the lobe on the fill by {lobe} drawn from it, and each light by {disk} on
its surface, on a seed of its own ({seed}). The metrics of this run use the <b>{used}</b>. The table shows the
difference of the two, the standard error that the random one states, and by how much the RMSE of any arm would change
if the other one were used.</p>
)";

/// Returns the runs whose squared error is below 0, with its interval.
std::string below_the_reference(const ReportInputs& in) {
    html::Table table("Runs whose RMSE is below the reference’s error: their squared error, with its 95 % interval",
        {words("Run"), words("Region"), {"Seed", true}, {"Squared error", true}, {"Interval", true}});
    for (const RunMetrics& run : in.metrics.runs)
        for (const RegionMetrics& region : run.regions)
            if (region.is_paired() && region.mse < 0)
                table.row({html::heading(run_html(run.key, in.experiment)), words(escape(region.region)),
                    html::figure(std::to_string(run.key.seed)), html::figure(figures(region.mse, 2)),
                    html::figure(figures(region.mse_low(), 2) + " … " + figures(region.mse_high(), 2))});
    return table.empty() ? "" : table.str();
}

/// Returns where the reference's own error is too large a part of an RMSE.
std::string not_good_enough(const std::vector<ReferenceQuality>& all) {
    std::string out;
    for (const ReferenceQuality& r : all)
        if (r.error_share > most_error_share)
            out += fmt::format(
                " <b>It is not good enough in region {} at <i>s</i> = {}</b>: its own error is {} of the "
                "smallest RMSE there.",
                escape(r.region), shortest(r.s), percent(r.error_share, 2));
    return out.empty() ? out : html::p("The reference that the metrics use states its own error." + out);
}

std::string verdict(const std::vector<ReferenceQuality>& all) {
    const auto worst =
        std::ranges::max_element(all, {}, [](const ReferenceQuality& r) { return *r.max_relative_rmse_change; });
    const std::string out =
        fmt::format("The choice of the reference changes an RMSE by at most {}, in region {} at <i>s</i> = {}.",
            percent(*worst->max_relative_rmse_change, 2), escape(worst->region), shortest(worst->s));
    const bool explained = std::ranges::all_of(
        all, [](const ReferenceQuality& r) { return *r.rms_difference <= 2 * *r.rms_standard_error; });
    return html::p(out +
        (explained
                ? " Everywhere the two differ by no more than twice the standard error of the random one."
                : " Somewhere they differ by more than twice the standard error of the random one: that error is too "
                  "small there, or its tail too long."));
}

std::string table_of_both(const std::vector<ReferenceQuality>& all) {
    html::Table table("The Monte Carlo reference against the quadrature, root mean square over a region, in <i>Y</i>",
        {words("Region"), {"<i>s</i>", true}, {"Difference", true}, {"Its standard error", true},
            {"Quadrature’s error", true}, {"Largest change of an RMSE", true}});
    for (const ReferenceQuality& r : all)
        table.row({html::heading(escape(r.region)), html::figure(shortest(r.s)),
            html::figure(figures(*r.rms_difference, 3)), html::figure(figures(*r.rms_standard_error, 3)),
            html::figure(figures(*r.quadrature_error, 2)), html::figure(percent(*r.max_relative_rmse_change, 2))});
    return table.str() + verdict(all);
}

std::string table_of_one(const std::vector<ReferenceQuality>& all) {
    html::Table table("The reference’s own error, root mean square over a region, in <i>Y</i>",
        {words("Region"), {"<i>s</i>", true}, {"Its error", true}, {"Share of the smallest RMSE", true}});
    for (const ReferenceQuality& r : all)
        table.row({html::heading(escape(r.region)), html::figure(shortest(r.s)),
            html::figure(figures(r.paired_error ? *r.paired_error : *r.quadrature_error, 2)),
            html::figure(std::isfinite(r.error_share) ? percent(r.error_share, 2) : "above it")});
    return table.str();
}

}  // namespace

PageSection reference(Page& page) {
    const auto& all = page.in.metrics.references;
    const ReferencePlan& plan = page.in.experiment.reference;
    const std::string plates = page.figures.plates(PlateKind::reference);
    if (all.empty() && plates.empty()) return {};
    const bool both = !all.empty() && all.front().max_relative_rmse_change.has_value();
    std::string out = quadrature_prose;
    if (plan.kind == ReferenceKind::paired)
        out = fmt::format(paired_prose, fmt::arg("n", plan.n), fmt::arg("seed", plan.seed));
    if (both)
        out = fmt::format(both_prose, fmt::arg("lobe", plural(plan.lobe_spp, "sample")),
            fmt::arg("disk", plural(plan.disk_spp, "sample")), fmt::arg("seed", plan.seed),
            fmt::arg("used", plan.kind == ReferenceKind::quadrature ? "quadrature" : "Monte Carlo reference"));
    if (!all.empty()) out += (both ? table_of_both(all) : table_of_one(all)) + not_good_enough(all);
    return {"reference", "The reference", out + below_the_reference(page.in) + plates};
}

}  // namespace crescent::inline report
