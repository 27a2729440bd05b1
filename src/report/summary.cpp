// The terminal output of a run, at most 80 columns: whether all assertions held, the headline values (published,
// measured at the published seed, median and 5-95 % over seeds), the hashes of the films, bad samples, speed, the
// files.
#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "experiment/experiment.h"
#include "output/format.h"
#include "report/findings.h"
#include "report/report.h"

namespace crescent {
namespace {

constexpr std::size_t no_limit = ~std::size_t{0};

/// What shows the text: with colours or without, and so many columns, beyond which lines are cut; no_limit: all of
/// them.
struct Paint {
    bool has_colour;
    std::size_t columns;
    std::string cut(std::string_view text, std::size_t reserved = 0) const {
        return columns == no_limit ? std::string(text) : clip(text, columns - reserved);
    }
    /// Filled with blanks to `wide` columns, and cut there if lines are cut.
    std::string padded(std::string_view text, std::size_t wide) const {
        return columns == no_limit && width(text) > wide ? std::string(text) : left(text, wide);
    }
    std::string operator()(const char* code, const std::string& text) const {
        return has_colour ? std::string("\x1b[") + code + "m" + text + "\x1b[0m" : text;
    }
};
constexpr const char *green = "32", *red = "1;31", *bold = "1";

std::string failures_line(const std::vector<const AssertionResult*>& failures, std::size_t total, const Paint& paint) {
    const std::string head = fmt::format("{} of {} assertions FAIL: ", failures.size(), total);
    std::string line = head;
    for (const AssertionResult* a : failures) line += (a == failures.front() ? "" : ", ") + a->name;
    if (width(line) <= paint.columns || failures.size() == 1) return paint.cut(line);
    const std::string ending = fmt::format(", and {} more", failures.size() - 1);
    return paint.cut(head + failures.front()->name, ending.size()) + ending;
}

/// Returns how many were skipped, one line for each reason.
std::string skipped_lines(const std::vector<AssertionResult>& assertions) {
    std::map<std::string, std::uint64_t> reasons;
    for (const AssertionResult& a : assertions)
        if (!a.skipped.empty()) ++reasons[a.skipped];
    std::string out;
    for (const auto& [why, count] : reasons) out += fmt::format("{} skipped: {}\n", plural(count, "assertion"), why);
    return out;
}

std::string verdict(const std::vector<AssertionResult>& assertions, const Paint& paint) {
    std::vector<AssertionResult> evaluated;
    std::ranges::copy_if(
        assertions, std::back_inserter(evaluated), [](const AssertionResult& a) { return a.skipped.empty(); });
    if (assertions.empty()) return "no assertions in this experiment\n";
    if (evaluated.empty()) return "no assertion was evaluated\n";
    std::vector<const AssertionResult*> failures;
    for (const AssertionResult& a : evaluated)
        if (a.failed()) failures.push_back(&a);
    if (failures.empty() && evaluated.size() == 1) return paint(green, "the one assertion holds") + "\n";
    if (failures.empty()) return paint(green, fmt::format("all {} assertions hold", evaluated.size())) + "\n";
    std::string out = paint(red, failures_line(failures, evaluated.size(), paint)) + "\n";
    for (const AssertionResult* a : failures) {
        const std::string values = a->reference_good
            ? fmt::format(": measured {}, must be {} {}", compact(a->measured), a->op, compact(a->bound))
            : ": the reference is not good enough";
        out += fmt::format("  {}{}\n", paint.cut(a->name, 2 + width(values)), values);
        if (!a->reference_fault.empty()) out += fmt::format("    {}\n", a->reference_fault);
    }
    return out;
}

std::string table_row(const SeedSpread& b, bool published, bool paired, const Paint& paint) {
    const std::string name = fmt::format("{} {}", b.metric, b.key.arm);
    std::string row = fmt::format("  {}", paint.padded(name, published ? 23 : 34));
    if (published) row += fmt::format(" {}", right(b.published ? figures_of(b.metric, *b.published) : "-", 10));
    row += fmt::format(" {}", right(figures_of(b.metric, b.measured, paired), 10));
    if (b.band.seeds < 2) return row;
    row += fmt::format(" {}  ", right(figures_of(b.metric, b.band.median, paired), 10));
    if (b.band.heavy) return row + "heavy tail";
    return row +
        paint.padded(figures_of(b.metric, b.band.q05, paired) + " .. " + figures_of(b.metric, b.band.q95, paired), 20);
}

std::string table(const ReportInputs& in, const Paint& paint) {
    const Findings find(in);
    const std::uint64_t n = find.headline_n();
    const bool published = find.anything_published();
    std::string rows;
    int seeds = 1;
    for (const std::string& metric : headline_metrics(in.experiment))
        for (const ArmPlan& arm : in.experiment.arms)
            if (const SeedSpread* band = find.band(arm.name, n, metric)) {
                rows +=
                    table_row(*band, published, in.experiment.reference.kind == ReferenceKind::paired, paint) + "\n";
                seeds = std::max(seeds, band->band.seeds);
            }
    if (rows.empty()) return {};
    const std::string s = any_tells_s(in.experiment) ? ", s = " + shortest(find.s()) : "";
    std::string head = fmt::format("  {}", left(fmt::format("N = {}{}", n, s), published ? 23 : 34));
    if (published) head += "  published";
    head += "   measured";
    if (seeds > 1) head += fmt::format("     median  5-95 % of {} seeds", seeds);
    return fmt::format("\n{}\n{}", paint(bold, head), rows);
}

/// Returns the hashes of the films; a film's name omits s if its arm does not depend on it.
std::map<std::string, std::string> hashes_shown(const ReportInputs& in) {
    std::map<std::string, std::string> out = in.metrics.film_hashes;
    for (const RunMetrics& run : in.metrics.runs) {
        if (tells_s(run.key.arm, run.key.s, in.experiment)) continue;
        if (auto film = out.extract(to_string(run.key)); film) {
            film.key() = fmt::format("{} n={}", run.key.arm, run.key.n);
            out.insert(std::move(film));
        }
    }
    return out;
}

std::string films(const std::map<std::string, std::string>& hashes, const Paint& paint) {
    if (hashes.empty()) return {};
    std::string out = fmt::format("\n{}\n", paint(bold, "  films (XXH3-64)"));
    std::size_t longest = 0;
    for (const auto& [name, hash] : hashes) longest = std::max(longest, width(name) + width(hash));
    const std::size_t across = longest + 2 <= 38 ? 2 : 1;
    const std::size_t line = paint.columns == no_limit ? longest + 4 : paint.columns - 2;
    const std::size_t cell = across == 2 ? 38 : line;
    std::size_t index = 0;
    for (const auto& [name, hash] : hashes) {
        const std::string digits = paint.columns == no_limit ? hash : clip(hash, cell / 2);
        out += fmt::format("  {}  {}", paint.padded(name, cell - 2 - width(digits)), digits);
        if (++index % across == 0 || index == hashes.size()) out += "\n";
    }
    return out;
}

/// Returns the error of a paired reference in each region, at the experiment's own exponent.
std::string reference_line(const ReportInputs& in, const Paint& paint) {
    std::string out;
    for (const ReferenceQuality& r : in.metrics.references)
        if (r.paired_error && r.s == in.experiment.s())
            out += fmt::format("{}{} {}", out.empty() ? "" : ", ", r.region, figures(*r.paired_error, 2));
    return out.empty() ? out : "\n" + paint.cut("  the reference's own error (rms): " + out) + "\n";
}

std::string speed(const Timing& t, const Paint& paint) {
    if (t.threads == 0) return {};  // nothing was computed: runs were joined
    std::uint64_t samples = 0;
    double seconds = 0;
    for (const ArmTiming& arm : t.arms) {
        samples += arm.samples;
        seconds += arm.seconds;
    }
    std::string out = fmt::format("  {:.2f} s estimating, {:.2f} s in all", t.estimating_s, t.total_s);
    if (seconds > 0) out += fmt::format(", {:.0f} Msamples/s", static_cast<double>(samples) / seconds * 1e-6);
    return paint.cut(out + fmt::format(", {}, {}", plural(static_cast<std::uint64_t>(t.threads), "thread"), t.isa)) +
        "\n";
}

/// The stages that took 5 % of the time or more, in lines of 80 columns.
std::string shares(const Timing& t, const Paint& paint) {
    constexpr std::size_t columns = 80;
    std::vector<std::string> lines;
    for (const auto& [name, seconds] : t.stages) {
        if (!(t.total_s > 0 && seconds >= 0.05 * t.total_s)) continue;
        const std::string share = fmt::format("{:.0f} % {}", 100 * seconds / t.total_s, name);
        if (!lines.empty()) lines.back() += ";";
        if (!lines.empty() && lines.back().size() + share.size() + 2 <= columns) lines.back() += " " + share;
        else lines.push_back("  " + share);
    }
    std::string out;
    for (const std::string& line : lines) out += paint.cut(line) + "\n";
    return out;
}

std::string where(const ReportInputs& in, const std::string& out_dir, const OutputParts& parts, const Paint& paint) {
    const std::string dir = out_dir.empty() ? "." : out_dir;
    const auto line = [&](const char* what, const std::string& path) {
        return fmt::format("  {:<9}{}\n", what, paint.cut(path, 11));
    };
    std::string out;
    if (parts.report) out += line("look at", dir + "/report.html");
    if (parts.plates && !in.plates.empty()) out += line("plates", dir + "/plates/");
    if (parts.films) out += parts.metrics ? "" : line("films", dir + "/films/");
    return parts.metrics ? out + line("numbers", dir + "/metrics.json") : out;
}

}  // namespace

std::string terminal_summary(const ReportInputs& in, const Timing& timing, const std::string& out_dir,
    const OutputParts& parts, bool colour, std::size_t columns) {
    const Paint paint{colour, columns == 0 ? no_limit : columns};
    std::string out = verdict(in.metrics.assertions, paint) + skipped_lines(in.metrics.assertions);
    if (const std::vector<int> missing = in.provenance.missing(); !missing.empty())
        out += fmt::format("seeds {} of {}: a part of the series; missing: {}\n", ranges_text(in.provenance.places),
            in.provenance.series, ranges_text(missing));
    out += table(in, paint) + reference_line(in, paint) + films(hashes_shown(in), paint);
    if (const std::uint64_t bad = Findings(in).bad_samples())
        out += fmt::format("\n{}\n",
            paint(red,
                fmt::format(
                    "  {}: NaN, infinite or negative,\n  or a pdf that cannot be used", plural(bad, "bad sample"))));
    for (const std::string& warning : Findings(in).warnings()) out += "\n" + paint.cut("  warning: " + warning) + "\n";
    return out + "\n" + speed(timing, paint) + shares(timing, paint) + where(in, out_dir, parts, paint);
}

}  // namespace crescent
