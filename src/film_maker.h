// What makes an explainer film of an experiment. explainer/ registers itself here when the program starts; the library
// does not depend on it.
#pragma once

#include <functional>
#include <string>

#include "base/progress_monitor.h"
#include "experiment/experiment.h"

namespace crescent {

/// What of the film is made, and how.
struct FilmOptions {
    std::string out = "out/film";
    int height = 1080;     // of 16:9 frames
    int threads = 0;       // 0: as many as this process may use
    int shot = 0;          // 1 ..: that shot alone; 0: all
    std::string still;     // "MM:SS" or "SS": this frame alone, as a PNG
    bool stills = false;   // one PNG a shot and nothing else
    std::string from, to;  // "MM:SS": this part alone; "": beginning, end
    std::string voice;     // a command: text on stdin, WAV on stdout; "": silent
    std::string isa;       // "": the best this machine has
    std::string command;   // as typed, for the last shot
    bool webm = false;
    double timeout_s = 0;  // for one answer of a program or plugin; 0: 10 and 60 s
};

/// Makes the film and publishes it under options.out as one; returns a summary for the terminal.
using FilmMaker = std::function<std::string(const Experiment&, const FilmOptions&, ProgressMonitor&)>;

/// Empty: this program was built without it.
FilmMaker& film_maker();

}  // namespace crescent
