// The captions for other programs: WebVTT, SubRip, a transcript, chapters.
#pragma once

#include <string>

#include "timeline.h"

namespace crescent::explainer {

/// Frames first .. last - 1 of the video; times in the output count from the first of them.
struct Part {
    int first = 0, last = 0;
};

std::string webvtt(const Timeline& timeline, const Part& part);
std::string subrip(const Timeline& timeline, const Part& part);
/// Returns, chapter by chapter, what is seen, then what is said.
std::string transcript(const Timeline& timeline, const Part& part);
/// Returns ffmpeg's metadata text: title and chapters.
std::string chapters(const Timeline& timeline, const Part& part, const std::string& title);

}  // namespace crescent::explainer
