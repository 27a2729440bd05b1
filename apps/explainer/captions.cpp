// Captions are cut to the part and moved to its time; a caption with 0.05 s or less left is dropped. WebVTT is escaped
// as markup, SubRip is numbered, chapters are in ffmpeg's FFMETADATA1 with frames as time base.
#include "captions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace crescent::explainer {

namespace {

double start_of(const Part& part) { return double(part.first) / frames_a_second; }
double end_of(const Part& part) { return double(part.last) / frames_a_second; }

std::string stamp(double seconds, char point) {
    const long ms = std::lround(1000 * seconds);
    return fmt::format("{:02}:{:02}:{:02}{}{:03}", ms / 3600000, ms / 60000 % 60, ms / 1000 % 60, point, ms % 1000);
}

/// Returns the captions of a part, in its time.
std::vector<Caption> within(const Timeline& timeline, const Part& part) {
    std::vector<Caption> out;
    for (Caption c : timeline.captions()) {
        c.from = std::max(c.from, start_of(part)) - start_of(part);
        c.to = std::min(c.to, end_of(part)) - start_of(part);
        if (c.to - c.from > 0.05) out.push_back(std::move(c));
    }
    return out;
}

std::string entities(const std::string& text) { return plates::escaped(text); }

std::string in_ffmetadata(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (std::string_view("=;#\\\n").find(c) != std::string_view::npos) out += '\\';
        out += c;
    }
    return out;
}

std::string one_line(std::string text) { return std::ranges::replace(text, '\n', ' '), text; }

}  // namespace

std::string webvtt(const Timeline& timeline, const Part& part) {
    std::string text = "WEBVTT\n";
    for (const Caption& c : within(timeline, part))
        text += fmt::format("\n{} --> {}\n{}\n", stamp(c.from, '.'), stamp(c.to, '.'), entities(c.words.plain()));
    return text;
}

std::string subrip(const Timeline& timeline, const Part& part) {
    std::string text;
    int number = 0;
    for (const Caption& c : within(timeline, part)) {
        text += fmt::format("{}{}\n{} --> {}\n{}\n", number > 0 ? "\n" : "", number + 1, stamp(c.from, ','),
            stamp(c.to, ','), c.words.plain());
        ++number;
    }
    return text;
}

std::string transcript(const Timeline& timeline, const Part& part) {
    std::string text;
    const std::vector<Caption> captions = within(timeline, part);
    for (std::size_t k = 0; k < timeline.shots().size(); ++k) {
        if (timeline.begin(k + 1) <= part.first || timeline.begin(k) >= part.last) continue;
        const Shot& shot = timeline.shots()[k];
        const long start = std::lround(std::max(0.0, double(timeline.begin(k)) / frames_a_second - start_of(part)));
        text += fmt::format("{}{}:{:02}  {}\n\n", text.empty() ? "" : "\n", start / 60, start % 60, shot.title.plain());
        text += "[Seen: " + shot.description.plain() + "]\n\n";
        for (const Caption& c : captions)
            if (c.shot == k) text += one_line(c.words.plain()) + "\n";
    }
    return text;
}

std::string chapters(const Timeline& timeline, const Part& part, const std::string& title) {
    std::string text = ";FFMETADATA1\ntitle=" + in_ffmetadata(title) + "\n";
    for (std::size_t k = 0; k < timeline.shots().size(); ++k) {
        const int from = std::max(timeline.begin(k), part.first) - part.first,
                  to = std::min(timeline.begin(k + 1), part.last) - part.first;
        if (from >= to) continue;
        text += fmt::format("[CHAPTER]\nTIMEBASE=1/{}\nSTART={}\nEND={}\ntitle={}\n", frames_a_second, from, to,
            in_ffmetadata(timeline.shots()[k].title.plain()));
    }
    return text;
}

}  // namespace crescent::explainer
