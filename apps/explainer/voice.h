// Captions spoken by a program of the user: text on its stdin, a WAV (PCM, 16 bit) on its stdout.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "timeline.h"

namespace crescent::explainer {

class Voice {
public:
    /// `folder`: for the program's files.
    Voice(std::string command, std::string folder, ProgressMonitor& monitor);

    /// Returns the duration of the speech, s. OutputError if the program fails or returns no WAV.
    double seconds(const Words& words);
    /// Returns a WAV of the whole part: the speech of every caption from its beginning.
    std::string track(const Timeline& timeline, int first, int last);

private:
    const std::vector<float>& texts(const std::string& text);

    std::string command_, folder_;
    ProgressMonitor& monitor_;
    std::map<std::string, std::vector<float>> texts_;  // at `rate`, one channel
};

/// Returns the samples in [-1, 1] of a RIFF WAVE file with 16-bit PCM, its channels averaged; `rate` receives samples
/// per second. Sizes that a program could not know when it began to write count as "to the end". Empty for any other
/// file.
std::vector<float> samples_of_wav(const std::string& bytes, int& rate);

}  // namespace crescent::explainer
