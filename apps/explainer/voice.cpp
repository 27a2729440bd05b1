// Each text is spoken once by /bin/sh -c COMMAND and kept. RIFF chunks are read here; speech is resampled to 48 000
// samples/s by linear interpolation and added to the track 0.15 s after its caption begins.
#include "voice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "crescent/crescent.h"

namespace crescent::explainer {

namespace {

constexpr int track_rate = 48000;  // samples per second
constexpr double lead = 0.15;      // s between a caption and its first word

std::uint32_t little(const std::string& bytes, std::size_t at, int size) {
    std::uint32_t v = 0;
    for (int k = 0; k < size && at + std::size_t(k) < bytes.size(); ++k)
        v |= std::uint32_t(static_cast<unsigned char>(bytes[at + std::size_t(k)])) << (8 * k);
    return v;
}

void put(std::string& bytes, std::uint32_t v, int size) {
    for (int k = 0; k < size; ++k) bytes += static_cast<char>(v >> (8 * k) & 0xff);
}

std::vector<float> resampled(const std::vector<float>& from, int rate) {  // linear between samples
    if (rate == track_rate || from.empty()) return from;
    std::vector<float> to(from.size() * track_rate / std::size_t(rate));
    for (std::size_t i = 0; i < to.size(); ++i) {
        const double x = double(i) * rate / track_rate;
        const auto k = static_cast<std::size_t>(x);
        const double part = x - double(k);
        to[i] = static_cast<float>((1 - part) * from[k] + part * from[std::min(k + 1, from.size() - 1)]);
    }
    return to;
}

}  // namespace

std::vector<float> samples_of_wav(const std::string& bytes, int& rate) {
    if (bytes.size() < 12 || bytes.compare(0, 4, "RIFF") != 0 || bytes.compare(8, 4, "WAVE") != 0) return {};
    unsigned channels = 0, bits = 0, format = 0;
    for (std::size_t at = 12; at + 8 <= bytes.size();) {
        const std::string id = bytes.substr(at, 4);
        const std::size_t size = std::min<std::size_t>(little(bytes, at + 4, 4), bytes.size() - at - 8);
        if (id == "fmt ") {
            format = little(bytes, at + 8, 2), channels = little(bytes, at + 10, 2), bits = little(bytes, at + 22, 2);
            rate = static_cast<int>(little(bytes, at + 12, 4));
        } else if (id == "data") {
            if ((format != 1 && format != 0xfffe) || bits != 16 || channels == 0 || rate < 1000) return {};
            std::vector<float> out(size / (2 * channels));
            for (std::size_t i = 0; i < out.size(); ++i)
                for (unsigned c = 0; c < channels; ++c)
                    out[i] += float(static_cast<std::int16_t>(little(bytes, at + 8 + 2 * (i * channels + c), 2))) /
                        (32768.0f * float(channels));
            return out;
        }
        at += 8 + size + size % 2;
    }
    return {};
}

Voice::Voice(std::string command, std::string folder, ProgressMonitor& monitor)
    : command_(std::move(command)), folder_(std::move(folder)), monitor_(monitor) {}

const std::vector<float>& Voice::texts(const std::string& text) {
    const auto known = texts_.find(text);
    if (known != texts_.end()) return known->second;
    const std::string in = folder_ + "/voice.txt", out = folder_ + "/voice.wav", err = folder_ + "/voice.log";
    std::ofstream(in) << text << '\n';
    const ProcessEnd end =
        Process({.argv = {"/bin/sh", "-c", command_}, .stdin_file = in, .stdout_file = out, .stderr_file = err})
            .wait(monitor_);
    int rate = 0;
    const std::vector<float> samples = samples_of_wav(contents_of(out), rate);
    if (!end.well() || samples.empty()) {
        const std::string log = contents_of(err);
        throw OutputError(fmt::format(
            "--voice '{}' {}; expected a program that reads text on stdin and writes a 16-bit WAV to stdout{}",
            command_, end.well() ? "gave no WAV" : "ended with " + end.text(),
            log.empty() ? "" : "; it said: " + log.substr(0, 300)));
    }
    return texts_[text] = resampled(samples, rate);
}

double Voice::seconds(const Words& words) { return lead + double(texts(words.plain()).size()) / track_rate; }

std::string Voice::track(const Timeline& timeline, int first, int last) {
    const double start = double(first) / frames_a_second;
    std::vector<float> mix(std::size_t(last - first) * (track_rate / frames_a_second));
    for (const Caption& caption : timeline.captions()) {
        const std::vector<float>& speech = texts(timeline.shots()[caption.shot].cues[caption.cue].words.plain());
        const long at = std::lround((caption.from - start + lead) * track_rate);
        for (std::size_t i = 0; i < speech.size(); ++i) {
            const long to = at + long(i);
            if (to >= 0 && to < long(mix.size())) mix[std::size_t(to)] += speech[i];
        }
    }
    std::string wav = "RIFF";
    const auto size = static_cast<std::uint32_t>(2 * mix.size());
    put(wav, 36 + size, 4), wav += "WAVEfmt ", put(wav, 16, 4), put(wav, 1, 2), put(wav, 1, 2);
    put(wav, track_rate, 4), put(wav, 2 * track_rate, 4), put(wav, 2, 2), put(wav, 16, 2), wav += "data",
        put(wav, size, 4);
    for (const float v : mix)
        put(wav,
            static_cast<std::uint32_t>(static_cast<std::int16_t>(std::lround(32767 * std::clamp(v, -1.0f, 1.0f)))) &
                0xffff,
            2);
    return wav;
}

}  // namespace crescent::explainer
