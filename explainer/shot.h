// A shot as a value: what it is called, how long it lasts, what is said when, and how it looks at a time.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "frame.h"

namespace crescent::film {

/// A caption, from `at` (s from the shot's beginning) to the next one's beginning. After a question nothing is said for
/// 4 s.
struct Cue {
    double at = 0;
    Words words;  // at most two lines of 42 characters
    bool question = false;
};

/// What a shot shows, said at its top: photographs have gone through the display chain, instruments read the float
/// films.
enum class Kind { words, photograph, instrument };

struct Shot {
    std::string name;  // "columns": of its still, and of its chapter in messages
    Words title;       // of the chapter; stands at the top of the frame
    Kind kind = Kind::words;
    Words seen;  // what is seen, for the transcript
    double seconds = 0;
    double still = 0;  // the time of its still: everything there, nothing moving
    std::vector<Cue> cues;
    std::function<void(Frame&)> draw;
};

}  // namespace crescent::film
