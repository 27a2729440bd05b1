// `crescent check`: samplers judged by themselves.
#include <cstdio>
#include <map>

#include <charconv>

#include "commands.h"
#include "crescent.h"
#include "laws/planted/planted.h"
#include "laws/right/law.h"
#include "progress.h"
#include "signals.h"

namespace crescent::cli {

namespace {

double number_in(const std::string& text, const std::string& what) {
    double v = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), v);
    if (error != std::errc{} || end != text.data() + text.size() || text.empty())
        throw InputError({what, 0, 0}, "expected a number, not '" + text + "'");
    return v;
}

std::string shortest(double v) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", v);
    return text;
}

Settings settings_of(const CheckFlags& flags) {
    Settings out;
    const std::map<std::string, std::pair<double, double>> ranges = {
        {"s", {1e-3, 1e6}}, {"alpha", {1e-4, 1}}, {"rho_d", {0, 1}}, {"rho_s", {0, 1}}};
    for (const std::string& word : flags.settings) {
        const std::size_t equals = word.find('=');
        const std::string key = word.substr(0, equals);
        if (equals == std::string::npos || !ranges.count(key)) {
            const std::string near = nearest(key, {"s", "alpha", "rho_d", "rho_s"});
            throw InputError({"--set " + word, 0, 0},
                "expected s=, alpha=, rho_d= or rho_s= and a number" +
                    (near.empty() || near == key ? "" : "; did you mean '" + near + "'?"));
        }
        const double v = number_in(word.substr(equals + 1), "--set " + word);
        const auto [low, high] = ranges.at(key);
        if (!(v >= low && v <= high))
            throw InputError(
                {"--set " + word, 0, 0}, key + " is at least " + shortest(low) + " and at most " + shortest(high));
        out[key] = v;
    }
    return out;
}

Vec3d direction_of(const std::string& text) {
    double v[3];
    std::string rest = text;
    for (int i = 0; i < 3; ++i) {
        const std::size_t comma = rest.find(',');
        if ((comma == std::string::npos) != (i == 2)) throw InputError({"--wo " + text, 0, 0}, "expected x,y,z");
        v[i] = number_in(rest.substr(0, comma), "--wo " + text);
        rest = comma == std::string::npos ? "" : rest.substr(comma + 1);
    }
    const Vec3d w{v[0], v[1], v[2]};
    const double size = length(w);
    if (!(size > 0.99 && size < 1.01) || !(w.z > 0))
        throw InputError({"--wo " + text, 0, 0}, "expected a unit vector above the horizon, z > 0");
    return normalize(w);
}

Rigour rigour_of(const CheckFlags& flags) {
    Rigour r = flags.full ? Rigour::thorough() : Rigour::quick();
    if (!(flags.alpha > 0 && flags.alpha < 1)) throw InputError({"--alpha", 0, 0}, "is between 0 and 1");
    r.alpha = flags.alpha;
    r.seed = flags.seed;
    r.pictures = !flags.html.empty();
    r.accept_few = flags.accept_few;
    return r;
}

std::vector<Trial> trials_for(const CheckFlags& flags, const Watch& watch) {
    if (!flags.exec.empty()) {
        PipeLimits limits;
        limits.stop = &watch.stop;
        if (flags.full) limits.total_seconds = 3600;
        if (flags.patience > 0) limits.total_seconds = flags.patience;
        return trials_of_subject(start_pipe(flags.exec, limits), flags.full);
    }
    if (!flags.plugin.empty()) return trials_of_subject(open_plugin(flags.plugin), flags.full);
    if (flags.samples.empty()) return trials_of(flags.arm, settings_of(flags), flags.full);
    if (flags.wo.empty() || flags.table.empty())
        throw InputError({"--samples", 0, 0}, "needs --wo x,y,z and --pdf-table FILE");
    const Vec3d wo = direction_of(flags.wo);
    Trial t = trial_of_subject(std::make_shared<SampleFile>(flags.samples, flags.table),
        math::acos(std::min(wo.z, 1.0)) * 180 / pi, math::atan2(wo.y, wo.x) * 180 / pi);
    t.wo = wo;
    return {t};
}

int exit_of(State state) {
    return state == State::wrong       ? failed
        : state == State::error        ? unwritable
        : state == State::inconclusive ? inconclusive
                                       : held;
}

/// The command that judges alike; where the files go is left out, so that equal calls state equal commands.
std::string command_of(const CheckFlags& f) {
    std::string out = "crescent check";
    if (!f.arm.empty()) out += " " + shell_word(f.arm);
    for (const std::string& text : f.settings) out += " --set " + shell_word(text);
    for (const auto& [flag, value] : {std::pair("--exec", &f.exec), {"--plugin", &f.plugin}, {"--samples", &f.samples},
             {"--pdf-table", &f.table}, {"--wo", &f.wo}})
        if (!value->empty()) out += std::string(" ") + flag + " " + shell_word(*value);
    for (const auto& [flag, given] :
        {std::pair("--full", f.full), {"--planted", f.planted}, {"--accept-few", f.accept_few}})
        if (given) out += std::string(" ") + flag;
    if (f.patience > 0) out += " --patience " + shortest(f.patience);
    if (f.alpha != 1e-3) out += " --alpha " + shortest(f.alpha);
    if (f.seed != 1) out += " --seed " + std::to_string(f.seed);
    return out;
}

/// Minutes of work are not lost to a folder that is not there: every file is opened before the first draw.
void try_files(const CheckFlags& flags) {
    for (const std::string& path : {flags.json, flags.timing, flags.junit, flags.html})
        if (!path.empty()) can_write(path);
}

void write_files(const CheckFlags& flags, const Judgement& j) {
    const JudgementSource source{crescent::version(), crescent::commit(), command_of(flags)};
    if (!flags.json.empty()) write_whole(flags.json, verdict_json(j, source));
    if (!flags.timing.empty()) write_whole(flags.timing, verdict_timing(j, source));
    if (!flags.junit.empty()) write_whole(flags.junit, verdict_junit(j));
    if (!flags.html.empty()) write_whole(flags.html, verdict_html(j, source));
}

/// What the faults came to, for the files: one verdict a fault, right where it is caught.
Verdict caught_or_not(const PlantedFault& fault, const std::string& caught) {
    Verdict v;
    v.arm = fault.breaks;
    v.trial = fault.name;
    v.name = "caught";
    v.state = caught.empty() ? State::wrong : State::right;
    v.expected = !caught.empty();
    v.say = caught.empty() ? "No verdict is wrong where this fault is planted." : "Caught by " + caught + ".";
    return v;
}

std::string catchers(const Judgement& j) {
    std::string caught;
    for (std::string_view name : verdict_names)
        for (const Verdict& v : j.verdicts)
            if (v.name == name && v.state == State::wrong) {
                caught += (caught.empty() ? "" : ", ") + v.name;
                break;
            }
    return caught;
}

/// Which verdict catches which fault. Exit 0 where every fault is caught.
int check_planted(const CheckFlags& flags, Progress& watch) {
    Judgement j;
    j.alpha = flags.alpha;
    std::string text;
    for (const PlantedFault& fault : planted_faults(flags.full)) {
        const std::string caught = catchers(judge(fault.trials, rigour_of(flags), watch));
        j.verdicts.push_back(caught_or_not(fault, caught));
        j.as_expected = j.as_expected && !caught.empty();
        char line[256];
        std::snprintf(line, sizeof line, "%-66s %-12s %s\n", fault.name.c_str(), fault.breaks.c_str(),
            caught.empty() ? "NOT CAUGHT" : caught.c_str());
        text += line;
    }
    j.state = j.as_expected ? State::right : State::wrong;
    watch.clear();
    print(text);
    write_files(flags, j);
    return exit_of(j.state);
}

bool keeps_promise(const RightLaw& law) { return rate_interval(law.accused, law.judged).first <= law.alpha; }

/// Right samplers at random parameters in quick and in full mode, where --right asks for them; kept: no more of them
/// are accused than was promised.
std::string right_tables(const CheckFlags& flags, Watch& watch, bool& kept) {
    if (flags.right == 0) return {};
    std::string out =
        "Samplers of many families, the parameters and w_o of each drawn at random, each judged by a call of its "
        "own.\n";
    for (Rigour rigour : {Rigour::quick(), Rigour::thorough()}) {
        rigour.alpha = flags.alpha;
        rigour.seed = flags.seed;
        const RightLaw law = measure_right(flags.first, flags.right, rigour, watch);
        for (const std::string& text : law.said) watch.say(text);
        out += (law.full ? "\n### Full mode\n\n" : "\n### Quick mode\n\n") + right_law_text(law);
        kept = kept && keeps_promise(law);
    }
    return out;
}

/// The command that makes docs/error-rates.md.
std::string command_of_rates(const CheckFlags& f) {
    std::string out = "crescent check --error-rates " + std::to_string(f.error_rates);
    if (f.right > 0) out += " --right " + std::to_string(f.right);
    if (f.first > 0) out += " --first " + std::to_string(f.first);
    if (f.alpha != 1e-3) out += " --alpha " + shortest(f.alpha);
    return out + " --seed " + std::to_string(f.seed);
}

/// All tables of docs/error-rates.md. Exit 0 where every fault is caught in full mode and the promises to what is right
/// are kept.
int check_error_rates(const CheckFlags& flags, Watch& watch) {
    Rigour rigour = rigour_of(flags);
    rigour.draws = 4096;  // the levels do not depend on it; many seeds matter more than many draws
    const FalseAlarms alarms = measure_false_alarms(flags.error_rates, rigour, watch);
    bool kept = rate_interval(alarms.calls, alarms.seeds).first <= alarms.alpha;
    const std::string law = right_tables(flags, watch, kept);
    std::vector<Caught> table;
    std::vector<Explained> causes;
    const std::vector<PlantedFault> quick = planted_faults(false), full = planted_faults(true);
    for (std::size_t i = 0; i < quick.size(); ++i) {
        const Judgement seen = judge(quick[i].trials, Rigour::quick(), watch);
        causes.push_back(explained(quick[i], seen));
        table.push_back({quick[i].name, quick[i].breaks, catchers(seen),
            catchers(judge(full[i].trials, Rigour::thorough(), watch))});
        kept = kept && !table.back().full.empty();
    }
    print(error_rates_text(alarms, law, table, command_of_rates(flags),
        "crescent " + crescent::version() + ", commit " + crescent::commit()));
    std::string told;
    const std::size_t right = std::max<std::size_t>(flags.right, 100);
    const std::size_t found = count_false_diagnoses(flags.first, right, flags.seed, told);
    if (!told.empty()) watch.say(told);
    print(explained_text(causes, found, right));
    return kept && found == 0 ? held : failed;
}

/// Exit 0 where no right sampler is accused more often than was promised.
int check_right(const CheckFlags& flags, Watch& watch) {
    const RightLaw law = measure_right(flags.first, flags.right, rigour_of(flags), watch);
    std::string text;
    for (const std::string& line : law.said) text += line;
    print(text + right_law_text(law));
    return keeps_promise(law) ? held : failed;
}

/// A program that never came to be judged.
Judgement complaint(const SubjectFault& fault, const CheckFlags& flags) {
    Judgement j;
    j.alpha = flags.alpha;
    j.state = dynamic_cast<const SubjectTooSlow*>(&fault) ? State::inconclusive : State::error;
    for (std::string_view name : verdict_names) {
        Verdict v;
        v.arm = printable(flags.exec.empty() ? flags.plugin : flags.exec, 60);
        v.trial = "start";
        v.name = name;
        v.state = j.state;
        v.say = name == "valid" ? "The sampler never came to be judged: " + std::string(fault.what()) + "."
                                : "It could not be asked: the sampler never came to be judged.";
        v.expected = false;
        j.verdicts.push_back(v);
    }
    j.as_expected = false;
    return j;
}

}  // namespace

int check(const CheckFlags& flags) {
    Progress watch(flags.quiet ? Progress::Style::silent : Progress::fitting());
    StopOnSignal stop(watch);
    try_files(flags);
    if (flags.error_rates > 0) return check_error_rates(flags, watch);
    if (flags.right > 0) return check_right(flags, watch);
    if (flags.planted) return check_planted(flags, watch);
    Judgement j;
    try {
        const std::vector<Trial> trials = trials_for(flags, watch);
        j = judge(trials, rigour_of(flags), watch);
    } catch (const SubjectFault& fault) { j = complaint(fault, flags); }
    watch.clear();
    const bool whole_list = flags.arm.empty() && flags.exec.empty() && flags.plugin.empty() && flags.samples.empty();
    if (whole_list) j.state = j.as_expected ? State::right : State::wrong;  // the question is whether the list is right
    print(verdict_table(j));
    if (whole_list)
        print(j.as_expected ? "every arm gets the verdicts that the list expects\n"
                            : "not every arm gets the verdicts that the list expects\n");
    write_files(flags, j);
    return exit_of(j.state);
}

}  // namespace crescent::cli
