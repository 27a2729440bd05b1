// A caption needs its characters over the reading speed, and a question also its silence. If its slot is too short, the
// shot is held, in whole frames, half a frame before the slot's end. A line is broken at the space that leaves the
// longer part shortest.
#include "timeline.h"

#include <algorithm>
#include <cmath>

namespace crescent::explainer {

namespace {

double whole_frames(double seconds) { return std::ceil(seconds * frames_a_second - 1e-6) / frames_a_second; }

/// Returns the minimum duration of a caption.
double needed(const Cue& cue) {
    return double(length(cue.words.plain())) / reading_speed + (cue.question ? question_silence : 0);
}

std::vector<std::size_t> spaces_of(const std::string& text) {
    std::vector<std::size_t> positions;
    std::size_t character = 0;
    for (const char c : text) {
        if (c == ' ') positions.push_back(character);
        character += (c & 0xc0) != 0x80;
    }
    return positions;
}

}  // namespace

std::size_t length(const std::string& text) {
    return static_cast<std::size_t>(std::ranges::count_if(text, [](char c) { return (c & 0xc0) != 0x80; }));
}

Words broken(const Words& words) {
    const std::string plain = words.plain();
    const std::size_t total = length(plain);
    if (total <= line_length) return words;
    const std::vector<std::size_t> spaces = spaces_of(plain);
    const auto longer_part = [total](std::size_t space) { return std::max(space, total - space - 1); };
    const auto best = std::ranges::min_element(spaces, {}, longer_part);
    if (best == spaces.end()) return words;
    // The same count over the markup: tags have no length.
    Words out;
    std::size_t character = 0;
    for (const Words::Part& part : words.parts()) {
        std::string text;
        bool in_tag = false, in_entity = false;
        for (const char c : part.markup) {
            if (c == '<') in_tag = true;
            const bool counts = !in_tag && !in_entity && (c & 0xc0) != 0x80;
            if (!in_tag && c == '&') in_entity = true;
            text += counts && c == ' ' && character == *best ? '\n' : c;
            character += counts;
            if (c == '>') in_tag = false;
            if (c == ';') in_entity = false;
        }
        out << Number{text, part.source};
    }
    return out;
}

Timeline::Timeline(std::vector<Shot> shots) : shots_(std::move(shots)), holds_(shots_.size()) {
    begins_.push_back(0);
    for (std::size_t k = 0; k < shots_.size(); ++k) place(k);
}

void Timeline::place(std::size_t shot) {
    const Shot& s = shots_[shot];
    const double start = double(begins_.back()) / frames_a_second;
    double pause = 0;
    for (std::size_t k = 0; k < s.cues.size(); ++k) {
        const double end = k + 1 < s.cues.size() ? s.cues[k + 1].start : s.seconds;
        ensure(end > s.cues[k].start, "captions follow each other within their shot");
        const double extension = whole_frames(std::max(0.0, needed(s.cues[k]) - (end - s.cues[k].start)));
        const double from = start + s.cues[k].start + pause;
        if (extension > 0) holds_[shot].push_back({end - 0.5 / frames_a_second, extension});
        pause += extension;
        captions_.push_back({from, start + end + pause, shot, k, broken(s.cues[k].words), s.cues[k].question});
    }
    begins_.push_back(
        begins_.back() + static_cast<int>(std::lround(whole_frames(s.seconds + pause) * frames_a_second)));
}

Timeline::Place Timeline::at(int frame) const {
    const auto next_begin = std::ranges::upper_bound(begins_, frame);
    const auto shot = static_cast<std::size_t>(next_begin - begins_.begin()) - 1;
    ensure(shot < shots_.size(), "a frame lies within the film");
    double t = double(frame - begins_[shot]) / frames_a_second, pause = 0;
    for (const Hold& hold : holds_[shot]) {
        if (t - pause <= hold.time) break;
        if (t - pause <= hold.time + hold.seconds) return {shot, hold.time};
        pause += hold.seconds;
    }
    return {shot, t - pause};
}

int Timeline::still(std::size_t shot) const {
    for (int frame = begins_[shot]; frame < begins_[shot + 1]; ++frame)
        if (at(frame).t >= shots_[shot].still) return frame;
    return begins_[shot + 1] - 1;
}

}  // namespace crescent::explainer
