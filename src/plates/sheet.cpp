// Words are measured before they get their place: the header's right part, a caption in two lines or smaller in three,
// notes in one line or two. A name tag takes the first free of five places about its outline. Lengths in pixels.
#include "plates/sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiment/arm_facts.h"
#include "math/functions.h"

namespace crescent::plates {

namespace {

void header(Sheet& sheet, const Colour& accent, const std::string& label, const std::string& stream) {
    const Rect& b = header_band;
    sheet.canvas.fill({b.x, b.y + 4, 5, b.h - 8}, accent);
    Text right = with(with(with_px(small_text, 16), Align::right), Vertical::middle);
    double w = stream.empty() ? 0 : sheet.canvas.measure(stream, right).w + 2;
    sheet.canvas.text({b.right() - w, b.y, w, b.h}, stream, right);
    sheet.canvas.text({b.x + 17, b.y, b.w - 17 - w - gap, b.h}, label, label_text);
}

std::string tinted(const std::string& text, const Colour& plain, Theme theme) {
    const Colour c = themed(plain, theme);
    auto byte = [](double v) { return static_cast<int>(std::lround(255 * v)); };
    return fmt::format(
        "<span foreground='#{:02x}{:02x}{:02x}' weight='600'>{}</span>", byte(c.r), byte(c.g), byte(c.b), text);
}

}  // namespace

std::string stream_words(const std::vector<RunKey>& runs) {
    if (runs.empty()) return "";
    return fmt::format("{}seed {}", runs.size() > 1 ? "one stream, " : "", runs[0].seed);
}

std::string reference_stream(const Experiment& e) {
    return e.reference.kind == ReferenceKind::note ? fmt::format("seed {}", e.reference.seed) : "";
}

void photograph_header(Sheet& sheet, const std::string& what, const std::string& stream) {
    header(sheet, photograph_accent,
        "Khronos PBR Neutral / " + tinted("PHOTO-ONLY", photograph_accent, sheet.canvas.theme()) + " / " + what,
        stream);
}

void instrument_header(
    Sheet& sheet, const std::string& name, const std::string& what, const std::string& stream, bool of_films) {
    header(sheet, instrument_accent,
        tinted("INSTRUMENT " + name, instrument_accent, sheet.canvas.theme()) + " / " + what, stream);
    if (of_films)
        for (const ReferenceMeter& r : sheet.in.metrics.references)
            if (r.error_share > most_error_share) {
                sheet.notes.push_back(
                    "reference not good enough in " + escaped(r.region) + ": errors there are too large");
                break;
            }
    const std::string& on = sheet.in.instrument;
    if (!on.empty())
        sheet.notes.push_back(
            (of_films || on == "CPU" ? "measured on " : "computed on the CPU, films on ") + escaped(on));
}

void note_biased_arms(Sheet& sheet) {
    const Experiment& e = sheet.experiment();
    const std::vector<RunKey> runs = keys_of(sheet.plan, e);
    std::vector<std::string> names;
    for (const ArmPlan& arm : e.arms) {
        const bool shown =
            runs.empty() || std::ranges::any_of(runs, [&](const RunKey& k) { return k.arm == arm.name; });
        if (shown && !missed_light(arm, e).empty()) names.push_back(arm_name(arm.name, e));
    }
    if (!names.empty()) sheet.notes.push_back("biased, some light is out of reach: " + joined(names, ", "));
}

void finish(Sheet& sheet) {
    Text caption = with_lines(body_text, 2);
    std::string text = escaped(sheet.plan.caption);
    // A caption that does not fit in two lines is set smaller, in three.
    Text probe = with_px(caption, body_text.px);
    if (sheet.canvas.measure(text, probe).w > 1.9 * caption_band.w) caption = with_lines(with_px(caption, 15), 3);
    caption.least = 13;
    sheet.canvas.text(caption_band, text, caption);

    Rect foot = footer_band;
    if (sheet.not_finite > 0) {
        std::string say = fmt::format(
            "{} pixel{} not a number, shown in magenta", count(sheet.not_finite), sheet.not_finite == 1 ? "" : "s");
        Text how = with(with(with(small_text, alert), Align::right), Weight::semibold);
        double w = sheet.canvas.measure(say, how).w + 2;
        sheet.canvas.text({foot.right() - w, foot.y, w, foot.h}, say, how);
        foot.w -= w + gap;
    }
    std::string notes = joined(sheet.notes, "  ·  ");
    for (const double px : {17.0, small_text.px}) {  // the larger where it fits: footers are read across a room
        const Text how = with_px(small_text, px);
        if (sheet.canvas.measure(notes, how).w > foot.w) continue;
        sheet.canvas.text(foot, notes, how);
        return;
    }
    Text two = with(with_lines(with_px(small_text, 13), 2), Vertical::bottom);
    sheet.canvas.text({foot.x, foot.y - 12, foot.w, 35}, notes, two);
}

Rect paint_framed(Sheet& sheet, const Block& block, const Rect& slot) {
    int x = static_cast<int>(std::floor(slot.x + (slot.w - block.width) / 2));
    int y = static_cast<int>(std::floor(slot.y));
    sheet.canvas.paint(block, x, y);
    Rect r{double(x), double(y), double(block.width), double(block.height)};
    sheet.canvas.outline(r.inset(-0.5), rule, 1);
    return r;
}

Rect paint_missing(Sheet& sheet, const Rect& slot, const std::string& why) {
    sheet.canvas.fill(slot, panel);
    sheet.canvas.outline(slot.inset(0.5), rule, 1);
    sheet.canvas.text(slot.inset(12), why, with_lines(with(with(body_text, Align::centre), Vertical::middle), 3));
    return slot;
}

Rect paint_photograph(Sheet& sheet, const View& v, const Box& box, const Rect& slot) {
    sheet.not_finite += not_finite(v, box);
    Fit f = fit(box.width(), box.height(), slot.w, slot.h);
    return paint_framed(sheet, photograph_block(v, box, f, sheet.experiment().exposure), slot);
}

Colour arm_colour(const std::string& arm, const Experiment& e) {
    auto at = std::find_if(e.arms.begin(), e.arms.end(), [&](const ArmPlan& a) { return a.name == arm; });
    return series[std::size_t(at - e.arms.begin()) % series_count];
}

void outline_over(Canvas& canvas, const Rect& r, const Colour& ink) {
    Colour halo = ground;
    halo.a = 0.75;
    canvas.outline(r, halo, 5);
    canvas.outline(r, ink, 2);
}

Rect on_picture(const Rect& picture, const Box& shown, const Box& box) {
    double sx = picture.w / shown.width(), sy = picture.h / shown.height();
    return {picture.x + (box.x0 - shown.x0) * sx, picture.y + (shown.y1 - box.y1) * sy, box.width() * sx,
        box.height() * sy};
}

void name_tag(Sheet& sheet, const Rect& picture, const Rect& outline, const std::string& name, const Colour& c) {
    constexpr double h = 26;
    Text how = with(with(with(with(body_text, ground), Weight::semibold), Align::centre), Vertical::middle);
    std::string text = escaped(name);
    double w = std::min(sheet.canvas.measure(text, how).w + 16, picture.w);
    double left = outline.x - 1.25, right = outline.right() + 1.25 - w, above = outline.y - h - 1,
           below = outline.bottom() + 1;
    for (auto [x, y] : {std::pair{left, above}, {right, above}, {left, below}, {right, below}, {left, outline.y}}) {
        Rect tag{std::clamp(x, picture.x, picture.right() - w), y, w, h};
        bool clear = std::none_of(sheet.tags.begin(), sheet.tags.end(), [&](const Rect& t) { return t.meets(tag); });
        if (!clear || tag.y < picture.y || tag.bottom() > picture.bottom()) continue;
        sheet.canvas.fill(tag, c);
        sheet.canvas.text({tag.x + 4, tag.y, w - 8, h}, text, how);
        sheet.tags.push_back(tag);
        return;
    }
}

}  // namespace crescent::plates
