// The shots of the video in their order; one file each under shots/.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "data.h"
#include "frame.h"

namespace crescent::explainer {

// ---- A shot as a value: its name, its duration, its captions, and its drawing at a time.

/// A caption, from `start` (s from the shot's beginning) to the next one's beginning. A question is followed by 4 s
/// without words.
struct Cue {
    double start = 0;
    Words words;  // at most two lines of 42 characters
    bool question = false;
};

/// The label of a shot: photographs are tone mapped, `backend` shots show the float films.
enum class Kind { words, photograph, backend };

struct Shot {
    std::string name;  // "columns": of its still, and of its chapter in messages
    Words title;       // of the chapter; shown at the top of the frame
    Kind kind = Kind::words;
    Words description;  // what is seen, for the transcript
    double seconds = 0;
    double still = 0;  // the time of its still: everything visible, nothing moving
    std::vector<Cue> cues;
    std::function<void(Frame&)> draw;
};

Shot title(const Data& data);
Shot columns(const Data& data);
Shot one_pixel(const Data& data);
Shot same_randoms(const Data& data);
Shot firefly(const Data& data);
Shot ladder_cosine(const Data& data);
Shot ladder_phong(const Data& data);
Shot heat(const Data& data);
Shot failure_b(const Data& data);
Shot heavy_tail(const Data& data);
Shot tilt(const Data& data);
Shot exponent(const Data& data);
Shot seeds(const Data& data);
Shot beyond(const Data& data);
Shot claims(const Data& data);
Shot closing(const Data& data);

/// Returns all shots, ready to be drawn; a shot with nothing to show in this run lasts 0 s and is omitted.
std::vector<Shot> shots_of(const Data& data);

}  // namespace crescent::explainer
