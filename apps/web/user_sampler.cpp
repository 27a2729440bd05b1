// The user's functions are called for many rows at once: u and w_o in, w_i and the pdf out, in the local frame, n = +z,
// in double precision. `context` is what the third argument of the functions has: s, alpha, rho_d (3), rho_s, then the
// number of lights and 18 numbers for each, as samplers/surface_context.h orders them.
#include "user_sampler.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "disk.h"
#include "user_points.h"

extern "C" {

/// Provided by the page. `count` runs of `stride` doubles: w_o, the number of rows, the context.
__attribute__((import_module("api"), import_name("user_sample"))) void api_user_sample(const double* runs,
    std::size_t count, std::size_t stride, const double* u, std::size_t numbers, double* wi, double* pdf);
/// Provided by the page. `count` rows of w_o and w_i.
__attribute__((import_module("api"), import_name("user_pdf"))) void api_user_pdf(
    const double* pairs, std::size_t count, const double* context, std::size_t columns, double* pdf);
}

namespace crescent::web {

namespace {

std::size_t numbers_of_sample = 2;
bool takes_context = false;
int bits_of_answers = 53;

const std::vector<std::string> all_of_context = {"s", "alpha", "rho_d", "rho_s", "lights"};

/// In a run it is asked at the points of a scene, in a check on one surface under one light, where a direction below
/// the horizon counts as nothing drawn.
class PageSampler : public BatchSampler {
public:
    explicit PageSampler(const CaseSetup& setup = {}) : surface_(setup.surface) {
        for (const CaseDiskLight& disk : setup.light.disks) {
            lights_.push_back({"disk", {disk.radiance, disk.radiance, disk.radiance}, disk.radius});
            lights_at_.push_back({disk.center, disk.normal, {}, {}, dot(disk.normal, disk.center) < 0});
        }
    }
    SamplerDeclaration declaration() const override {
        SamplerDeclaration out{.name = "your sampler", .has_f = true, .has_drawn_f = true, .serial = true};
        out.traits.numbers = static_cast<int>(numbers_of_sample);
        out.traits.bits = bits_of_answers;
        if (takes_context) out.uses = all_of_context;
        return out;  // not limited: the limit is an exception, which the module does not have
    }

private:
    SurfaceSetup surface_;
    std::vector<SceneLight> lights_;
    std::vector<LightAtPoint> lights_at_;

    /// The one run of a check.
    SurfaceRun run_of_check(Vec3d wo, std::size_t rows) const {
        const double rho_d = surface_.rho_d;
        return {wo, {surface_.s, surface_.alpha, rho_d, surface_.rho_s}, rows, {rho_d, rho_d, rho_d}};
    }
    /// Calls work(scene) with the points of a run, or with the one point of a check.
    template <class Work> void at_points(const SamplerQuery& query, const Work& work) const {
        if (query.scene) return work(*query.scene);
        const SurfaceRun run = run_of_check(query.wo, query.rows());
        work(SceneRows{.runs = {&run, 1}, .lights = lights_, .lights_at = lights_at_});
    }

    void draw_rows(const SamplerQuery& query, std::span<Draw> out) const override {
        const std::size_t rows = out.size();
        std::vector<double> runs, room, wi(3 * rows), pdf(rows);
        const std::span<const double> u = query.u.packed(numbers_of_sample, room);
        at_points(query, [&](const SceneRows& scene) {
            for (std::size_t k = 0; k < scene.runs.size(); ++k) {
                const SurfaceRun& run = scene.runs[k];
                runs.insert(runs.end(), {run.wo.x, run.wo.y, run.wo.z, static_cast<double>(run.rows)});
                if (takes_context) add_context(all_of_context, run, scene.lights, scene.lights_of_run(k), runs);
            }
            api_user_sample(runs.data(), scene.runs.size(), runs.size() / scene.runs.size(), u.data(),
                numbers_of_sample, wi.data(), pdf.data());
        });
        for (std::size_t i = 0; i < rows; ++i) {
            const bool draws_nothing = pdf[i] == 0 || (!query.scene && wi[3 * i + 2] <= 0 && pdf[i] >= 0);
            out[i] = draws_nothing ? Draw{{0, 0, 1}, 0} : Draw{{wi[3 * i], wi[3 * i + 1], wi[3 * i + 2]}, pdf[i]};
        }
    }
    /// The page's function has one context for all rows, and is called once a run.
    void pdf_rows(const SamplerQuery& query, std::span<double> out) const override {
        std::size_t first = 0;
        at_points(query, [&](const SceneRows& scene) {
            for (std::size_t k = 0; k < scene.runs.size(); ++k) {
                std::vector<double> context, pairs;
                if (takes_context)
                    add_context(all_of_context, scene.runs[k], scene.lights, scene.lights_of_run(k), context);
                const std::span<const Pair> of_run = query.pairs.subspan(first, scene.runs[k].rows);
                for (const Pair& p : of_run)
                    if (p.wi.z > 0) pairs.insert(pairs.end(), {p.wo.x, p.wo.y, p.wo.z, p.wi.x, p.wi.y, p.wi.z});
                const std::size_t pair_count = pairs.size() / 6;
                std::vector<double> values(pair_count);
                if (pair_count > 0)
                    api_user_pdf(pairs.data(), pair_count, context.data(), context.size(), values.data());
                std::size_t position = 0;
                for (std::size_t i = 0; i < of_run.size(); ++i)
                    out[first + i] = of_run[i].wi.z > 0 ? values[position++] : 0;
                first += of_run.size();
            }
        });
    }
    void f_rows(const SamplerQuery& query, std::span<double> out) const override {
        for (std::size_t i = 0; i < out.size(); ++i)
            out[i] = brdf_value(surface_, query.pairs[i].wo, query.pairs[i].wi);
    }
};

/// {surface: {lobe: a word or "", lambert, sharpness}, light}.
CaseSetup setup_of(const ordered_json& query) {
    const ordered_json& surface = query.at("surface");
    const std::string lobe = surface.at("lobe").get<std::string>();
    return case_setup(lobe.empty() ? LobeKind::none : lobe_named(lobe), surface.at("lambert").get<bool>(),
        query.at("light").get<std::string>(), surface.at("sharpness").get<double>());
}

/// {sampler: "" for that of the page, or a built-in one} at each w_o, [theta, azimuth] in degrees. A sampler of points
/// has one case.
std::vector<CheckCase> cases_of(const ordered_json& query) {
    if (const auto points = page_point_sampler()) return make_user_cases(points, false);
    const CaseSetup setup = setup_of(query);
    const std::string built_in = query.value("sampler", "");
    std::vector<CheckCase> out;
    for (const ordered_json& angles : query.at("wo")) {
        const double theta = angles.at(0).get<double>(), azimuth = angles.at(1).get<double>();
        out.push_back(make_case_on(
            setup, theta, azimuth, built_in.empty() ? "your sampler" : built_in, std::make_shared<PageSampler>(setup)));
        if (!built_in.empty()) out.back().adapter = sampler_on(built_in, out.back());
    }
    return out;
}

/// How much a verdict's state matters; of several w_o the first is shown.
int rank(State state) {
    switch (state) {
        case State::error: return 4;
        case State::wrong: return 3;
        case State::inconclusive: return 2;
        case State::right: return 1;
        case State::skipped: return 0;
    }
    return 0;
}

Disk disk_of(const CheckCase& check_case) { return Disk({-check_case.wo.x, -check_case.wo.y, check_case.wo.z}); }

/// The first n draws of a case.
std::vector<Draw> draws_of(const CheckCase& check_case, std::size_t n) {
    const std::uint32_t seed = seed_of(TestSettings::quick().seed, 0);
    std::vector<PrimarySample> u(n);
    for (std::size_t k = 0; k < n; ++k) u[k] = drawn_numbers(seed, 0, k, 0, PrimarySample::most_numbers);
    std::vector<Draw> draws(n);
    check_case.adapter->sample(0, check_case.wo, u, draws);
    return draws;
}

}  // namespace

std::shared_ptr<const SamplerAdapter> page_sampler() {
    static const auto sampler = std::make_shared<const PageSampler>();
    return sampler;
}

/// What the user's functions take: so many random numbers a sample, and the context as third argument or not; and the
/// precision of their answers, 24 or 53 bits.
CRESCENT_EXPORT(user_takes)(int numbers, int context, int bits)->void {
    numbers_of_sample = static_cast<std::size_t>(std::clamp(numbers, 1, PrimarySample::most_numbers));
    takes_context = context != 0;
    bits_of_answers = bits;
}

/// {sampler, surface, light, wo, evaluations} -> {state, verdicts: [{name, question, state, message, cause, theta,
/// azimuth, found: [faults in words], evidence, states: [of each w_o]}]}: of each verdict the worst of all w_o.
CRESCENT_EXPORT(user_checked)()->void {
    const ordered_json query = request();
    const std::vector<CheckCase> cases = cases_of(query);
    ProgressMonitor monitor;
    TestSettings settings = TestSettings::quick();
    settings.budget = check::CheckBudget::limited(query.at("evaluations").get<double>());
    const CheckResult result = run_checks(cases, settings, monitor);
    ordered_json out = {{"state", ""}, {"evaluations", result.evaluations}, {"verdicts", ordered_json::array()}};
    State state = State::right;
    for (std::size_t k = 0; k < verdict_names.size(); ++k) {
        if (verdict_names[k] == "efficiency") continue;  // depends on a clock
        const Verdict* worst = nullptr;
        ordered_json states = ordered_json::array();
        for (const Verdict& v : result.verdicts) {
            if (v.name != verdict_names[k]) continue;
            states.push_back(word(v.state));
            if (!worst || rank(v.state) > rank(worst->state) || (v.state == worst->state && v.size > worst->size))
                worst = &v;
        }
        if (!worst) continue;
        if (rank(worst->state) > rank(state)) state = worst->state;
        ordered_json entry = {{"name", worst->name}, {"question", verdict_questions[k]}, {"state", word(worst->state)},
            {"message", worst->message()}, {"cause", worst->cause}, {"states", states}, {"evidence", worst->evidence},
            {"found", check::found_faults(worst->hidden)}};
        const auto angles = worst->wo.value_or(std::pair(cases[0].theta_deg, cases[0].azimuth_deg));
        entry["theta"] = angles.first;
        entry["azimuth"] = angles.second;
        out["verdicts"].push_back(std::move(entry));
    }
    out["state"] = word(state);
    respond(out);
}

/// {sampler, surface, light, wo: [one], n} -> {case, draws: [[x, y, the root of its share of the largest weight]],
/// below: how many drew nothing or fell below the horizon, seconds: of those draws}.
CRESCENT_EXPORT(user_drawn)()->void {
    const ordered_json query = request();
    const CheckCase check_case = cases_of(query).front();
    const std::vector<Draw> draws = draws_of(check_case, query.at("n").get<std::size_t>());
    const Disk disk = disk_of(check_case);
    std::vector<double> weight;
    for (const Draw& d : draws) {
        const Pair pair{check_case.wo, d.wi};
        double f = 0;
        if (d.pdf > 0) check_case.adapter->f({&pair, 1}, {&f, 1});
        weight.push_back(d.pdf > 0 && d.wi.z > 0 ? f * check_case.light(d.wi) * d.wi.z / d.pdf : 0);
    }
    const double largest = weight.empty() ? 0 : *std::ranges::max_element(weight);
    ordered_json out = {{"case", check_case.text()}, {"draws", ordered_json::array()}};
    std::size_t lower_count = 0;
    for (std::size_t k = 0; k < draws.size(); ++k) {
        if (!(draws[k].pdf > 0 && draws[k].wi.z > 0)) {
            ++lower_count;
            continue;
        }
        ordered_json point = disk.place(draws[k].wi);
        point.push_back(largest > 0 && std::isfinite(weight[k]) ? std::sqrt(weight[k] / largest) : 0);
        out["draws"].push_back(std::move(point));
    }
    out["below"] = lower_count;
    respond(out);
}

/// {sampler, surface, light, wo: [one], what, size} -> a picture for disk(). what: "pdf", the density; "f", f L cos;
/// "lost", f L cos where the density is 0; "ratio", how many of 2^17 draws fell into each bin, over how many the
/// density implies.
CRESCENT_EXPORT(user_disk)()->void {
    const ordered_json query = request();
    const CheckCase check_case = cases_of(query).front();
    const std::string what = query.at("what").get<std::string>();
    const int size = query.at("size").get<int>();
    const Disk disk = disk_of(check_case);
    const auto pdf = [&](const std::vector<Vec3d>& wi) {  // in one call: a graphics processor takes as long for one
        std::vector<Pair> pairs;
        for (const Vec3d w : wi) pairs.push_back({check_case.wo, w});
        std::vector<double> p(wi.size());
        check_case.adapter->exact_pdf(0, pairs, p);
        return p;
    };
    const auto f = [&](Vec3d wi) {
        const Pair pair{check_case.wo, wi};
        double value = 0;
        check_case.adapter->f({&pair, 1}, {&value, 1});
        return value * check_case.light(wi) * wi.z;
    };
    if (what == "ratio") {
        constexpr int bins = 24;
        constexpr std::size_t n = std::size_t{1} << 17;
        std::vector<double> counts(bins * bins), due(bins * bins);
        const auto bin = [](double x) { return std::clamp(static_cast<int>((x + 1) / 2 * bins), 0, bins - 1); };
        for (const Draw& d : draws_of(check_case, n)) {
            if (!(d.pdf > 0 && d.wi.z > 0)) continue;
            const ordered_json place = disk.place(d.wi);
            ++counts[static_cast<std::size_t>(bin(place[1].get<double>()) * bins + bin(place[0].get<double>()))];
        }
        constexpr int fine = 6;                                             // points of a bin, each way
        const double area = 2 * (2.0 / bins / fine) * (2.0 / bins / fine);  // sr; the disk's radius is 1
        std::vector<Vec3d> points;
        std::vector<std::size_t> bin_of;
        for (int j = 0; j < bins * fine; ++j)
            for (int i = 0; i < bins * fine; ++i)
                if (const auto wi =
                        disk.direction((2.0 * i + 1) / (bins * fine) - 1, (2.0 * j + 1) / (bins * fine) - 1)) {
                    points.push_back(*wi);
                    bin_of.push_back(static_cast<std::size_t>((j / fine) * bins + i / fine));
                }
        const std::vector<double> p = pdf(points);
        for (std::size_t k = 0; k < p.size(); ++k) due[bin_of[k]] += p[k] * area * static_cast<double>(n);
        return paint_ratio(disk, size, [&](double x, double y) {
            const auto k = static_cast<std::size_t>(bin(y) * bins + bin(x));
            return counts[k] + due[k] < 25 ? 1 : counts[k] / std::max(due[k], 1.0);  // too few to tell
        });
    }
    if (what == "f") return paint_disk(disk, size, f);
    std::vector<Vec3d> points;
    paint_disk(disk, size, [&](Vec3d wi) {
        points.push_back(wi);
        return 0.0;
    });
    const std::vector<double> p = pdf(points);
    std::size_t position = 0;
    paint_disk(disk, size, [&](Vec3d wi) {
        const double density = p[position++];
        if (what == "pdf") return density;
        return density > 0 ? 0 : f(wi);
    });
}

}  // namespace crescent::web
