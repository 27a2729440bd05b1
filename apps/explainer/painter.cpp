// Draws the shot and its heading, then the ground over both, so that they fade in and out in 0.3 s, then the caption
// over that. A frame that equals the one before it, because all time queries of the shot have equal results, is not
// drawn again.
#include "painter.h"

#include "drawing.h"

namespace crescent::explainer {

namespace {

constexpr double fade = 0.3;  // s at either end of a shot

void heading(Frame& f, const Shot& shot) {
    const double in = f.ease(0, fade);
    const Rect& bar = heading_band;
    f.fill({bar.x, bar.y + 6, 7, bar.h - 12}, shot.kind == Kind::photograph ? photograph_accent : backend_accent, in);
    f.text({bar.x + 26, bar.y, 1200, bar.h}, shot.title, title_text, in);
    if (shot.kind == Kind::words) return;
    const bool is_photograph = shot.kind == Kind::photograph;
    const Words label(
        is_photograph ? "PHOTOGRAPH" : "INSTRUMENT", is_photograph ? ", without numbers" : ", from the float films");
    Text style = with(with(small_text, is_photograph ? photograph_accent : backend_accent), Align::right);
    f.text({bar.right() - 560, bar.y, 560, bar.h}, label, style, in);
}

}  // namespace

Painter::Painter(const Timeline& timeline, int height)
    : timeline_(timeline), canvas_(height * 16 / 9, height, ground, height / sheet_height) {}

void Painter::caption(Frame& f, const Shot& shot) const {
    for (std::size_t k = 0; k < shot.cues.size(); ++k) {
        const Cue& cue = shot.cues[k];
        const double end = k + 1 < shot.cues.size() ? shot.cues[k + 1].start : shot.seconds;
        if (!f.after(cue.start) || f.after(end)) continue;
        const double alpha = f.ease(cue.start, cue.start + 0.2);
        f.text(caption_band, broken(cue.words), cue.question ? with(caption_text, photograph_accent) : caption_text,
            alpha);
    }
}

bool Painter::draw(int frame) {
    const Timeline::Place place = timeline_.at(frame);
    if (frame_ && shot_ == place.shot && frame_->same_at(place.t)) return false;
    const Shot& shot = timeline_.shots()[place.shot];
    canvas_.clear(ground);
    frame_ = std::make_unique<Frame>(canvas_, place.t);
    shot_ = place.shot;
    Frame& f = *frame_;
    shot.draw(f);
    heading(f, shot);
    f.fill({0, 0, sheet_width, caption_band.y}, ground,
        1 - f.ease(0, fade) * (1 - f.ease(shot.seconds - fade, shot.seconds - 0.03)));
    caption(f, shot);
    return true;
}

}  // namespace crescent::explainer
