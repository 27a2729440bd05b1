// What is said, as other programs read it: WebVTT, SubRip, a transcript, chapters.
#pragma once

#include <string>

#include "timeline.h"

namespace crescent::explainer {

/// Frames first .. last - 1 of the film; what is written counts from the first of them.
struct Part {
    int first = 0, last = 0;
};

std::string webvtt(const Timeline& timeline, const Part& part);
std::string subrip(const Timeline& timeline, const Part& part);
/// Chapter by chapter: what is seen, then what is said.
std::string transcript(const Timeline& timeline, const Part& part);
/// ffmpeg's metadata text: title and chapters.
std::string chapters(const Timeline& timeline, const Part& part, const std::string& title);

}  // namespace crescent::explainer
