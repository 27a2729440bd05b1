// Further experiments (one command each), the limits of this run, its assertions and its provenance.
#include <algorithm>
#include <fmt/format.h>

#include "base/text.h"
#include "experiment/queries.h"
#include "report/wording.h"
#include "samplers/info.h"
#include "scene/lobes/lobe.h"

namespace crescent::inline report {
namespace {

using html::words;

/// Returns a command line that runs the same experiment with some keys changed.
std::string with(const Page& page, const std::vector<std::string>& settings) {
    std::string out = "crescent run " + shell_word(page.in.provenance.experiment_file);
    for (const std::string& setting : settings) out += " --set " + shell_word(setting);
    return out;
}

/// Returns the shape of the exponent control, else the first with a lobe.
const Shape* glossy(const Experiment& e) {
    for (const Shape& shape : e.shapes)
        if (e.exponent && shape.name == e.exponent->shape && shape.material.rho_s > 0) return &shape;
    for (const Shape& shape : e.shapes)
        if (shape.material.rho_s > 0) return &shape;
    return nullptr;
}

std::string box_text(const Box& b) { return fmt::format("[{}, {}, {}, {}]", b.x0, b.y0, b.x1, b.y1); }

Box shifted(const Experiment& e, Box b) {
    const int by = std::max(1, b.width() / 2);
    const int shift = b.x1 + by < e.image.width ? by : -std::min(by, b.x0);
    return {b.x0 + shift, b.y0, b.x1 + shift, b.y1};
}

std::string ladder_text(const ArmPlan& arm) {
    std::string out;
    for (const std::uint64_t n : arm.n) out += std::to_string(n) + ", ";
    return "[" + out + std::to_string(arm.n.back() * 4) + "]";
}

struct Row {
    std::string question, command, expect;
};

void light_rows(const Page& page, std::vector<Row>& rows) {
    const Experiment& e = page.in.experiment;
    const std::vector<LightTable> lights = all_lights(e);
    if (lights.empty()) return;
    if (const auto larger = widened(lights.front(), 4), smaller = widened(lights.front(), 0.25); !larger.empty()) {
        rows.push_back(
            {"A larger light?", with(page, larger), "Broad densities meet it more often; the fireflies thin out."});
        rows.push_back({"A smaller one?", with(page, smaller),
            "Every arm that does not aim at lights misses it; in the limit none can find it."});
    }
    std::vector<std::string> furnace{"fill.radiance=[1, 1, 1]"};
    for (const LightTable& table : lights) furnace.push_back(table.path + ".radiance=[1, 1, 1]");
    rows.push_back({"The whole scene as a white furnace?", with(page, furnace),
        "Each surface shows its albedo; what departs is the arm’s."});
}

/// Returns the --set value that multiplies the number that shapes a lobe, its exponent or its roughness; "" if the
/// shape has no such number, or if the product is not valid in a file.
std::string lobe_setting(const Shape& shape, double of_s, double of_alpha) {
    const bool by_alpha = lobe_info(shape.material.brdf).parameter == LobeParameter::alpha;
    const std::optional<double> now = by_alpha ? shape.material.alpha : shape.material.s;
    if (!now) return {};
    const double then = *now * (by_alpha ? of_alpha : of_s);
    if (then > (by_alpha ? 1 : 1e6)) return {};
    return fmt::format("shapes.{}.{}={}", shape.name, by_alpha ? "alpha" : "s", shortest(then));
}

void material_rows(const Page& page, std::vector<Row>& rows) {
    const Shape* shape = glossy(page.in.experiment);
    if (!shape) return;
    rows.push_back({"A metal instead?", with(page, {fmt::format("shapes.{}.rho_d=[0, 0, 0]", shape->name)}),
        "It has no diffuse part, so Failure B does not show on it."});
    if (const auto wide = lobe_setting(*shape, 0.25, 2); !wide.empty())
        rows.push_back({"More samples under the horizon?", with(page, {wide}),
            "A wider lobe reaches under the surface more often; those samples weigh nothing and count."});
    if (const auto sharp = lobe_setting(*shape, 2, 0.5); !sharp.empty())
        rows.push_back({"A sharper lobe?", with(page, {sharp}), "Better where the lobe is, worse everywhere else."});
}

void sampling_rows(const Page& page, std::vector<Row>& rows) {
    const Experiment& e = page.in.experiment;
    rows.push_back({"Another seed?", with(page, {fmt::format("seed={}", e.seed + 1)}),
        "Rankings that change with the seed are within the noise."});
    rows.push_back(
        {"A stricter or laxer firefly?", with(page, {fmt::format("firefly_k={}", shortest(2 * e.firefly_k))}),
            "Counts fall as k rises; the order of the arms should not."});
    if (!e.arms.empty() && !e.arms.back().n.empty())
        rows.push_back(
            {"More samples?", with(page, {fmt::format("arms.{}.n={}", e.arms.back().name, ladder_text(e.arms.back()))}),
                "One more rung; the lower ones keep their bits."});
    if (!e.regions.empty())
        rows.push_back({"Another region?",
            with(page,
                {fmt::format(
                    "regions.{}.box={}", e.regions.front().name, box_text(shifted(e, e.regions.front().box)))}),
            "Films stay as they are; only what is read off them changes."});
}

/// Returns whether an arm aims only at the lights or combines several densities.
bool remedies(const Experiment& e) {
    return std::any_of(e.arms.begin(), e.arms.end(), [](const ArmPlan& arm) {
        const SamplerInfo* info = find_arm_info(arm.sampler);
        return info && (info->combines || !info->misses.empty());
    });
}

std::string claims(const Page& page) {
    const Experiment& e = page.in.experiment;
    std::vector<std::string> can{
        "For this scene, these arms, these seeds and this <i>N</i>, the figures above are what the float films hold. "
        "The films can be made again, bit for bit: their hashes stand at the end.",
        "Arms differ in their density alone: same directions of view, same light, same random numbers."};
    if (e.seeds > 1) {
        const double chance = chance_of_parted_bands(e.seeds);
        can.push_back(fmt::format("Bands span {} seeds. Those of two equal arms lie apart in {} of all such runs.",
            e.seeds, chance > 1e-3 ? percent(chance, 2) : "less than 0.1 %"));
    }
    std::vector<std::string> cannot{
        "One bounce, a camera without lens and without antialiasing, BRDFs without Fresnel. It is a bench, not a "
        "renderer.",
        "Arms are compared at equal <i>N</i>." + ray_words(e) +
            " Nothing here says which is faster, or which belongs in production.",
        "Photographs are tone-mapped and cut off at white. Read no error off them."};
    if (const std::string bias = bias_words(e); !bias.empty()) cannot.push_back(bias.substr(1));
    if (!remedies(e))
        cannot.push_back(
            "No arm aims at the lights and none is combined with another; how well either remedy works is not asked.");
    if (e.seeds < 2) cannot.push_back("A single seed ran. There are no bands, so no arm is ranked above another.");
    else if (e.seeds < 20)
        cannot.push_back(
            fmt::format("With {} seeds the ends of a 5–95 % band rest on the outermost one or two draws.", e.seeds));
    const auto& bands = page.in.metrics.bands;
    const auto heavy = std::count_if(bands.begin(), bands.end(), [](const SeedSpread& b) { return b.band.heavy; });
    if (heavy > 0)
        cannot.push_back(
            fmt::format("{} of {} meters have no interval, because the tail of their samples is too heavy for one. "
                        "More seeds would not mend it.",
                heavy, bands.size()));
    if (page.find.anything_published())
        cannot.push_back(
            "The geometry was fitted to published figures, which do not fix it. It is a scene that fits them, not the "
            "one they were made with.");
    return "<h3>It can claim</h3>\n" + html::list(can) + "<h3>It cannot claim</h3>\n" + html::list(cannot);
}

std::string seeds_text(const std::vector<std::uint32_t>& seeds) {
    std::string out;
    for (const std::uint32_t seed : seeds) out += (out.empty() ? "" : ", ") + std::to_string(seed);
    return out;
}

std::string result_of(const AssertionResult& a) {
    if (!a.skipped.empty()) return "skipped: " + escape(a.skipped);
    if (a.failed()) return "<b class=\"bad\">FAILED</b>";
    return a.cannot_fail ? "holds<small>whatever the run measures</small>" : "holds";
}

}  // namespace

PageSection more_plates(Page& page) {
    const std::string rest = page.figures.rest();
    return rest.empty() ? PageSection{} : PageSection{"plates", "More plates", rest};
}

PageSection what_ifs(Page& page) {
    std::vector<Row> rows;
    sampling_rows(page, rows);
    material_rows(page, rows);
    light_rows(page, rows);
    std::string items;
    for (const Row& row : rows)
        items += html::element("dt", row.question) +
            html::element("dd", html::command(row.command) + html::p(row.expect)) + "\n";
    return {"what-ifs", "What if",
        html::p("Each question is one line. An override is checked like the file itself, and the experiment’s hash "
                "changes with it. Assertions were written for the experiment as it stands and may well fail here.") +
            "<dl class=\"what-if\">\n" + items + "</dl>\n"};
}

PageSection limits(Page& page) { return {"limits", "Limits", claims(page)}; }

PageSection assertions(Page& page) {
    const auto& all = page.in.metrics.assertions;
    if (all.empty()) return {};
    const auto failed = std::count_if(all.begin(), all.end(), [](const AssertionResult& a) { return a.failed(); });
    html::Table table(
        fmt::format("{} assertions, {}", all.size(), failed == 0 ? "all hold" : std::to_string(failed) + " failed"),
        {words("Assertion"), {"Measured", true}, words(""), {"Bound", true}, words("Result")});
    for (const AssertionResult& a : all)
        table.row({html::heading(
                       escape(a.name) + (a.text.empty() ? "" : "<small><code>" + escape(a.text) + "</code></small>")),
            html::figure(compact(a.measured)), words(escape(a.op)), html::figure(compact(a.bound)),
            words(result_of(a))});
    return {"assertions", "Assertions", table.str()};
}

PageSection provenance(Page& page) {
    const Provenance& p = page.in.provenance;
    html::Table table(
        "Where this run came from. What varies between equal runs (date, seconds, threads, instruction set) is in "
        "timing.json",
        {words("What"), words("Value")});
    const auto add = [&](const char* what, const std::string& value) {
        table.row({html::heading(what), words(value)});
    };
    add("Experiment", html::code(p.experiment_file) + ", hash " + html::code(p.experiment_hash));
    add("Command", html::code(p.command));
    add("crescent", escape(p.version) + ", commit " + html::code(p.commit));
    add("Compiler", escape(p.compiler));
    add("Instrument", escape(p.backend));
    for (const auto& [what, message] : p.backend_details)
        table.row({html::heading(escape(what)), words(escape(message))});
    add("Seeds", seeds_text(p.seeds));
    if (const std::vector<int> missing = p.missing(); !missing.empty())
        add("A part of the series", fmt::format("seeds {} of {}", ranges_text(p.places), p.series));
    html::Table films("Hashes (XXH3-64) of the float films at the first seed; equal films have equal hashes",
        {words("Film"), words("Hash")});
    for (const auto& [name, hash] : page.in.metrics.film_hashes)
        films.row({html::heading(escape(name)), words(html::code(hash))});
    return {"provenance", "Provenance", table.str() + (films.empty() ? "" : films.str())};
}

}  // namespace crescent::inline report
