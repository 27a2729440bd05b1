// An experiment with noise for films, for the tests of plates.
#pragma once

#include <algorithm>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "report/plates/sheet.h"

namespace crescent::plates {

/// Returns whether these words are anywhere on the sheet.
inline bool has(const std::vector<Setting>& settings, const std::string& words) {
    return std::ranges::any_of(settings, [&](const Setting& s) { return s.text.find(words) != std::string::npos; });
}

struct World {
    Experiment e;
    Metrics metrics;
    ShapeMap shapes;
    std::map<std::string, Film> films;
    ReferenceFilm reference;
    std::string backend = "CPU";

    World(int w, int h) : reference(w, h, 32) {
        e.title = "test";
        e.seed = 7;
        e.image = {w, h};
        Shape sphere;
        sphere.material.rho_s = 0.12;
        sphere.material.s = 32;
        sphere.material.rho_d = {0.1, 0.1, 0.1};
        e.shapes = {sphere};
        e.regions = {{"H", {w / 2, h / 2, w / 2 + w / 8, h / 2 + h / 8}, {}}, {"S", {w / 8, h / 8, w / 2, h / 2}, {}}};
        reference.y.assign(reference.size(), 0.2f);
        for (const char* arm : {"uniform", "cosine", "phong"}) add_arm(arm, arm);
        for (const ArmPlan& a : e.arms) {
            for (const Region& r : e.regions)
                metrics.ladders.push_back({a.name, r.name, 32, a.n, {2, 1}, -0.5, -0.6, -0.4, false});
        }
    }

    void add_arm(const std::string& name, const std::string& sampler) {
        e.arms.push_back({name, sampler, {4, 64}, {}});
        for (std::uint64_t n : {4, 64}) add_film(name, n);
    }

    void add_film(const std::string& arm, std::uint64_t n) {
        Film f(e.image.width, e.image.height, n);
        std::mt19937 random(unsigned(n) + 31 * unsigned(arm.size()));
        for (std::size_t i = 0; i < f.size(); ++i) {
            f.r[i] = f.g[i] = f.b[i] = f.y[i] = 0.2f + 0.3f * float(random()) / float(random.max());
        }
        RunMetrics m;
        m.key = {arm, n, 32, e.seed};
        for (const Region& r : e.regions) m.regions.push_back({r.name, 1.234, 0.5, 10, {}});
        m.fireflies = 12345;
        metrics.runs.push_back(m);
        for (const char* metric : {"rmse.H", "rmse.S", "fireflies", "var.H", "horizon_frac", "y_mean"}) {
            metrics.bands.push_back({m.key, metric, 1.2, {1.1, 1.2, 1.3, 16, false}, 1.25, 0.4});
        }
        films[to_string(m.key)] = std::move(f);
    }

    PlatePlan plan(PlateKind kind, std::size_t runs) const {
        PlatePlan p;
        p.name = "plate";
        p.kind = kind;
        p.caption =
            "A caption that stands alone under the picture, long enough to need a second line of the sheet, so "
            "that wrapping is seen to work and nothing runs off.";
        for (std::size_t i = 0; i < runs; ++i) p.runs.push_back({e.arms[i % e.arms.size()].name, i % 2 ? 4u : 64u, 0});
        return p;
    }

    PlateInputs inputs() const {
        return {e, metrics, shapes,
            [this](const RunKey& k) -> const Film* {
                auto at = films.find(to_string(k));
                return at == films.end() ? nullptr : &at->second;
            },
            [this](double s) { return s == 32 ? &reference : nullptr; }, backend};
    }

    std::vector<Setting> settings(const PlatePlan& p) const {
        PlateInputs in = inputs();
        Sheet sheet(p, in);
        draw(sheet);
        return sheet.canvas.settings();
    }
};

}  // namespace crescent::plates
