// Runs the experiment once in memory with the arms that cast_of() adds, then the cosine arm at N = 1, 2, 4, ... up to
// the highest common sample count, then measures single pixels. Look-ups return each number with its source.
#include "data.h"

#include <fmt/format.h>

#include <algorithm>

#include "measures/measures.h"

namespace crescent::explainer {

namespace {

/// Returns the films of the cosine arm with 1, 2, 4, .. samples up to its highest count, which begin the video.
std::vector<Film> opening_of(
    const Experiment& experiment, const Cast& cast, const std::string& isa, ProgressMonitor& monitor) {
    std::vector<std::uint64_t> n;
    for (std::uint64_t k = 1; k <= cast.sample_counts.back(); k *= 2) n.push_back(k);
    monitor.begin("the opening", double(n.back()) * experiment.image.width * experiment.image.height);
    Scene scene(experiment);
    return estimate_films(scene, "cosine", n, cast.seed, isa, monitor);
}

}  // namespace

RunKey Data::key(const std::string& arm, std::uint64_t n, double s) const {
    return {arm, n > 0 ? n : cast.n, s > 0 ? s : cast.s, cast.seed};
}

const Film* Data::film(const RunKey& key) const {
    const auto match = std::ranges::find(films, key, &std::pair<RunKey, Film>::first);
    return match == films.end() ? nullptr : &match->second;
}

const ReferenceFilm& Data::reference(double s) const {
    const auto match = std::ranges::find(references, s > 0 ? s : cast.s, &ReferenceFilm::s);
    ensure(match != references.end(), "there is a reference for every exponent of the run");
    return *match;
}

const RunMetrics* Data::metric(const RunKey& key) const { return metrics.find(key.arm, key.n, key.s, key.seed); }

const RegionMetrics* Data::region(const RunKey& key, const std::string& region) const {
    const RunMetrics* run = metric(key);
    return run ? run->region(region) : nullptr;
}

const Box& Data::box(const std::string& region) const {
    const Region* match = experiment.find_region(region);
    ensure(match != nullptr, "the film uses regions of the experiment");
    return match->box;
}

Number Data::rmse(const RunKey& key, const std::string& name, int digits) const {
    const RegionMetrics* r = region(key, name);
    ensure(r != nullptr, "the film shows the error of existing runs");
    return figure(r->rmse, digits, "rmse." + name + " of " + to_string(key));
}

Number Data::n_of(const RunKey& key) const { return count(key.n, "n of " + to_string(key)); }
Number Data::s_of(const RunKey& key) const { return number(key.s, 4, "s of " + to_string(key)); }
Number Data::arm(const std::string& arm) const { return {plates::arm_name(arm, experiment), "name of an arm"}; }

plates::Colour Data::ink(const std::string& arm) const {
    const auto match = std::ranges::find(experiment.arms, arm, &ArmPlan::name);
    return plates::series[std::size_t(match - experiment.arms.begin()) % plates::series_count];
}

plates::Block photograph_of(const Data& data, const plates::View& view, const Box& box) {
    plates::Fit fit;
    fit.in_w = fit.out_w = box.width();
    fit.in_h = fit.out_h = box.height();
    return plates::photograph_block(view, box, fit, data.experiment.exposure);
}

Box around(const Data& data, const Box& box, int w, int h) {
    const Image& image = data.experiment.image;
    w = std::min(w, image.width);
    h = std::min(h, image.height);
    const int x0 = std::clamp((box.x0 + box.x1 + 1 - w) / 2, 0, image.width - w);
    const int y0 = std::clamp((box.y0 + box.y1 + 1 - h) / 2, 0, image.height - h);
    return {x0, y0, x0 + w - 1, y0 + h - 1};
}

Data collect(const Experiment& experiment, const RunOptions& options, ProgressMonitor& monitor) {
    Data data;
    data.experiment = experiment;
    data.experiment_hash = fmt::format("{:016x}", hash(experiment));
    data.cast = cast_of(data.experiment);
    data.experiment.note_evidence = true;  // two shots show it if it can be measured
    Measured result = measure_in_memory(data.experiment, options, monitor);
    data.metrics = std::move(result.metrics);
    data.evidence = std::move(result.evidence);
    data.provenance = std::move(result.provenance);
    data.shapes = std::move(result.shapes);
    data.films = std::move(result.films);
    const ReferenceKind kind = data.experiment.reference.kind;
    data.references = std::move(kind == ReferenceKind::quadrature ? result.quadrature
            : kind == ReferenceKind::paired                       ? result.paired
                                                                  : result.monte_carlo);
    data.opening = opening_of(data.experiment, data.cast, options.isa, monitor);
    data.measures = std::make_shared<const Measures>(take_measures(data, options.isa, monitor));
    return data;
}

}  // namespace crescent::explainer
