#include "run.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_group.h>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>

#include "base/files.h"
#include "base/machine.h"
#include "estimator/estimator.h"
#include "estimator/reference.h"
#include "experiment/names.h"
#include "films/exr.h"
#include "jobs.h"
#include "kept.h"
#include "meters/evidence_measure.h"
#include "meters/furnace.h"
#include "meters/meters.h"
#include "meters/quantity.h"
#include "needs.h"
#include "plates/plates.h"
#include "version.h"

namespace crescent {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// A run in the making: what is kept from one stage to the next.
class Run {
public:
    Run(const Experiment& experiment, const RunOptions& options, Watch& watch)
        : experiment_(experiment),
          options_(options),
          watch_(watch),
          isa_(kernels_for(options.isa).isa),
          instrument_(options.instrument ? options.instrument : cpu_instrument(isa_)),
          threads_(options.threads > 0 ? options.threads : usable_threads()),
          limit_(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads_)),
          scene_(experiment) {}

    Measured in_memory() {
        look();
        compute(std::numeric_limits<double>::infinity());
        judge_assertions();
        auto& references = experiment_.reference.kind == ReferenceKind::quadrature ? quadrature_ : note_;
        return {std::move(metrics_), std::move(evidence_), std::move(provenance_), std::move(shapes_),
            std::move(films_), std::move(references)};
    }

    RunResult operator()() {
        const auto start = Clock::now();
        look();
        Staging staging(options_.out);
        compute(options_.keep_after_s);
        stage("plates and films on disk", [&] { draw_and_write(staging); });
        judge_assertions();
        stage("report", [&] { report(staging); });
        timing_.total_s = seconds_since(start);
        finish_timing();
        staging.write("timing.json", timing_json(timing_, provenance_));
        watch_.check();
        staging.commit(watch_);
        kept_->forget();
        return {metrics_, timing_, provenance_, terminal_summary(inputs(), timing_, options_.out, false)};
    }

private:
    /// Everything that is measured.
    void compute(double keep_after_s) {
        const auto start = Clock::now();
        kept_.emplace(experiment_, instrument_->name(), options_.out, keep_after_s, watch_);
        stage("references", [&] { references(); });
        stage("films", [&] { films(); });
        timing_.estimating_s = seconds_since(start);
        stage("tails", [&] { tails(); });
        stage("furnaces", [&] { metrics_.furnaces = furnaces(experiment_, published(), isa_, watch_); });
        stage("evidence", [&] { evidence_ = measure_evidence(experiment_, isa_, watch_); });
        stage("meters", [&] { summarise(); });
        provenance();
    }
    const Published* published() const { return experiment_.figures ? &*experiment_.figures : nullptr; }

    template <class Work> void stage(const char* name, Work&& work) {
        const auto start = Clock::now();
        work();
        watch_.check();
        timing_.stages.emplace_back(name, seconds_since(start));
    }

    void look() {
        check_needs(experiment_);
        scene_.remember_primaries();
        shapes_ = shape_map(scene_);
        std::vector<std::uint64_t> pixels(experiment_.shapes.size());
        for (const std::int16_t shape : shapes_.shape)
            if (shape >= 0) ++pixels[static_cast<std::size_t>(shape)];
        for (std::size_t k = 0; k < pixels.size(); ++k) {
            metrics_.shape_pixels[experiment_.shapes[k].name] = pixels[k];
            metrics_.geometry_pixels += pixels[k];
        }
        if (metrics_.geometry_pixels == 0)
            throw InputError(experiment_.place_of("camera"),
                "nothing is in view: every ray of the camera misses every shape; expected eye and target that face "
                "one");
    }

    void references() {
        std::vector<double> exponents;
        for (const Job& job : jobs_of(experiment_, experiment_.seed))
            if (std::find(exponents.begin(), exponents.end(), job.s) == exponents.end()) exponents.push_back(job.s);
        const auto pixels = static_cast<double>(shapes_.shape.size());
        watch_.begin("reference by quadrature", pixels);
        TileKeeper quadrature = kept_->tiles("quadrature"), note = kept_->tiles("note");
        quadrature_ = quadrature_reference(scene_, exponents, watch_, &quadrature);
        watch_.begin("the note's reference", pixels);
        note_ = note_reference(scene_, experiment_, exponents, isa_, watch_, &note);
    }

    static const ReferenceFilm* find(const std::vector<ReferenceFilm>& films, double s) {
        const auto film = std::ranges::find(films, s, &ReferenceFilm::s);
        return film == films.end() ? nullptr : &*film;
    }
    const ReferenceFilm& reference(double s) const {
        return *find(experiment_.reference.kind == ReferenceKind::quadrature ? quadrature_ : note_, s);
    }

    void films() {
        for (int k = 0; const std::uint32_t seed : seeds_of(experiment_)) {
            const std::vector<Job> jobs = jobs_of(experiment_, seed);
            double samples = 0;
            for (const Job& job : jobs)
                samples += static_cast<double>(job.n.back()) * static_cast<double>(metrics_.geometry_pixels);
            watch_.begin(fmt::format("seed {} of {}", ++k, experiment_.seeds), samples);
            for (const Job& job : jobs) run_job(job, k == 1);
        }
    }

    /// `films`: they are kept in memory, for the plates and for the disk; else their meters are all that is needed.
    void run_job(Job job, bool films) {
        const auto start = Clock::now();
        std::vector<RunMeter> meters = kept_->meters(job);
        TileKeeper keeper = kept_->tiles(job);
        double samples = 0;
        if (films || meters.empty()) {
            job.keeper = &keeper;
            std::vector<Film> made = instrument_->films(scene_.with_s(job.s), job, watch_);
            samples = static_cast<double>(metrics_.geometry_pixels * job.n.back()) - keeper.restored();
            if (meters.empty()) kept_->add(meters = meters_of(job, made));
            for (std::size_t r = 0; films && r < made.size(); ++r)
                films_.emplace_back(meters[r].key, std::move(made[r]));
        }
        if (!films) keeper.remove();
        timing_.arms.push_back(
            {job.arm->name, job.n.back(), job.s, static_cast<std::uint64_t>(samples), seconds_since(start)});
        metrics_.runs.insert(metrics_.runs.end(), meters.begin(), meters.end());
    }

    std::vector<RunMeter> meters_of(const Job& job, const std::vector<Film>& films) const {
        std::vector<RunMeter> out;
        for (const Film& film : films)
            out.push_back(
                measure(experiment_, {job.arm->name, film.n, job.s, job.seed}, film, reference(job.s), shapes_));
        return out;
    }

    /// The tail index of each region's samples at the published seed. It belongs to an arm and exponent, not to N, and
    /// stands beside every rung.
    void tails() {
        for (const Job& job : jobs_of(experiment_, experiment_.seed)) {
            const Scene scene = scene_.with_s(job.s);
            for (std::size_t r = 0; r < experiment_.regions.size(); ++r) {
                const std::optional<Tail> tail = region_tail(scene, job, experiment_.regions[r].box, isa_, watch_);
                for (RunMeter& run : metrics_.runs)
                    if (run.key.seed == job.seed && run.key.arm == job.arm->name && run.key.s == job.s)
                        run.regions[r].tail = tail;
            }
        }
    }

    void summarise() {
        metrics_.bands = bands(experiment_, metrics_.runs, published());
        metrics_.published_seed = published() ? published()->seed : std::nullopt;
        metrics_.ladders = ladders(experiment_, metrics_.runs);
        for (const auto& [key, film] : films_) metrics_.film_hashes[to_string(key)] = hash(film);
        for (const ReferenceFilm& film : quadrature_)
            metrics_.film_hashes[fmt::format("quadrature s={}", film.s)] = hash(film);
        for (const ReferenceFilm& film : note_)
            metrics_.film_hashes[fmt::format("note reference s={}", film.s)] = hash(film);
        for (const ReferenceFilm& q : quadrature_)
            for (const Region& region : experiment_.regions)
                metrics_.references.push_back(
                    compare(q, *find(note_, q.s), region, films_, experiment_.reference.kind));
    }

    void provenance() {
        provenance_ = provenance_of(experiment_, *instrument_,
            options_.command.empty() ? "crescent run " + experiment_.file : options_.command);
    }

    Attributes attributes() const {
        return {{"crescent", provenance_.version + " " + provenance_.commit}, {"compiler", provenance_.compiler},
            {"experiment", provenance_.experiment_file + " " + provenance_.experiment_hash},
            {"command", provenance_.command}, {"instrument", provenance_.instrument},
            {"seed", std::to_string(experiment_.seed)}};
    }

    void draw_and_write(Staging& staging) {
        std::vector<std::vector<unsigned char>> bytes(experiment_.plates.size());
        tbb::task_group group;
        group.run([&] { write_films(staging); });
        tbb::parallel_for(std::size_t{0}, experiment_.plates.size(), [&](std::size_t k) {
            watch_.check();
            bytes[k] = draw(experiment_.plates[k]);
        });
        group.wait();
        for (std::size_t k = 0; k < bytes.size(); ++k) {
            staging.write("plates/" + experiment_.plates[k].name + ".png", bytes[k]);
            plates_[experiment_.plates[k].name] = std::move(bytes[k]);
        }
    }

    std::vector<unsigned char> draw(const PlatePlan& plan) const {
        const PlateInputs in{experiment_, metrics_, shapes_,
            [this](const RunKey& key) -> const Film* {
                const auto film = std::ranges::find(films_, key, &std::pair<RunKey, Film>::first);
                return film == films_.end() ? nullptr : &film->second;
            },
            [this](double s) {
                return find(experiment_.reference.kind == ReferenceKind::quadrature ? quadrature_ : note_, s);
            },
            instrument_->name()};
        Attributes text = attributes();
        text.emplace_back("plate", plan.name);
        return encode_png(draw_plate(plan, in), text);
    }

    /// One file an arm and exponent, rungs as parts; and the two references.
    void write_films(Staging& staging) {
        std::vector<std::pair<std::string, std::vector<std::pair<std::string, const Film*>>>> files;
        for (const auto& [key, film] : films_) {
            const std::string name = film_file(key.arm, key.s, experiment_.s());
            if (files.empty() || files.back().first != name) files.push_back({name, {}});
            files.back().second.emplace_back(fmt::format("n={}", key.n), &film);
        }
        for (const auto& [name, parts] : files) {
            write_exr(staging.path("films/" + name + ".exr"), parts, attributes());
            watch_.check();
        }
        std::vector<std::pair<std::string, const ReferenceFilm*>> parts;
        for (const ReferenceFilm& film : quadrature_) parts.emplace_back(fmt::format("quadrature s={}", film.s), &film);
        for (const ReferenceFilm& film : note_) parts.emplace_back(fmt::format("note s={}", film.s), &film);
        write_exr(staging.path(fmt::format("films/{}.exr", reference_file)), parts, attributes());
    }

    void judge_assertions() {
        std::map<std::string, std::size_t> plate_bytes;
        for (const auto& [name, bytes] : plates_) plate_bytes[name] = bytes.size();
        metrics_.assertions = judge(experiment_, metrics_, plate_bytes);
        for (AssertionResult& a : instrument_->assertions()) metrics_.assertions.push_back(std::move(a));
    }

    ReportInputs inputs() const { return {experiment_, metrics_, evidence_, provenance_, plates_}; }

    void report(Staging& staging) {
        staging.write("metrics.json", metrics_json(inputs()));
        staging.write("metrics.csv", metrics_csv(inputs()));
        staging.write("junit.xml", junit_xml(inputs()));
        staging.write("report.html", report_html(inputs()));
    }

    void finish_timing() {
        timing_.threads = threads_;
        timing_.isa = isa_;
        timing_.date = fmt::format("{:%FT%TZ}", fmt::gmtime(std::time(nullptr)));
        timing_.host_cpu = host_cpu();
    }

    const Experiment& experiment_;
    const RunOptions& options_;
    Watch& watch_;
    std::string isa_;
    std::shared_ptr<Instrument> instrument_;
    int threads_;
    tbb::global_control limit_;
    Scene scene_;
    ShapeMap shapes_;
    std::vector<ReferenceFilm> quadrature_, note_;
    std::vector<std::pair<RunKey, Film>> films_;
    Metrics metrics_;
    Evidence evidence_;
    Timing timing_;
    Provenance provenance_;
    std::optional<Kept> kept_;
    std::map<std::string, std::vector<unsigned char>> plates_;
};

}  // namespace

RunResult run(const Experiment& experiment, const RunOptions& options, Watch& watch) {
    const Experiment whole = with_figures(experiment);
    return Run(whole, options, watch)();
}

Measured measure_in_memory(const Experiment& experiment, const RunOptions& options, Watch& watch) {
    const Experiment whole = with_figures(experiment);
    return Run(whole, options, watch).in_memory();
}

}  // namespace crescent
