// hero and gallery: one photograph, at 1:1 if it fits, with facts next to it.
#include <fmt/format.h>

#include "report/plates/sheet.h"

namespace crescent::plates {

std::vector<Fact> exponent_facts(double s) {
    if (!(s > 0)) return {};
    return {{"s", number(s)}};
}

std::string with_exponent(const std::string& text, double s) { return s > 0 ? text + " s=" + number(s) : text; }

double facts(Sheet& sheet, const std::string& title, const std::string& under_title, const std::vector<Fact>& list) {
    Rect line = facts_slot;
    line.h = 34;
    sheet.canvas.text(line, title, with_px(title_text, 28));
    line.y += 40;
    line.h = 48;
    if (!under_title.empty()) {
        line.y = sheet.canvas.text(line, under_title, with_lines(with(body_text, muted), 2)).bottom() + 14;
    }
    for (const Fact& f : list) {
        sheet.canvas.line(line.x, line.y + 0.5, line.right(), line.y + 0.5, rule, 1);
        Rect row{line.x, line.y + 7, line.w, 24};
        double name_w = sheet.canvas.measure(f.name, with(body_text, muted)).w + 1;
        sheet.canvas.text({row.x, row.y, name_w, row.h}, f.name, with(body_text, muted));
        sheet.canvas.text(
            {row.x + name_w + 10, row.y, row.w - name_w - 10, row.h}, f.value, with(body_text, Align::right));
        line.y += 38;
    }
    sheet.canvas.line(line.x, line.y + 0.5, line.right(), line.y + 0.5, rule, 1);
    return line.y;
}

namespace {

std::string shown_as(const View& v) {
    return v.width > 0 ? to_string(fit(v.width, v.height, picture_slot.w, picture_slot.h)) : "";
}

std::vector<Fact> common_facts(const Sheet& sheet, const View& v) {
    const Experiment& e = sheet.experiment();
    return {{"exposure", number(e.exposure)}, {"image", fmt::format("{} × {}", e.image.width, e.image.height)},
        {"shown", shown_as(v)}};
}

void picture(Sheet& sheet, const View& v, const std::string& missing) {
    if (v.width == 0) {
        paint_missing(sheet, picture_slot, missing);
        return;
    }
    Fit f = fit(v.width, v.height, picture_slot.w, picture_slot.h);
    Rect slot = picture_slot;
    slot.y += std::floor((slot.h - f.out_h) / 2);
    paint_photograph(sheet, v, whole(v), slot);
    sheet.notes.push_back("numbers come from the float films, not the photograph");
    if (f.reduced) sheet.notes.push_back("area average in linear light, then tone-mapped");
    if (f.times > 1) sheet.notes.push_back("each pixel repeated " + to_string(f));
}

void draw_run(Sheet& sheet, const RunKey& key) {
    const Experiment& e = sheet.experiment();
    View v = view(sheet.in.film(key));
    photograph_header(sheet, runs_label({key}, e), stream_words({key}));
    picture(sheet, v, escaped(to_string(key)) + " was not run");
    std::vector<Fact> list{{"N", count(key.n)}};
    for (Fact& f : exponent_facts(key.s)) list.push_back(std::move(f));
    list.push_back({"seed", fmt::format("{}", key.seed)});
    for (Fact& f : common_facts(sheet, v)) list.push_back(std::move(f));
    facts(sheet, arm_name(key.arm, e), density_formula(key.arm, e), list);
}

void draw_converged(Sheet& sheet) {
    const Experiment& e = sheet.experiment();
    double s = sheet.plan.runs.empty() ? e.s() : key_of(sheet.plan.runs[0], e).s;
    View v = view(sheet.in.reference(s));
    photograph_header(sheet, with_exponent("Converged reference", s), reference_stream(e));
    picture(sheet, v, with_exponent("no reference", s));
    std::vector<Fact> list = exponent_facts(s);
    for (Fact& f : common_facts(sheet, v)) list.push_back(std::move(f));
    facts(sheet, "Converged", reference_words(e), list);
}

}  // namespace

void draw_still(Sheet& sheet) {
    if (sheet.plan.kind == PlateKind::gallery || sheet.plan.runs.empty()) {
        draw_converged(sheet);
    } else {
        draw_run(sheet, key_of(sheet.plan.runs[0], sheet.experiment()));
    }
}

}  // namespace crescent::plates
