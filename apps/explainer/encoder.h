// ffmpeg, fed with raw frames over a pipe.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "crescent/crescent.h"
#include "rasters.h"

namespace crescent::explainer {

/// The input and output files.
struct EncoderInputs {
    int width = 0, height = 0;
    std::string captions, chapters, poster;  // .srt, ffmetadata, .png
    std::string mp4;                         // to be written
    std::string log;                         // ffmpeg's messages
};

/// OutputError if ffmpeg or one of its parts is missing; called before the work.
void require_ffmpeg(const std::string& folder, const ProgressMonitor& monitor);

class Encoder {
public:
    explicit Encoder(const EncoderInputs& in);
    void take(const Raster& raster, const ProgressMonitor& monitor);
    /// Waits for ffmpeg to finish. OutputError if it failed, or wrote no video.
    void finish(const ProgressMonitor& monitor);

private:
    [[noreturn]] void fail(const std::string& what);

    EncoderInputs in_;
    Process process_;
};

}  // namespace crescent::explainer
