// One call of ffmpeg turns one pipe of yuv420p frames into an MP4 (H.264, poster, mov_text, AAC) and, where it is asked
// for, a WebM (VP9, WebVTT, Opus), with its bitexact flags. What it can encode is read off `ffmpeg -encoders`.
#include "encoder.h"

#include <fmt/format.h>

namespace crescent::film {

namespace {

using Arguments = std::vector<std::string>;

void append(Arguments& to, const Arguments& more) { to.insert(to.end(), more.begin(), more.end()); }

// Colour as rasters.cpp makes it.
const Arguments colour = {
    "-color_range", "tv", "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709"};

/// Inputs in this order: frames, captions, chapters, poster, voice.
Arguments arguments(const Ingredients& in) {
    Arguments a = {"ffmpeg", "-hide_banner", "-nostdin", "-loglevel", "error", "-y"};
    append(a,
        {"-f", "rawvideo", "-pix_fmt", "yuv420p", "-video_size", fmt::format("{}x{}", in.width, in.height),
            "-framerate", std::to_string(frames_a_second)});
    append(a, colour);
    append(a,
        {"-thread_queue_size", "8", "-i", "pipe:0", "-f", "srt", "-i", in.captions, "-f", "ffmetadata", "-i",
            in.chapters, "-i", in.poster});
    if (!in.voice.empty()) append(a, {"-i", in.voice});

    append(a, {"-map", "0:v", "-map", "3:v", "-map", "1:s"});
    if (!in.voice.empty()) append(a, {"-map", "4:a", "-c:a", "aac", "-b:a", "128k"});
    // The words stand in the picture too: the track is there for those who ask for it, and off for all others.
    append(a,
        {"-map_metadata", "2", "-map_chapters", "2", "-c:s", "mov_text", "-metadata:s:s:0", "language=eng",
            "-disposition:s:0", "0"});
    append(a,
        {"-c:v:0", "libx264", "-preset", "medium", "-crf", "18", "-profile:v:0", "high", "-pix_fmt:v:0", "yuv420p",
            "-g", "300", "-threads:v:0", "2"});
    append(a, {"-x264-params", "chromaloc=0:rc-lookahead=20"});
    append(a, colour);
    append(a, {"-c:v:1", "mjpeg", "-q:v:1", "3", "-pix_fmt:v:1", "yuvj420p", "-disposition:v:1", "attached_pic"});
    append(a,
        {"-fflags", "+bitexact", "-flags:v", "+bitexact", "-flags:a", "+bitexact", "-movflags", "+faststart", "-f",
            "mp4", in.mp4});
    if (in.webm.empty()) return a;

    append(a, {"-map", "0:v", "-map", "1:s"});
    if (!in.voice.empty()) append(a, {"-map", "4:a", "-c:a", "libopus", "-b:a", "96k"});
    append(a,
        {"-map_metadata", "2", "-map_chapters", "2", "-c:s", "webvtt", "-disposition:s:0", "0", "-c:v", "libvpx-vp9",
            "-crf", "30", "-b:v", "0"});
    append(a, {"-deadline", "good", "-cpu-used", "5", "-row-mt", "1", "-threads", "2", "-pix_fmt", "yuv420p"});
    append(a, colour);
    append(a, {"-fflags", "+bitexact", "-flags:v", "+bitexact", "-flags:a", "+bitexact", "-f", "webm", in.webm});
    return a;
}

bool has_word(const std::string& text, const std::string& word) {
    return text.find(" " + word + " ") != std::string::npos;
}

}  // namespace

void require_ffmpeg(bool webm, bool voice, const std::string& folder, const ProgressMonitor& monitor) {
    const std::string list = folder + "/encoders.txt";
    int code = 0;
    try {
        code = Process({"ffmpeg", "-hide_banner", "-encoders"}, "/dev/null", list, "").wait(monitor);
    } catch (const OutputError&) {
        throw OutputError(
            "the film is encoded by ffmpeg, which this machine does not have: install the package ffmpeg");
    }
    if (code != 0) throw OutputError(fmt::format("ffmpeg -encoders ended with {}: expected a working ffmpeg", code));
    std::vector<std::string> needed = {"libx264", "mov_text", "mjpeg"};
    if (voice) needed.push_back("aac");
    if (webm) append(needed, {"libvpx-vp9", "webvtt"});
    if (webm && voice) needed.push_back("libopus");
    const std::string encoders = contents_of(list);
    for (const std::string& encoder : needed)
        if (!has_word(encoders, encoder))
            throw OutputError("this ffmpeg has no encoder '" + encoder + "', which the film needs");
}

Encoder::Encoder(const Ingredients& in) : log_(in.log), process_(arguments(in), "", "", in.log) {}

void Encoder::fail() const {
    const std::string said = contents_of(log_);
    throw OutputError("ffmpeg could not encode the film" + (said.empty() ? "" : "; it said: " + said.substr(0, 600)));
}

void Encoder::take(const Raster& raster) {
    if (!process_.write(raster.bytes.data(), raster.bytes.size())) fail();
}

void Encoder::finish(const ProgressMonitor& monitor) {
    if (process_.wait(monitor) != 0) fail();
}

}  // namespace crescent::film
