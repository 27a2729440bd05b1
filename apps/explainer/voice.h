// Captions spoken by a program of the user's: text on its stdin, a WAV (PCM, 16 bit) on its stdout.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "timeline.h"

namespace crescent::explainer {

class Voice {
public:
    /// `folder`: where the program's files may lie.
    Voice(std::string command, std::string folder, ProgressMonitor& monitor);

    /// How long the words take to be said, s. OutputError where the program fails or gives no WAV.
    double seconds(const Words& words);
    /// A WAV of the whole part: every caption's speech from its beginning on.
    std::string track(const Timeline& timeline, int first, int last);

private:
    const std::vector<float>& texts(const std::string& text);

    std::string command_, folder_;
    ProgressMonitor& monitor_;
    std::map<std::string, std::vector<float>> texts_;  // at `rate`, one channel
};

/// Samples in [-1, 1] of a RIFF WAVE file with 16-bit PCM, its channels averaged; `rate` receives samples a second.
/// Sizes that a program could not know when it began to write count as "to the end". Empty where it is none.
std::vector<float> samples_of_wav(const std::string& bytes, int& rate);

}  // namespace crescent::explainer
