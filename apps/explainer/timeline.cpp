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

std::vector<std::size_t> spaces_of(const std::string& plain) {
    std::vector<std::size_t> at;
    std::size_t character = 0;
    for (const char c : plain) {
        if (c == ' ') at.push_back(character);
        character += (c & 0xc0) != 0x80;
    }
    return at;
}

}  // namespace

std::size_t length(const std::string& plain) {
    return static_cast<std::size_t>(std::ranges::count_if(plain, [](char c) { return (c & 0xc0) != 0x80; }));
}

Words broken(const Words& words) {
    const std::string plain = words.plain();
    const std::size_t all = length(plain);
    if (all <= line_length) return words;
    const std::vector<std::size_t> spaces = spaces_of(plain);
    const auto longer = [all](std::size_t at) { return std::max(at, all - at - 1); };
    const auto best = std::ranges::min_element(spaces, {}, longer);
    if (best == spaces.end()) return words;
    // The same count over the markup: tags have no length.
    Words out;
    std::size_t character = 0;
    for (const Words::Part& part : words.parts()) {
        std::string text;
        bool tag = false, entity = false;
        for (const char c : part.markup) {
            if (c == '<') tag = true;
            const bool counts = !tag && !entity && (c & 0xc0) != 0x80;
            if (!tag && c == '&') entity = true;
            text += counts && c == ' ' && character == *best ? '\n' : c;
            character += counts;
            if (c == '>') tag = false;
            if (c == ';') entity = false;
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
    double held = 0;
    for (std::size_t k = 0; k < s.cues.size(); ++k) {
        const double end = k + 1 < s.cues.size() ? s.cues[k + 1].at : s.seconds;
        ensure(end > s.cues[k].at, "captions follow each other within their shot");
        const double more = whole_frames(std::max(0.0, needed(s.cues[k]) - (end - s.cues[k].at)));
        const double from = start + s.cues[k].at + held;
        if (more > 0) holds_[shot].push_back({end - 0.5 / frames_a_second, more});
        held += more;
        captions_.push_back({from, start + end + held, shot, k, broken(s.cues[k].words), s.cues[k].question});
    }
    begins_.push_back(begins_.back() + static_cast<int>(std::lround(whole_frames(s.seconds + held) * frames_a_second)));
}

Timeline::Place Timeline::at(int frame) const {
    const auto next = std::ranges::upper_bound(begins_, frame);
    const auto shot = static_cast<std::size_t>(next - begins_.begin()) - 1;
    ensure(shot < shots_.size(), "a frame lies within the film");
    double t = double(frame - begins_[shot]) / frames_a_second, held = 0;
    for (const Hold& hold : holds_[shot]) {
        if (t - held <= hold.at) break;
        if (t - held <= hold.at + hold.seconds) return {shot, hold.at};
        held += hold.seconds;
    }
    return {shot, t - held};
}

int Timeline::still(std::size_t shot) const {
    for (int frame = begins_[shot]; frame < begins_[shot + 1]; ++frame)
        if (at(frame).t >= shots_[shot].still) return frame;
    return begins_[shot + 1] - 1;
}

}  // namespace crescent::explainer
