// Tests for tests/system/extending.sh of an addition made by the steps of docs/extending.md.
//   extending SAMPLER BRDF    that the sampler, on a ball with that lobe, has the reference's mean, that no verdict on
//                             it is unexpected, and that both have a description
//   extending --scene TOML    that with these tables added to the scene arms have the reference's mean
//   extending --measured METRIC PLATE
//                             that an assertion can name the metric, that metrics.json and metrics.csv have it, that
//                             the plate is drawn, and that `check` gives every verdict of the list
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>

#include "check/check.h"
#include "check/report/print.h"
#include "check/report/result_json.h"
#include "check/sources/cases.h"
#include "check/verdict.h"
#include "metrics/assertions.h"
#include "metrics/metrics.h"
#include "output/formula.h"
#include "render/estimator.h"
#include "render/reference/reference.h"
#include "report/plates/plates.h"
#include "report/report.h"
#include "tests/support/scene_text.h"

using namespace crescent;

namespace {

/// A glossy ball over a floor under a disk light, with the arm `it` and these tables.
Experiment scene_with(const std::string& tables, const std::vector<std::string>& settings) {
    static const std::string lamp =
        "[disks.lamp]\ncenter = [-1.5, 2.5, 1]\nnormal = [0, -1, 0]\nradius = 0.8\nradiance = [4, 4, 4]\n"
        "[arms.it]\nn = 256\n[regions.all]\nbox = [0, 0, 31, 19]\n";
    std::vector<std::string> overrides{"seed=5", "image.width=32", "image.height=20", "camera.eye=[0,1,4]",
        "camera.target=[0,0.6,0]", "camera.vfov_deg=30", "fill.radiance=[0.5,0.6,0.7]", "shapes.ball.center=[0,0.6,0]",
        "shapes.ball.radius=0.6", "shapes.ball.rho_d=[0.3,0.2,0.1]", "shapes.ball.rho_s=0.3", "shapes.ball.s=12",
        "shapes.ball.alpha=0.4"};
    overrides.insert(overrides.end(), settings.begin(), settings.end());
    return parse(
        test::view_text + test::ball_text + test::floor_text + test::fill_text + lamp + tables, "extending", overrides);
}

bool has_the_references_mean(const std::string& sampler, const std::string& brdf, const std::string& added = "",
    const std::string& fill = "[0.5, 0.6, 0.7]") {
    const Experiment e = scene_with(
        added, {"fill.radiance=" + fill, "arms.it.sampler=\"" + sampler + "\"", "shapes.ball.brdf=\"" + brdf + "\""});
    const Scene scene(e);
    ProgressMonitor monitor;
    const Film film = estimate_films(scene, sampler, {256}, e.seed, "scalar", monitor)[0];
    const ReferenceFilm truth = quadrature_reference(scene, {e.s()}, monitor)[0];
    double off = 0, variance = 0, error = 0, all = 0;
    for (std::size_t at = 0; at < film.size(); ++at) {
        off += static_cast<double>(film.y[at]) - static_cast<double>(truth.y[at]);
        variance += static_cast<double>(film.var[at]);
        error += static_cast<double>(truth.error[at]);
        all += static_cast<double>(truth.y[at]);
    }
    std::printf("%s on %s: mean off by %.3g of %.4g, standard error %.2g, reference %.2g\n", sampler.c_str(),
        brdf.c_str(), off, all, std::sqrt(variance), error);
    return film.invalid == 0 && all > 0 && std::fabs(off) < 5 * std::sqrt(variance) + error;
}

bool is_checked_as_expected(const std::string& sampler, const Grid& wo = {}) {
    ProgressMonitor monitor;
    const CheckResult j = run_checks(make_cases(sampler, {}, false, wo), TestSettings::quick(), monitor);
    if (!j.as_expected) std::cout << verdict_table(j);
    return j.as_expected;
}

/// Tests the outputs of a film of cosine.
bool is_measured_and_drawn(const std::string& metric, const std::string& plate) {
    const Experiment e = scene_with("[plates.it]\nkind = \"" + plate +
            "\"\nruns = [{ arm = \"it\" }]\n[assertions.it]\ncheck = \"" + metric + ".all(it) > 0\"\n",
        {"arms.it.sampler=\"cosine\""});
    const Scene scene(e);
    ProgressMonitor monitor;
    const RunKey key{"it", 256, e.s(), e.seed};
    const Film film = estimate_films(scene, "cosine", {256}, e.seed, "scalar", monitor)[0];
    const ReferenceFilm truth = quadrature_reference(scene, {e.s()}, monitor)[0];
    const ShapeMap shapes = shape_map(scene);
    Metrics m;
    m.runs = {measure(e, key, film, truth, shapes)};
    m.bands = bands(e, m.runs, nullptr);
    m.assertions = evaluate_assertions(e, m, {}, false);
    const Picture drawn = draw_plate(
        e.plates[0], {e, m, shapes, [&](const RunKey&) { return &film; }, [&](double) { return &truth; }, "CPU"});
    const std::string json = metrics_json({e, m, {}, {}, {}}), csv = metrics_csv({e, m, {}, {}, {}});
    std::printf("%s.all = %.6g\n", metric.c_str(), m.assertions[0].measured);
    return m.all_hold() && !drawn.rgb.empty() && json.find('"' + metric + "\": ") != std::string::npos &&
        json.find('"' + metric + ".all\"") != std::string::npos &&
        csv.find("," + metric + ",all,") != std::string::npos;
}

bool has_every_verdict() {
    ProgressMonitor monitor;
    const CheckResult j = run_checks(make_cases("cosine", {}, false, {{45, 0}}), TestSettings::quick(), monitor);
    const std::string table = verdict_table(j), json = verdict_json(j, {});
    return j.as_expected && std::ranges::all_of(verdict_names, [&](std::string_view name) {
        const bool describe = table.find(" " + std::string(name)) != std::string::npos &&
            json.find("\"name\": \"" + std::string(name) + '"') != std::string::npos;
        if (!describe) std::printf("nothing of %s in\n%s", std::string(name).c_str(), table.c_str());
        return describe;
    });
}

}  // namespace

int main(int argc, char** argv) try {
    if (argc == 4 && std::string(argv[1]) == "--measured")
        return is_measured_and_drawn(argv[2], argv[3]) && has_every_verdict() ? 0 : 1;
    if (argc != 3) return 2;
    if (std::string(argv[1]) == "--scene")
        return has_the_references_mean("cosine", "phong", argv[2]) &&
                has_the_references_mean("mis-balance", "ggx", argv[2]) &&
                has_the_references_mean("light-area", "phong", argv[2], "[0, 0, 0]") &&
                has_the_references_mean("light-solid-angle", "phong", argv[2], "[0, 0, 0]") &&
                is_checked_as_expected("light-area", {{45, 0}}) &&
                is_checked_as_expected("light-solid-angle", {{45, 0}})
            ? 0
            : 1;
    const SamplerInfo* arm = find_arm_info(argv[1]);
    const LobeInfo& lobe = lobe_info(lobe_named(argv[2]));
    if (!arm) return 2;
    std::cout << arm->label << ": " << arm->summary << ", " << formula::pango(arm->formula) << '\n'
              << lobe.label << ": " << lobe.summary << ", " << formula::pango(lobe.formula) << '\n';
    return has_the_references_mean(argv[1], argv[2]) && is_checked_as_expected(argv[1]) ? 0 : 1;
} catch (const std::exception& e) {
    std::cerr << e.what() << '\n';
    return 1;
}
