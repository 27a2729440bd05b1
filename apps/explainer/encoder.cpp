// One call of ffmpeg turns one pipe of RGB frames into an MP4 (H.264 in Y'CbCr 4:2:0 of ITU-R BT.709, limited range,
// poster, mov_text), with its bitexact flags. Its encoders are read from `ffmpeg -encoders`.
#include "encoder.h"

#include <fmt/format.h>

#include <cerrno>
#include <filesystem>

namespace crescent::explainer {

namespace {

using Arguments = std::vector<std::string>;

void append(Arguments& to, const Arguments& additions) { to.insert(to.end(), additions.begin(), additions.end()); }

const Arguments colour = {
    "-color_range", "tv", "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709"};

/// Inputs in this order: frames, captions, chapters, poster.
Arguments arguments(const EncoderInputs& in) {
    Arguments a = {"ffmpeg", "-hide_banner", "-nostdin", "-loglevel", "error", "-y"};
    append(a,
        {"-f", "rawvideo", "-pix_fmt", "rgb24", "-video_size", fmt::format("{}x{}", in.width, in.height), "-framerate",
            std::to_string(frames_a_second)});
    append(a,
        {"-thread_queue_size", "8", "-i", "pipe:0", "-f", "srt", "-i", in.captions, "-f", "ffmetadata", "-i",
            in.chapters, "-i", in.poster});
    append(a, {"-map", "0:v", "-map", "3:v", "-map", "1:s"});
    // The words are in the picture too: the track is off by default.
    append(a,
        {"-map_metadata", "2", "-map_chapters", "2", "-c:s", "mov_text", "-metadata:s:s:0", "language=eng",
            "-disposition:s:0", "0"});
    append(a,
        {"-filter:v:0",
            "scale=out_color_matrix=bt709:out_range=tv:flags=bicubic+accurate_rnd+full_chroma_inp+bitexact"});
    append(a,
        {"-c:v:0", "libx264", "-preset", "medium", "-crf", "18", "-profile:v:0", "high", "-pix_fmt:v:0", "yuv420p",
            "-g", "300", "-threads:v:0", "2"});
    append(a, {"-x264-params", "chromaloc=0:rc-lookahead=20"});
    append(a, colour);
    append(a, {"-c:v:1", "mjpeg", "-q:v:1", "3", "-pix_fmt:v:1", "yuvj420p", "-disposition:v:1", "attached_pic"});
    append(a, {"-fflags", "+bitexact", "-flags:v", "+bitexact", "-movflags", "+faststart", "-f", "mp4", in.mp4});
    return a;
}

bool has_word(const std::string& text, const std::string& word) {
    return text.find(" " + word + " ") != std::string::npos;
}

}  // namespace

void require_ffmpeg(const std::string& folder, const ProgressMonitor& monitor) {
    const std::string list = folder + "/encoders.txt";
    ProcessEnd end;
    try {
        end = Process({.argv = {"ffmpeg", "-hide_banner", "-encoders"},
                          .stdin_file = "/dev/null",
                          .stdout_file = list,
                          .stderr_file = "/dev/null"})
                  .wait(monitor);
    } catch (const OutputError&) {
        throw OutputError(
            "the film is encoded by ffmpeg, which this machine does not have: install the package ffmpeg");
    }
    if (!end.well()) throw OutputError("ffmpeg -encoders ended with " + end.text() + ": expected a working ffmpeg");
    const std::string encoders = contents_of(list);
    for (const char* encoder : {"libx264", "mov_text", "mjpeg"})
        if (!has_word(encoders, encoder))
            throw OutputError(fmt::format("this ffmpeg has no encoder '{}', which the film needs", encoder));
}

Encoder::Encoder(const EncoderInputs& in)
    : in_(in), process_({.argv = arguments(in), .stdout_file = "/dev/null", .stderr_file = in.log}) {}

void Encoder::fail(const std::string& what) {
    process_.end(1000);
    const std::string texts = contents_of(in_.log);
    throw OutputError(
        "ffmpeg could not encode the film: " + what + (texts.empty() ? "" : "; it printed: " + texts.substr(0, 600)));
}

void Encoder::take(const Raster& raster, const ProgressMonitor& monitor) {
    std::string_view bytes(reinterpret_cast<const char*>(raster.bytes.data()), raster.bytes.size());
    while (!bytes.empty()) {
        const ssize_t n = process_.write(bytes);
        if (n > 0) bytes.remove_prefix(static_cast<std::size_t>(n));
        else if (n < 0 && errno != EAGAIN && errno != EINTR) {
            const std::optional<ProcessEnd> end = process_.ended(1000);
            fail(end ? "it ended with " + end->text() : "it closed its input");
        } else {
            monitor.check();
            process_.wait_ready(true, false, 50);
        }
    }
}

void Encoder::finish(const ProgressMonitor& monitor) {
    if (const ProcessEnd end = process_.wait(monitor); !end.well()) fail("it ended with " + end.text());
    std::error_code error;
    if (const auto size = std::filesystem::file_size(in_.mp4, error); error || size == 0)
        fail(fmt::format("it ended with exit code 0, and {} is {}", std::filesystem::path(in_.mp4).filename().string(),
            error ? "not there" : "empty"));
}

}  // namespace crescent::explainer
