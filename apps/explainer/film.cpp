// crescent film: makes the video of an experiment. It registers itself in the program that links it.
#include <fmt/format.h>
#include <oneapi/tbb/info.h>

#include <algorithm>
#include <thread>

#include "captions.h"
#include "data.h"
#include "encoder.h"
#include "shots.h"

namespace crescent::explainer {

namespace {

/// Converts "1:30" or "90" to frames.
int frame_of(const std::string& text) {
    const std::size_t colon = text.find(':');
    const double seconds = colon == std::string::npos
        ? std::stod(text)
        : 60 * std::stod(text.substr(0, colon)) + std::stod(text.substr(colon + 1));
    return static_cast<int>(seconds * frames_a_second + 0.5);
}

std::string clock(int frames) {
    return fmt::format("{}:{:02}", frames / frames_a_second / 60, frames / frames_a_second % 60);
}

[[noreturn]] void outside(const std::string& flag, const Timeline& timeline) {
    throw InputError({flag},
        fmt::format("outside the film, which lasts {} ({} shots)", clock(timeline.frames()), timeline.shots().size()));
}

Part part_of(const Timeline& timeline, const ExplainerOptions& o) {
    Part part{0, timeline.frames()};
    if (o.shot > static_cast<int>(timeline.shots().size())) outside("--shot", timeline);
    if (o.shot > 0) part = {timeline.begin(std::size_t(o.shot) - 1), timeline.begin(std::size_t(o.shot))};
    if (!o.from.empty()) part.first = std::max(part.first, frame_of(o.from));
    if (!o.to.empty()) part.last = std::min(part.last, frame_of(o.to));
    if (part.first >= part.last) outside(o.from.empty() ? "--to" : "--from", timeline);
    return part;
}

std::vector<std::pair<std::string, std::string>> attributes_of(const Data& data) {
    return {{"crescent", data.provenance.version + " " + data.provenance.commit},
        {"experiment", data.provenance.experiment_file + " " + data.experiment_hash},
        {"command", data.provenance.command}};
}

/// A video in production.
class VideoWriter {
public:
    VideoWriter(const Data& data, const Timeline& timeline, const ExplainerOptions& options, Staging& staging,
        ProgressMonitor& monitor)
        : data_(data),
          timeline_(timeline),
          options_(options),
          staging_(staging),
          monitor_(monitor),
          painter_(timeline, options.height) {}

    std::string one_still() {
        const int frame = frame_of(options_.still);
        if (frame >= timeline_.frames()) outside("--still", timeline_);
        return still(frame, fmt::format("still-{:05}.png", frame));
    }

    std::string stills(const Part& part) {
        std::string texts;
        for (std::size_t k = 0; k < timeline_.shots().size(); ++k) {
            const int frame = timeline_.still(k);
            if (frame >= part.first && frame < part.last)
                texts += still(frame, fmt::format("stills/{:02}-{}.png", k + 1, timeline_.shots()[k].name));
        }
        return texts;
    }

    std::string film(const Part& part) {
        const Stopwatch start;
        stills(part);
        staging_.write("crescent.vtt", webvtt(timeline_, part));
        staging_.write("crescent.srt", subrip(timeline_, part));
        staging_.write("crescent.txt", transcript(timeline_, part));
        const std::vector<std::uint64_t> hashes = encode(part);
        staging_.write("frames.json", frames_json(part, hashes));
        std::vector<std::uint64_t> unlike = hashes;
        std::ranges::sort(unlike);
        const auto distinct = std::ranges::distance(unlike.begin(), std::ranges::unique(unlike).begin());
        return fmt::format(
            "{}\n  {} long, {} frames, {} of them different, drawn and encoded in {:.0f} s\n  captions crescent.vtt, "
            "crescent.srt; transcript "
            "crescent.txt; stills/; frames.json\n",
            options_.out + "/crescent.mp4", clock(part.last - part.first), hashes.size(), distinct, start.seconds());
    }

private:
    std::string still(int frame, const std::string& name) {
        painter_.draw(frame);
        staging_.write(name, encode_png(painter_.canvas().picture(), attributes_of(data_)));
        return options_.out + "/" + name + "\n";
    }

    std::vector<std::uint64_t> encode(const Part& part) {
        EncoderInputs in;
        in.width = options_.height * 16 / 9;
        in.height = options_.height;
        in.captions = staging_.path("crescent.srt");
        in.mp4 = staging_.path("crescent.mp4");
        in.chapters = scratch("chapters.txt", chapters(timeline_, part, data_.experiment.title));
        painter_.draw(std::clamp(timeline_.still(0), part.first, part.last - 1));
        const std::vector<unsigned char> png = encode_png(painter_.canvas().picture(), attributes_of(data_));
        in.poster = scratch("poster.png", std::string(png.begin(), png.end()));
        in.log = scratch("ffmpeg.log", "");

        std::vector<std::uint64_t> hashes;
        monitor_.begin(fmt::format("{} frames", part.last - part.first), part.last - part.first);
        Encoder encoder(in);
        for_each_frame(timeline_, options_.height, part.first, part.last, monitor_, [&](const Raster& raster) {
            encoder.take(raster, monitor_);
            hashes.push_back(raster.hash);
        });
        monitor_.begin("ffmpeg ends the file", 1);
        encoder.finish(monitor_);
        return hashes;
    }

    std::string frames_json(const Part& part, const std::vector<std::uint64_t>& hashes) const {
        std::string text = fmt::format(
            "{{\n  \"experiment\": \"{}\",\n  \"width\": {},\n  \"height\": {},\n  \"frames_a_second\": {},\n  "
            "\"first\": {},\n",
            data_.experiment_hash, options_.height * 16 / 9, options_.height, frames_a_second, part.first);
        text += "  \"hash\": \"XXH3-64 of the frame, rows of R, G, B of 8 bits\",\n  \"shots\": [";
        for (std::size_t k = 0; k < timeline_.shots().size(); ++k)
            text += fmt::format("{}\n    {{\"name\": \"{}\", \"first\": {}}}", k > 0 ? "," : "",
                timeline_.shots()[k].name, timeline_.begin(k));
        text += "\n  ],\n  \"frames\": [";
        for (std::size_t k = 0; k < hashes.size(); ++k)
            text += fmt::format("{}\n    \"{:016x}\"", k > 0 ? "," : "", hashes[k]);
        return text + "\n  ]\n}\n";
    }

    /// Returns a file that exists as long as the stage.
    std::string scratch(const std::string& name, const std::string& bytes) {
        const std::string path = staging_.scratch() + "/" + name;
        std::ofstream(path, std::ios::binary) << bytes;
        return path;
    }

    const Data& data_;
    const Timeline& timeline_;
    const ExplainerOptions& options_;
    Staging& staging_;
    ProgressMonitor& monitor_;
    Painter painter_;
};

std::string make(const Experiment& experiment, const ExplainerOptions& options, ProgressMonitor& monitor) {
    const bool makes_pictures = !options.still.empty() || options.stills;
    Experiment cast = experiment;
    cast_of(cast);  // missing roles are reported before the work
    Staging staging(options.out, makes_pictures ? "stills" : "film");
    const Canvas font(16, 16, plates::ground);
    if (!makes_pictures) require_ffmpeg(staging.scratch(), monitor);

    RunOptions run;
    run.out = options.out;
    run.threads = options.threads;
    run.isa = options.isa;
    run.command = options.command;
    run.timeout_s = options.timeout_s;
    Data data = collect(experiment, run, monitor);
    const Timeline timeline(shots_of(data));
    data.opening = {};  // the first shot has its pictures
    const Part part = part_of(timeline, options);
    VideoWriter writer(data, timeline, options, staging, monitor);
    const std::string texts = !options.still.empty() ? writer.one_still()
        : options.stills                             ? writer.stills(part)
                                                     : writer.film(part);
    staging.commit(monitor);
    return texts;
}

const bool registered = [] {
    film_maker() = [](const Experiment& experiment, const ExplainerOptions& options, ProgressMonitor& monitor) {
        const int requested = options.threads > 0 ? options.threads : usable_threads();
        const int threads = std::min(requested, oneapi::tbb::info::default_concurrency());
        return on_threads(threads, [&] { return make(experiment, options, monitor); });
    };
    return true;
}();

}  // namespace

}  // namespace crescent::explainer
