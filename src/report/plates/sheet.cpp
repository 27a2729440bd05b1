// Words are measured before they are placed: the header's right part, a caption in two lines or smaller in three, notes
// in one line or two. A name tag takes the first free of five places around its outline. Lengths in pixels.
#include "report/plates/sheet.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "experiment/experiment.h"
#include "math/functions.h"
#include "output/charts.h"
#include "output/tone_map.h"
#include "output/formula.h"
#include "report/plates/canvas.h"
#include "samplers/info.h"

namespace crescent::plates {

// ---- Names, axes and formulas are those of SamplerInfo for the arm's sampler, formulas set by output/formula.h; {fmt}
// prints numbers, which are then given a true minus and powers of ten as superscripts.

namespace {

std::string formula_of(const std::string& arm, const Experiment& e, const crescent::formula::Value& value = {}) {
    const ArmPlan* plan = e.find_arm(arm);
    const SamplerInfo* info = find_arm_info(sampler_of(arm, e));
    if (!info) return escaped(plan ? source_of(*plan) : arm);
    const std::string line = crescent::formula::pango(info->formula, value);
    return info->techniques > 1 ? line : "p(ω) = " + line;
}

// Returns the distinct values in order of appearance, joined by " | ".
template <class F> std::string distinct(const std::vector<RunKey>& runs, F text) {
    std::vector<std::string> values;
    for (const RunKey& r : runs) {
        std::string t = text(r);
        if (std::find(values.begin(), values.end(), t) == values.end()) values.push_back(t);
    }
    return joined(values, " | ");
}

std::string not_finite_word(double v) { return std::isnan(v) ? "not a number" : v > 0 ? "∞" : "−∞"; }

// Sets a printf number with a true minus and its power of ten as a superscript.
std::string typeset(std::string text) {
    if (auto e = text.find('e'); e != std::string::npos) {
        int power = std::stoi(text.substr(e + 1));
        std::string exponent = (power < 0 ? "−" : "") + std::to_string(std::abs(power));
        text = text.substr(0, e) + "·10<sup>" + exponent + "</sup>";
    }
    if (text[0] == '-') text.replace(0, 1, "−");
    return text;
}

}  // namespace

std::string joined(const std::vector<std::string>& parts, std::string_view separator) {
    std::string text;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (i > 0) text += separator;
        text += parts[i];
    }
    return text;
}

RunKey key_of(const PlateRun& run, const Experiment& e) {
    return {.arm = run.arm, .n = run.n, .s = run.s > 0 ? run.s : e.s(), .seed = e.seed};
}

std::vector<RunKey> keys_of(const PlatePlan& plan, const Experiment& e) {
    std::vector<RunKey> keys;
    for (const PlateRun& r : plan.runs) keys.push_back(key_of(r, e));
    return keys;
}

std::string sampler_of(const std::string& arm, const Experiment& e) {
    for (const ArmPlan& a : e.arms) {
        if (a.name == arm) return a.sampler;
    }
    return {};
}

std::string arm_name(const std::string& arm, const Experiment& e) {
    const SamplerInfo* info = sampler_of(arm, e) == arm ? find_arm_info(arm) : nullptr;
    return escaped(info ? std::string(info->label) : arm);
}

std::string axis_of(const std::string& arm, const Experiment& e) {
    const SamplerInfo* info = find_arm_info(sampler_of(arm, e));
    return !info || info->about == PdfAxis::none ? "" : info->about == PdfAxis::normal ? "n" : "R";
}

std::string density_formula(const std::string& arm, const Experiment& e) { return formula_of(arm, e); }

std::string density_formula_at(const std::string& arm, double s, const Experiment& e) {
    return formula_of(arm, e, {'s', number(s), number(s + 1)});
}

std::string runs_label(const std::vector<RunKey>& runs, const Experiment& e, bool with_n) {
    std::string label = distinct(runs, [&](const RunKey& r) { return arm_name(r.arm, e); });
    const auto n_of = [&](const RunKey& r) {
        const ArmPlan* arm = e.find_arm(r.arm);
        return fmt::format("{}{}", r.n, arm && techniques_of(*arm) > 1 ? " pairs" : "");
    };
    if (with_n) label += " N=" + distinct(runs, n_of);
    std::vector<RunKey> keys_with_s;
    std::ranges::copy_if(
        runs, std::back_inserter(keys_with_s), [&](const RunKey& r) { return tells_s(r.arm, r.s, e); });
    return keys_with_s.empty() ? label
                               : label + " s=" + distinct(keys_with_s, [](const RunKey& r) { return number(r.s); });
}

std::string reference_words(const Experiment& e) {
    const ReferencePlan& r = e.reference;
    if (r.kind == ReferenceKind::quadrature) return "by quadrature, no samples";
    if (r.kind == ReferenceKind::paired) return fmt::format("two estimates, {} spp each, seed {}", r.n, r.seed);
    return fmt::format("lobe {} spp, lights {} spp, seed {}", r.lobe_spp, r.disk_spp, r.seed);
}

std::string number(double v, int digits) {
    if (!std::isfinite(v)) return not_finite_word(v);
    return typeset(fmt::format("{:.{}g}", v, digits));
}

std::string figure(double v, int digits) {
    if (!std::isfinite(v)) return not_finite_word(v);
    if (v == 0) return "0";
    const double unit = math::pow(10.0, digits - 1);  // from here on all digits are before the point
    if (std::abs(v) >= unit - 0.05 && std::abs(v) < 1e7) return typeset(fmt::format("{:.0f}", v));
    std::string text = typeset(fmt::format("{:#.{}g}", v, digits));
    if (text.back() == '.') text.pop_back();
    return text;
}
std::string count(std::uint64_t v) {
    std::string digits = std::to_string(v), out;
    for (std::size_t i = 0; i < digits.size(); ++i) {
        if (i > 0 && (digits.size() - i) % 3 == 0 && digits.size() > 4) out += "\u2009";
        out += digits[i];
    }
    return out;
}

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
    return e.reference.kind != ReferenceKind::quadrature ? fmt::format("seed {}", e.reference.seed) : "";
}

void photograph_header(Sheet& sheet, const std::string& what, const std::string& stream) {
    header(sheet, photograph_accent,
        "Khronos PBR Neutral / " + tinted("PHOTO-ONLY", photograph_accent, sheet.canvas.theme()) + " / " + what,
        stream);
}

void backend_header(
    Sheet& sheet, const std::string& name, const std::string& what, const std::string& stream, bool of_films) {
    header(sheet, backend_accent, tinted("INSTRUMENT " + name, backend_accent, sheet.canvas.theme()) + " / " + what,
        stream);
    if (of_films)
        for (const ReferenceQuality& r : sheet.in.metrics.references)
            if (r.error_share > most_error_share) {
                sheet.notes.push_back(
                    "reference not good enough in " + escaped(r.region) + ": errors there are too large");
                break;
            }
    const std::string& backend = sheet.in.backend;
    if (!backend.empty())
        sheet.notes.push_back(
            (of_films || backend == "CPU" ? "measured on " : "computed on the CPU, films on ") + escaped(backend));
}

void note_biased_arms(Sheet& sheet) {
    const Experiment& e = sheet.experiment();
    const std::vector<RunKey> runs = keys_of(sheet.plan, e);
    std::vector<std::string> names;
    for (const ArmPlan& arm : e.arms) {
        const bool is_shown =
            runs.empty() || std::ranges::any_of(runs, [&](const RunKey& k) { return k.arm == arm.name; });
        if (is_shown && !missed_light(arm, e).empty()) names.push_back(arm_name(arm.name, e));
    }
    if (!names.empty()) sheet.notes.push_back("biased, some light is out of reach: " + joined(names, ", "));
}

void finish(Sheet& sheet) {
    Text caption = with_lines(body_text, 2);
    std::string text = escaped(sheet.plan.caption);
    // A caption that does not fit in two lines is set smaller, in three.
    Text probe = with_px(caption, body_text.px);
    if (sheet.canvas.measure(text, probe).w > 1.9 * caption_band.w) caption = with_lines(with_px(caption, 15), 3);
    caption.least_px = 13;
    sheet.canvas.text(caption_band, text, caption);

    Rect foot = footer_band;
    if (sheet.not_finite > 0) {
        std::string message = fmt::format(
            "{} pixel{} not a number, shown in magenta", count(sheet.not_finite), sheet.not_finite == 1 ? "" : "s");
        Text style = with(with(with(small_text, alert), Align::right), Weight::semibold);
        double w = sheet.canvas.measure(message, style).w + 2;
        sheet.canvas.text({foot.right() - w, foot.y, w, foot.h}, message, style);
        foot.w -= w + gap;
    }
    std::string notes = joined(sheet.notes, "  ·  ");
    for (const double px : {17.0, small_text.px}) {  // the larger size if it fits: footers are read from a distance
        const Text style = with_px(small_text, px);
        if (sheet.canvas.measure(notes, style).w > foot.w) continue;
        sheet.canvas.text(foot, notes, style);
        return;
    }
    Text two_lines = with(with_lines(with_px(small_text, 13), 2), Vertical::bottom);
    sheet.canvas.text({foot.x, foot.y - 12, foot.w, 35}, notes, two_lines);
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
    auto match = std::find_if(e.arms.begin(), e.arms.end(), [&](const ArmPlan& a) { return a.name == arm; });
    return series[std::size_t(match - e.arms.begin()) % series_count];
}

void outline_over(Canvas& canvas, const Rect& r, const Colour& ink) {
    Colour halo = ground;
    halo.a = 0.75;
    canvas.outline(r, halo, 5);
    canvas.outline(r, ink, 2);
}

Rect on_picture(const Rect& picture, const Box& frame, const Box& box) {
    double sx = picture.w / frame.width(), sy = picture.h / frame.height();
    return {picture.x + (box.x0 - frame.x0) * sx, picture.y + (frame.y1 - box.y1) * sy, box.width() * sx,
        box.height() * sy};
}

void name_tag(Sheet& sheet, const Rect& picture, const Rect& outline, const std::string& name, const Colour& c) {
    constexpr double h = 26;
    Text style = with(with(with(with(body_text, ground), Weight::semibold), Align::centre), Vertical::middle);
    std::string text = escaped(name);
    double w = std::min(sheet.canvas.measure(text, style).w + 16, picture.w);
    double left_edge = outline.x - 1.25, right_edge = outline.right() + 1.25 - w, top_y = outline.y - h - 1,
           bottom_y = outline.bottom() + 1;
    for (auto [x, y] : {std::pair{left_edge, top_y}, {right_edge, top_y}, {left_edge, bottom_y}, {right_edge, bottom_y},
             {left_edge, outline.y}}) {
        Rect tag{std::clamp(x, picture.x, picture.right() - w), y, w, h};
        bool is_clear = std::none_of(sheet.tags.begin(), sheet.tags.end(), [&](const Rect& t) { return t.meets(tag); });
        if (!is_clear || tag.y < picture.y || tag.bottom() > picture.bottom()) continue;
        sheet.canvas.fill(tag, c);
        sheet.canvas.text({tag.x + 4, tag.y, w - 8, h}, text, style);
        sheet.tags.push_back(tag);
        return;
    }
}

// ---- The colour bar of turbo scales.

void colour_bar(Sheet& sheet, const Rect& bar, double top, bool open_ended, int decades) {
    Canvas& c = sheet.canvas;
    int w = static_cast<int>(bar.w), h = static_cast<int>(bar.h);
    Block block(w, h);
    for (int y = 0; y < h; ++y) {
        for (int x = 0; x < w; ++x) block.set(x, y, turbo(1 - (y + 0.5) / h));
    }
    double y0 = std::floor(bar.y), x0 = std::floor(bar.x);
    c.paint(block, static_cast<int>(x0), static_cast<int>(y0));
    c.outline({x0 - 0.5, y0 - 0.5, w + 1.0, h + 1.0}, rule, 1);
    Text style = with(with(with_px(small_text, 16), bright), Vertical::middle);
    auto tick = [&](double share, const std::string& text) {
        double y = y0 + h * (1 - share);
        c.line(x0 + w, y, x0 + w + 6, y, muted, 1.5);
        c.text({x0 + w + 11, y - 12, 80, 24}, text, style);
    };
    tick(1, (open_ended ? "≥ " : "") + number(top, 3));
    if (decades > 0) {
        for (int k = 1; k <= decades; ++k)
            tick(1 - double(k) / decades, (k < decades ? "" : "≤ ") + number(top * math::pow(10.0, -k), 2));
        return;
    }
    double step = round_up(top / std::clamp(h / 24, 1, 7));
    for (int k = 0; k * step < top; ++k) {
        if (h * (1 - k * step / top) >= 24) tick(k * step / top, number(k * step, 3));
    }
}

}  // namespace crescent::plates
