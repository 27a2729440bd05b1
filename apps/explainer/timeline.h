// The sequence of shots: the shot at a time of the video, and the times of each caption. If a caption needs more time
// than its slot has, to be read or thought about, the shot is held at the slot's end.
#pragma once

#include <vector>

#include "shots.h"

namespace crescent::explainer {

inline constexpr int frames_a_second = 30;
inline constexpr double reading_speed = 15;     // characters per second, at most
inline constexpr double question_silence = 4;   // s after every question
inline constexpr std::size_t line_length = 42;  // characters, two lines at most

/// A caption in the video's time.
struct Caption {
    double from = 0, to = 0;  // s
    std::size_t shot = 0, cue = 0;
    Words words;  // with its line break
    bool question = false;
};

class Timeline {
public:
    explicit Timeline(std::vector<Shot> shots);

    const std::vector<Shot>& shots() const { return shots_; }
    const std::vector<Caption>& captions() const { return captions_; }
    int frames() const { return begins_.back(); }
    /// Returns the first frame of a shot; for the index after the last, the number of frames.
    int begin(std::size_t shot) const { return begins_[shot]; }

    struct Place {
        std::size_t shot = 0;
        double t = 0;  // s from the shot's beginning, without its holds
    };
    Place at(int frame) const;
    /// Returns the frame of a shot's still.
    int still(std::size_t shot) const;

private:
    struct Hold {
        double time = 0, seconds = 0;  // shot time
    };
    void place(std::size_t shot);

    std::vector<Shot> shots_;
    std::vector<std::vector<Hold>> holds_;
    std::vector<int> begins_;
    std::vector<Caption> captions_;
};

/// Returns the words with one line break where the lines are most even; unchanged if one line holds them.
Words broken(const Words& words);
/// Returns the characters to read: code points of the plain text.
std::size_t length(const std::string& text);

}  // namespace crescent::explainer
