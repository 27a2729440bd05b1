// crescent film: an experiment -> its film. The door registers itself in the program that links it.
#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>

#include <thread>

#include "data.h"
#include "painter.h"
#include "shots.h"

namespace crescent::film {

namespace {

/// "1:30" or "90" -> 90.
double seconds_of(const std::string& text) {
    const std::size_t colon = text.find(':');
    if (colon == std::string::npos) return std::stod(text);
    return 60 * std::stod(text.substr(0, colon)) + std::stod(text.substr(colon + 1));
}

std::string write_stills(const Timeline& timeline, const FilmOptions& options) {
    Staging staging(options.out);
    Painter painter(timeline, options.height);
    std::string said;
    const auto write = [&](int frame, const std::string& name) {
        painter.draw(frame);
        staging.write(name, encode_png(painter.canvas().picture(), {}));
        said += options.out + "/" + name + "\n";
    };
    if (!options.still.empty()) {
        const int frame = static_cast<int>(seconds_of(options.still) * frames_a_second + 0.5);
        if (frame >= timeline.frames()) throw InputError({"--still"}, fmt::format("the film ends at {:.2f} s", double(timeline.frames()) / frames_a_second));
        write(frame, fmt::format("still-{:05}.png", frame));
    } else {
        for (std::size_t k = 0; k < timeline.shots().size(); ++k)
            if (options.shot == 0 || options.shot == int(k) + 1) write(timeline.still(k), fmt::format("stills/{:02}-{}.png", k + 1, timeline.shots()[k].name));
    }
    staging.commit();
    return said;
}

std::string make(const Experiment& experiment, const FilmOptions& options, Watch& watch) {
    const int threads = options.threads > 0 ? options.threads : static_cast<int>(std::thread::hardware_concurrency());
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
    RunOptions run;
    run.threads = options.threads, run.isa = options.isa, run.command = options.command;
    const Data data = collect(experiment, run, watch);
    const Timeline timeline(shots_of(data));
    return write_stills(timeline, options);
}

const bool registered = [] {
    film_maker() = make;
    return true;
}();

}  // namespace

}  // namespace crescent::film
