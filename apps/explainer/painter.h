// A whole frame of the video: the shot, its title above it, the caption below it.
#pragma once

#include <memory>

#include "timeline.h"

namespace crescent::explainer {

class Painter {
public:
    /// `height`: of 16:9 frames; the sheet of 1920 x 1080 units is scaled to it.
    Painter(const Timeline& timeline, int height);

    /// Draws a frame of the video on canvas(), unless it already shows an equal one. Returns whether it drew.
    bool draw(int frame);
    Canvas& canvas() { return canvas_; }
    /// Returns the queries and words of the frame on the canvas.
    const Frame& frame() const { return *frame_; }

private:
    void caption(Frame& f, const Shot& shot) const;

    const Timeline& timeline_;
    Canvas canvas_;
    std::unique_ptr<Frame> frame_;
    std::size_t shot_ = 0;
};

}  // namespace crescent::explainer
