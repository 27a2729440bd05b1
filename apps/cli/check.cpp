// `crescent check`: samplers checked alone.
#include "check.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <set>
#include <stdexcept>

#include <unistd.h>

#include "commands.h"
#include "crescent/crescent.h"
#include "memory.h"
#include "progress.h"
#include "repro.h"
#include "sampler_flags.h"
#include "sampler_place.h"
#include "signals.h"
#include "terminal.h"

namespace crescent::cli {

namespace {

double number_in(const std::string& text, const std::string& what) {
    double v = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), v);
    if (error != std::errc{} || end != text.data() + text.size() || text.empty())
        throw InputError({what, 0, 0}, "expected a number, not '" + text + "'");
    return v;
}

Settings settings_of(const CheckFlags& flags) {
    Settings out;
    const std::map<std::string, std::pair<double, double>> ranges = {
        {"s", {1e-3, 1e6}}, {"alpha", {1e-4, 1}}, {"rho_d", {0, 1}}, {"rho_s", {0, 1}}};
    for (const std::string& word : flags.settings) {
        const std::size_t equals = word.find('=');
        const std::string key = word.substr(0, equals);
        if (equals == std::string::npos || !ranges.count(key))
            throw InputError({"--set " + word, 0, 0},
                "expected s=, alpha=, rho_d= or rho_s= and a number" +
                    did_you_mean(key, {"s", "alpha", "rho_d", "rho_s"}));
        const double v = number_in(word.substr(equals + 1), "--set " + word);
        const auto [low, high] = ranges.at(key);
        if (!(v >= low && v <= high))
            throw InputError(
                {"--set " + word, 0, 0}, key + " is at least " + shortest(low) + " and at most " + shortest(high));
        out[key] = v;
    }
    return out;
}

/// The texts between the commas of a text.
std::vector<std::string> parts_of(const std::string& text) {
    std::vector<std::string> out;
    for (std::size_t begin = 0; begin != std::string::npos;) {
        const std::size_t comma = text.find(',', begin);
        out.push_back(text.substr(begin, comma == std::string::npos ? comma : comma - begin));
        begin = comma == std::string::npos ? comma : comma + 1;
    }
    return out;
}

/// Parses x,y,z, or degrees from the normal and about it; on either side of the surface.
Vec3d direction_of(const std::string& text) {
    std::vector<double> v;
    for (const std::string& part : parts_of(text)) v.push_back(number_in(part, "--wo " + text));
    if (v.size() > 3)
        throw InputError({"--wo " + text, 0, 0}, "expected x,y,z, or degrees from the normal and about it: 60,250");
    if (v.size() < 3) {
        if (!(v[0] >= 0 && v[0] <= 180 && v[0] != 90))
            throw InputError({"--wo " + text, 0, 0}, "expected 0 to 180 degrees from the normal, and not 90");
        if (v.size() > 1 && !(std::fabs(v[1]) <= 360))
            throw InputError({"--wo " + text, 0, 0}, "expected -360 to 360 degrees about the normal");
        return tilt(v[0], v.size() > 1 ? v[1] : 0);
    }
    const Vec3d w{v[0], v[1], v[2]};
    const double size = length(w);
    if (!(size > 0.99 && size < 1.01) || w.z == 0)
        throw InputError({"--wo " + text, 0, 0}, "expected a unit vector off the horizon, z not 0");
    return normalize(w);
}

/// A w_o below the surface is valid only for a sampler that supports both sides.
void check_sides(const CheckFlags& flags, const Traits& traits) {
    for (const std::string& text : flags.wo)
        if (direction_of(text).z < 0 && traits.wo != Traits::WoDomain::both)
            throw InputError({"--wo " + text, 0, 0},
                "is below the surface, which the sampler does not support: 0 to less than 90 degrees from the "
                "normal, z > 0 (a program for both sides declares wo=both)");
}

/// --light: f is the radiance of a light, whose irradiance is then the integral of f cos.
void check_light(const CheckFlags& flags, const Traits& traits, bool has_f) {
    if (flags.light && (traits.wo != Traits::WoDomain::none || !has_f))
        throw InputError({"--light", 0, 0},
            "expected a light: a sampler that takes no w_o and has its radiance as f (a program declares wo=none; in "
            "Python crescent.Sampler(sample, pdf, radiance=radiance))");
}

/// Returns the w_o of --wo; empty: the default list.
Grid grid_of(const CheckFlags& flags) {
    Grid out;
    for (const std::string& text : flags.wo) {
        const Vec3d w = direction_of(text);
        // 60 for 60, not 60.00000000000001
        const auto round_angle = [](double v) { return std::round(v * 1e9) / 1e9; };
        const double theta = round_angle(math::acos(std::clamp(w.z, -1.0, 1.0)) * 180 / pi),
                     turn = round_angle(math::atan2(w.y, w.x) * 180 / pi);
        out.emplace_back(theta, theta == 0 ? 0 : turn < 0 ? turn + 360 : turn);
    }
    return out;
}

}  // namespace

std::string shortest(double v) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", v);
    return text;
}

TestSettings test_settings_of(const CheckFlags& flags) {
    TestSettings settings = flags.full ? TestSettings::thorough() : TestSettings::quick();
    if (!(flags.alpha > 0 && flags.alpha < 1)) throw InputError({"--alpha", 0, 0}, "is between 0 and 1");
    settings.alpha = flags.alpha;
    settings.seed = flags.seed;
    settings.pictures = !flags.html.empty() || !flags.json.empty();
    settings.accept_few = flags.accept_few;
    return settings;
}

namespace {

/// The time of a program, and of a combination, in all.
double seconds_of(const CheckFlags& flags) {
    if (flags.patience > 0) return flags.patience;
    return flags.full ? 3600 : PipeLimits().total_seconds;
}

}  // namespace

PipeLimits limits_of(const CheckFlags& flags, const ProgressMonitor& monitor) {
    PipeLimits limits;
    limits.stop = &monitor.stop;
    limits.total_seconds = seconds_of(flags);
    limits.limit_answers(flags.timeout);
    return limits;
}

int exit_of(State state, const CheckFlags& flags) {
    return state == State::inconclusive && flags.allow_inconclusive ? passed : exit_of(state);
}

int exit_of(State state) {
    return state == State::wrong       ? failed
        : state == State::error        ? unwritable
        : state == State::inconclusive ? inconclusive
                                       : passed;
}

namespace {

/// An arm of an experiment: the samplers of the other arms are not started. `flag` is the one that names it.
std::vector<CheckCase> cases_of_arm(const CheckFlags& flags, const std::string& name, const char* flag) {
    const Experiment experiment = load(flags.arm, flags.settings);
    if (flags.no_code) refuse_code(experiment);
    return arm_cases(experiment, name, open_external(with_arms_of(experiment, {name}), flags.timeout),
        {.pixels = flags.pixels, .full = flags.full, .wo = grid_of(flags), .flag = flag, .seconds = seconds_of(flags)});
}

std::vector<CheckCase> cases_of_experiment(const CheckFlags& flags) {
    if (flags.sampler.empty())
        throw InputError({"crescent check " + flags.arm, 0, 0},
            "expected --sampler NAME with an experiment: an arm of it, or a built-in sampler");
    check_sides(flags, {});
    return cases_of_arm(flags, flags.sampler, "--sampler");
}

bool is_experiment(const CheckFlags& flags) { return flags.arm.ends_with(".toml"); }

/// The value of --domain.
std::optional<Domain> domain_of(const CheckFlags& flags) {
    if (flags.domain.empty()) return {};
    const std::optional<Domain> domain = Domain::read(flags.domain);
    if (!domain) throw InputError({"--domain " + flags.domain, 0, 0}, Domain::refusal(flags.domain));
    return domain;
}

/// The sampler in a Python file or of a SamplerFlag; null if there is none.
std::shared_ptr<const SamplerAdapter> sampler_of(const CheckFlags& flags, const ProgressMonitor& monitor) {
    const bool is_python = names_python_sampler(flags.arm);
    if (is_python && !flags.settings.empty())
        throw InputError({"--set " + flags.settings.front(), 0, 0},
            "is for built-in samplers, and " + flags.arm + " has its own parameters");
    const int neighbours = flags.neighbours > 0 ? flags.neighbours : default_neighbours;
    std::shared_ptr<const SamplerAdapter> out;
    if (is_python) out = start_python_sampler(flags.arm, limits_of(flags, monitor), neighbours);
    else if (const SamplerFlag* flag = given_flag(flags))
        out = flag->open(flags.sampler_of(flag->name),
            {.limits = limits_of(flags, monitor), .domain = domain_of(flags), .neighbours = neighbours});
    if (out && flags.neighbours > 0 && out->traits().neighbours == 0)
        throw InputError({"--neighbours", 0, 0},
            "is for a sampler that merges reservoirs: weight=reciprocal merge=yes in the handshake, merge = True in a "
            "Python file");
    return out;
}

/// An estimator of a number, which has no w_o.
CheckCase number_case(const std::shared_ptr<const SamplerAdapter>& estimator) {
    CheckCase out;
    out.arm = estimator->name();
    out.adapter = estimator;
    return out;
}

}  // namespace

std::array<double, 3> expected_values(const CheckFlags& flags, int channels) {
    std::vector<double> values;
    try {
        for (const std::string& text : parts_of(flags.estimates)) values.push_back(constant_value(text));
    } catch (const std::invalid_argument& e) { throw InputError({"--estimates " + flags.estimates, 0, 0}, e.what()); }
    if (values.size() != 1 && (values.size() != 3 || channels != 3))
        throw InputError({"--estimates " + flags.estimates, 0, 0},
            channels == 3 ? "expected one value, or one for each of three channels" : "expected one value");
    return {values.front(), values[values.size() / 2], values.back()};
}

namespace {

/// The sampler of --against by the form of its name: a Python file, a shader, a plugin, else a program.
std::shared_ptr<const SamplerAdapter> start_other(const CheckFlags& flags, const ProgressMonitor& monitor) {
    const std::string& name = flags.against;
    const PipeLimits limits = limits_of(flags, monitor);
    if (name.find(' ') == std::string::npos) {
        if (names_python_sampler(name)) return start_python_sampler(name, limits);
        if (names_shader(name)) return start_shader(name, {}, limits);
        for (const SamplerFlag& flag : sampler_flags())
            if (flag.fits(name)) return flag.open(name, {limits});
    }
    try {
        return start_pipe(name, limits);
    } catch (const InputError&) {  // start_pipe calls it --exec
        throw InputError({"--against " + name, 0, 0}, "neither a built-in arm nor a command of the shell");
    }
}

/// An estimator of a number against its expected value, or against another estimator.
CheckResult check_of_number(
    const CheckFlags& flags, const std::shared_ptr<const SamplerAdapter>& estimator, Progress& monitor) {
    if (flags.estimates.empty() == flags.against.empty())
        throw InputError({"crescent check " + estimator->name(), 0, 0},
            "draws values: expected either --estimates VALUE, their mean, or --against an estimator of the same "
            "number");
    check::ExpectedMean expected;
    if (!flags.estimates.empty()) expected.value = expected_values(flags, estimator->traits().channels);
    else {
        expected.estimator = start_other(flags, monitor);
        if (!expected.estimator->traits().number ||
            expected.estimator->traits().channels != estimator->traits().channels)
            throw InputError({"--against " + flags.against, 0, 0}, "draws no values of as many channels");
    }
    return check::check_number(estimator, expected, test_settings_of(flags), monitor);
}

/// The options of the shader, as words of its host. `value`: that of --over.
std::vector<std::string> shader_words(const CheckFlags& flags, const std::string& value = "") {
    std::vector<std::string> out;
    for (const auto& [flag, values] : flags.shader)
        for (const std::string& text : values) out.push_back(flag + (flag.starts_with("--") ? "=" : "") + text);
    for (const std::string& text : flags.settings) out.push_back("--set=" + text);
    if (!flags.domain.empty()) out.push_back("--domain=" + flags.domain);
    if (!value.empty()) {
        const std::string name = flags.over.substr(0, flags.over.find('='));
        out.push_back("--set=" + name + "=" + value);
        out.push_back(fmt::format("--name={} {} {}", std::filesystem::path(flags.arm).stem().string(), name, value));
    }
    return out;
}

/// The values of --over NAME=V1,V2,...; without it one that is empty.
std::vector<std::string> values_over(const CheckFlags& flags) {
    if (flags.over.empty()) return {""};
    const std::size_t equals = flags.over.find('=');
    if (equals == std::string::npos || equals == 0)
        throw InputError({"--over " + flags.over, 0, 0}, "expected NAME=VALUE,VALUE,...: alpha=0.01,0.1");
    const std::vector<std::string> out = parts_of(flags.over.substr(equals + 1));
    for (const std::string& value : out) number_in(value, "--over " + flags.over);
    return out;
}

/// A shader, at each value of --over: all under one alpha.
std::vector<CheckCase> cases_of_shader(const CheckFlags& flags, const ProgressMonitor& monitor) {
    std::vector<CheckCase> out;
    const std::vector<std::string> values = values_over(flags);
    PipeLimits limits = limits_of(flags, monitor);
    limits.total_seconds *= static_cast<double>(values.size());  // each one waits for those before it
    for (const std::string& value : values) {
        const auto adapter = start_shader(flags.arm, shader_words(flags, value), limits, values.size());
        check_sides(flags, adapter->traits());
        check_light(flags, adapter->traits(), adapter->has_f());
        for (CheckCase& t : make_user_cases(adapter, flags.full, grid_of(flags))) out.push_back(std::move(t));
    }
    return out;
}

/// The options of a shader are for a shader alone.
void check_shader_options(const CheckFlags& flags) {
    if (names_shader(flags.arm)) {
        if (flags.domain == "number") throw InputError({"--domain number", 0, 0}, "is for programs and Python, so far");
        return;
    }
    if (!flags.domain.empty() && flags.exec().empty() && flags.samples.empty())
        throw InputError({"--domain", 0, 0}, "needs --exec, --samples or a shader");
    std::string shader_flag = flags.over.empty() ? "" : "--over";
    for (const auto& [flag, values] : flags.shader)
        if (!values.empty() && flag != "--device") shader_flag = flag;
    if (!shader_flag.empty())
        throw InputError({shader_flag, 0, 0}, "needs a shader: FILE.wgsl, FILE.glsl, FILE.hlsl or FILE.slang");
}

/// Replaces this process by the host of shaders, which prints the adapters.
int list_adapters() {
    const std::string command = "exec " + python_command("crescent_shader", {"--device=list"});
    ::execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    print_to_stderr("crescent check: cannot start /bin/sh\n");
    return unwritable;
}

/// The draws of --samples: directions at one w_o, or points of a domain.
CheckCase case_of_file(const CheckFlags& flags) {
    const std::optional<Domain> domain = domain_of(flags);
    if (domain && !domain->is_direction()) {
        if (!flags.wo.empty())
            throw InputError({"--wo " + flags.wo[0], 0, 0}, "is for directions, and the domain is " + domain->name());
        if (flags.table.empty()) throw InputError({"--samples", 0, 0}, "needs --pdf-table FILE");
        return make_user_case(read_point_file(*domain, flags.samples, flags.table), 0, 0);
    }
    if (flags.wo.size() != 1 || flags.table.empty())
        throw InputError({"--samples", 0, 0}, "needs --wo x,y,z and --pdf-table FILE");
    const Vec3d wo = direction_of(flags.wo[0]);
    CheckCase t = make_user_case(std::make_shared<SampleFile>(flags.samples, flags.table),
        math::acos(std::min(wo.z, 1.0)) * 180 / pi, math::atan2(wo.y, wo.x) * 180 / pi);
    t.wo = wo;
    return t;
}

std::vector<CheckCase> cases_for(const CheckFlags& flags, const ProgressMonitor& monitor) {
    if (is_experiment(flags)) return cases_of_experiment(flags);
    if (!flags.sampler.empty() || flags.pixels > 0)
        throw InputError({flags.sampler.empty() ? "--pixels" : "--sampler", 0, 0},
            "needs an experiment: crescent check FILE.toml --sampler NAME");
    if (names_shader(flags.arm)) return cases_of_shader(flags, monitor);
    if (const auto adapter = sampler_of(flags, monitor)) {
        if (adapter->traits().number) return {number_case(adapter)};
        check_sides(flags, adapter->traits());
        check_light(flags, adapter->traits(), adapter->has_f());
        return make_user_cases(adapter, flags.full, grid_of(flags));
    }
    if (flags.light) throw InputError({"--light", 0, 0}, "needs a sampler of your own");
    check_sides(flags, {});
    if (flags.samples.empty()) return make_cases(flags.arm, settings_of(flags), flags.full, grid_of(flags));
    return {case_of_file(flags)};
}

/// The sampler as the command line names it.
std::string given_sampler(const CheckFlags& flags) {
    const SamplerFlag* flag = given_flag(flags);
    return flag ? flags.sampler_of(flag->name) : flags.arm;
}

/// Writes the script, or says why there is none.
void write_repro(const CheckFlags& flags, std::span<const CheckCase> check_cases, const CheckResult& result) {
    if (flags.repro.empty()) return;
    std::string reason = why_no_repro(flags, check_cases, result);
    try {
        if (const std::optional<std::string> script = repro_script(flags, check_cases, result))
            return write_whole(flags.repro, *script);
    } catch (const SamplerError& e) { reason = e.what(); }
    print_to_stderr(fmt::format("--repro: {} is not written: {}\n", flags.repro, reason));
}

/// --patience and --accept-few are for programs, a Python interpreter among them, and for arms of experiments.
void check_limits(const CheckFlags& flags) {
    if (!flags.repro.empty() && (is_experiment(flags) || (flags.exec().empty() && !names_python_sampler(flags.arm))))
        throw InputError({"--repro", 0, 0}, "needs --exec or a sampler in a Python file");
    if (flags.neighbours > 0 && flags.exec().empty() && !names_python_sampler(flags.arm))
        throw InputError({"--neighbours", 0, 0}, "needs --exec or a sampler in a Python file");
    const SamplerFlag* sampler_flag = given_flag(flags);
    if ((sampler_flag && sampler_flag->is_limited) || names_python_sampler(flags.arm) || names_shader(flags.arm) ||
        is_experiment(flags))
        return;
    for (const auto& [flag, is_given] :
        {std::pair("--patience", flags.patience > 0), {"--accept-few", flags.accept_few}})
        if (is_given)
            throw InputError({flag, 0, 0}, "needs --exec, an experiment, or a sampler in a Python file or a shader");
}

bool whole_list(const CheckFlags& flags) { return flags.arm.empty() && !given_flag(flags) && flags.samples.empty(); }

/// Right if each verdict is the expected one; inconclusive if others were only not decided.
State state_of_list(const CheckResult& result) {
    if (result.as_expected) return State::right;
    const bool is_undecided = result.unmet.empty() && std::ranges::all_of(result.verdicts, [](const Verdict& v) {
        return v.waived || v.expected || v.state == State::inconclusive;
    });
    return is_undecided ? State::inconclusive : State::wrong;
}

/// With hundreds of cases, each ends at the first stage that leaves nothing open.
TestSettings settings_of_list(const CheckFlags& flags) {
    TestSettings settings = test_settings_of(flags);
    settings.budget = flags.full ? check::CheckBudget::thorough() : check::CheckBudget::quick();
    settings.budget->stop_when_conclusive = !flags.full;
    return settings;
}

/// Returns the command that repeats the check. The output files are omitted, so that equal calls state equal commands.
std::string command_of(const CheckFlags& f) {
    std::string out = "crescent check";
    if (!f.arm.empty()) out += " " + shell_word(f.arm);
    if (!f.sampler.empty()) out += " --sampler " + shell_word(f.sampler);
    if (f.pixels > 0) out += fmt::format(" --pixels {}", f.pixels);
    if (f.neighbours > 0) out += fmt::format(" --neighbours {}", f.neighbours);
    if (f.light) out += " --light";
    if (!f.domain.empty()) out += " --domain " + shell_word(f.domain);
    if (!f.estimates.empty()) out += " --estimates " + shell_word(f.estimates);
    for (const std::string& text : f.settings) out += " --set " + shell_word(text);
    for (const auto& [flag, values] : f.shader)
        for (const std::string& text : values) out += " " + flag + " " + shell_word(text);
    if (!f.over.empty()) out += " --over " + shell_word(f.over);
    if (const SamplerFlag* flag = given_flag(f))
        out += std::string(" --") + flag->name + " " + shell_word(f.sampler_of(flag->name));
    for (const auto& [flag, value] :
        {std::pair("--samples", &f.samples), {"--pdf-table", &f.table}, {"--against", &f.against}})
        if (!value->empty()) out += std::string(" ") + flag + " " + shell_word(*value);
    for (const std::string& text : f.wo) out += " --wo " + shell_word(text);
    for (const std::string& text : f.expect) out += " --expect " + shell_word(text);
    for (const auto& [flag, is_given] :
        {std::pair("--full", f.full), {"--planted", f.planted}, {"--describe", f.describe},
            {"--accept-few", f.accept_few}, {"--allow-inconclusive", f.allow_inconclusive}})
        if (is_given) out += std::string(" ") + flag;
    if (f.patience > 0) out += " --patience " + shortest(f.patience);
    if (f.timeout > 0) out += " --timeout " + shortest(f.timeout);
    if (f.alpha != 1e-3) out += " --alpha " + shortest(f.alpha);
    if (f.seed != 1) out += " --seed " + std::to_string(f.seed);
    return out;
}

/// Opens every file before the first draw, so that minutes of work are not lost to a missing folder.
void try_files(const CheckFlags& flags) {
    std::vector<std::string> inputs = {flags.samples, flags.table};
    for (const SamplerFlag& flag : sampler_flags())
        if (flag.is_file) inputs.push_back(flags.sampler_of(flag.name));
    for (const std::string& sampler : {flags.arm, flags.against})
        inputs.emplace_back(sampler.ends_with(".toml") || names_shader(sampler) ? sampler : python_file(sampler));
    inputs.insert(inputs.end(), flags.expect.begin(), flags.expect.end());
    claim_outputs(
        with_reports({{"--json", flags.json}, {"--html", flags.html}, {"--repro", flags.repro}}, flags.reports),
        inputs);
}

}  // namespace

void write_files(const CheckFlags& flags, const CheckResult& result) {
    const ResultSource source{crescent::version(), crescent::commit(), command_of(flags)};
    if (!flags.json.empty()) write_whole(flags.json, verdict_json(result, source));
    write_reports(flags.reports, verdict_report(result, place_of_sampler(flags), source.version));
    if (!flags.html.empty()) write_whole(flags.html, verdict_html(result, source));
}

namespace {

/// Logs how many queries a program will receive, before a long run.
void log_cost(std::span<const CheckCase> check_cases, const TestSettings& settings, ProgressMonitor& monitor) {
    std::size_t case_count = 0;
    bool has_program = false, has_light = false;
    for (const CheckCase& t : check_cases) {
        case_count += !t.baseline;
        has_program = has_program || t.adapter->limited();
        has_light = has_light || t.adapter->traits().wo == Traits::WoDomain::none;
    }
    if (!has_program || !settings.full) return;
    const char* table_note = has_light ? ", and for each texel where p is a table, of up to ten million" : "";
    monitor.log(fmt::format("--full makes at most {} queries: {} at each of {} w_o{}", case_count * settings.questions,
        settings.questions, case_count, table_note));
}

/// Logs which device evaluates each sampler, where one is declared.
void log_devices(std::span<const CheckCase> check_cases, ProgressMonitor& monitor) {
    DevicesByArm devices;
    for (const CheckCase& t : check_cases)
        if (t.adapter) add_device(t.arm, *t.adapter, devices);
    for (const auto& [arm, device] : devices)
        monitor.log(fmt::format("{} is evaluated on {}", printable(arm), device.text()));
}

std::vector<std::string> names_of(std::span<const CheckCase> check_cases) {
    std::vector<std::string> out;
    for (const CheckCase& t : check_cases)
        if (!t.baseline && std::find(out.begin(), out.end(), t.arm) == out.end()) out.push_back(t.arm);
    return out;
}

/// Describes the distribution of the draws; gives no verdict.
int describe_draws(const CheckFlags& flags, std::span<const CheckCase> check_cases, Progress& monitor) {
    for (const CheckCase& t : check_cases)
        if (t.adapter->traits().domain) throw InputError({"--describe", 0, 0}, "is for samplers of directions");
    check::DescribeSettings settings;
    settings.seed = flags.seed;
    if (flags.full) {
        settings.draws *= 16;
        settings.limited_draws *= 16;
    }
    const std::vector<check::Description> descriptions = check::describe(check_cases, settings, monitor);
    monitor.clear();
    std::string text;
    for (const check::Description& d : descriptions) text += check::description_text(d) + "\n";
    print(text);
    if (!flags.json.empty()) {
        const nlohmann::ordered_json out = {{"format", "crescent check descriptions 1"},
            {"version", crescent::version()}, {"commit", crescent::commit()}, {"command", command_of(flags)},
            {"descriptions", check::description_json(descriptions)}};
        write_whole(flags.json, out.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    }
    return passed;
}

}  // namespace

namespace {

/// "2.1 s, 3.9 s of CPU time, 45 MB of memory at most; 9,700,000 evaluations ..."
std::string cost_of(const CheckResult& result, double seconds) {
    std::set<std::pair<std::string, std::string>> cases;
    for (const Verdict& v : result.verdicts) cases.insert({v.arm, v.check_case});
    const Usage process_usage = usage();
    const double evaluations_per_case =
        static_cast<double>(result.evaluations) / static_cast<double>(std::max<std::size_t>(cases.size(), 1));
    return fmt::format(
        "{:.1f} s, {:.1f} s of CPU time, {:.0f} MB of memory at most; {} evaluations of sample, pdf and f, {:.0f} in "
        "the "
        "mean of {} cases\n",
        seconds, process_usage.cpu_seconds, static_cast<double>(process_usage.peak_memory) / 1e6, result.evaluations,
        evaluations_per_case, cases.size());
}

}  // namespace

void print_verdicts(const CheckResult& result, bool verbose) {
    if (verbose || !one_sampler(result)) return print(verdict_table(result));
    const Terminal terminal = terminal_of_stdout();
    print_marked(screen_of(result, terminal.columns), terminal);
}

int check(const CheckFlags& call_flags) {
    CheckFlags flags = call_flags;
    std::vector<std::string*> files = {&flags.json, &flags.html, &flags.repro};
    for (auto& [format, file] : flags.reports) files.push_back(&file);
    for (std::string* file : files)  // a sampler may call chdir
        if (!file->empty()) *file = std::filesystem::absolute(*file).string();
    const Stopwatch watch;
    Progress monitor(flags.quiet ? Progress::Style::silent : Progress::fitting());
    StopOnSignal stop(monitor);
    keep_freed_memory();
    check_limits(flags);
    check_shader_options(flags);
    if (const auto device = flags.shader.find("--device");
        device != flags.shader.end() && device->second == std::vector<std::string>{"list"})
        return list_adapters();
    try_files(flags);
    if (flags.planted) return check_planted(flags, monitor);
    CheckResult result;
    std::vector<std::string> expected = flags.expect;
    const bool expects_same = std::erase(expected, "same") > 0;
    if (expects_same && flags.against.empty()) throw InputError({"--expect same", 0, 0}, "needs --against");
    const std::vector<Waiver> waivers = read_waivers(expected);
    try {
        const std::vector<CheckCase> check_cases = cases_for(flags, monitor);
        check_waivers(waivers, names_of(check_cases));
        log_devices(check_cases, monitor);
        const bool is_number = check_cases.front().adapter && check_cases.front().adapter->traits().number;
        if (is_number) {
            if (flags.describe) throw InputError({"--describe", 0, 0}, "is for samplers of directions and points");
            result = check_of_number(flags, check_cases.front().adapter, monitor);
        } else {
            if (!flags.estimates.empty())
                throw InputError({"--estimates", 0, 0},
                    "needs a sampler whose draws are values: domain=number in its handshake, or in Python");
            if (flags.describe) return describe_draws(flags, check_cases, monitor);
            if (!flags.against.empty()) return check_against(flags, check_cases, waivers, expects_same, monitor);
            log_cost(check_cases, test_settings_of(flags), monitor);
            result =
                run_checks(check_cases, whole_list(flags) ? settings_of_list(flags) : test_settings_of(flags), monitor);
        }
        write_repro(flags, check_cases, result);
    } catch (const SamplerError& fault) { result = unchecked_result(fault, flags, given_sampler(flags)); }
    if (!waivers.empty()) waive(result, waivers);
    monitor.clear();
    const bool is_list = whole_list(flags);
    if (is_list) result.state = state_of_list(result);
    print_verdicts(result, flags.verbose);
    if (flags.verbose) print(cost_of(result, watch.seconds()));
    if (is_list)
        print(result.as_expected ? "every sampler gets the verdicts expected of it\n"
                : result.state == State::inconclusive
                ? "every verdict that was decided is the expected one; --full decides more\n"
                : "not every sampler gets the verdicts expected of it\n");
    write_files(flags, result);
    return exit_of(result.state, flags);
}

// ---- `crescent check A --against B`, and the report for a program that could not be checked.

CheckResult unchecked_result(const SamplerError& fault, const CheckFlags& flags, const std::string& command) {
    CheckResult result;
    result.alpha = flags.alpha;
    result.state = dynamic_cast<const SamplerTimeout*>(&fault) ? State::inconclusive : State::error;
    for (std::string_view name : verdict_names) {
        Verdict v;
        v.arm = printable(command, 60);
        v.check_case = before_any_case;
        v.name = name;
        v.state = result.state;
        v.sentences = {name == verdict_names[0]
                ? Sentence{"failure", "The sampler could not be checked: " + std::string(fault.what()) + "."}
                : Sentence{"not evaluated", "It could not be queried: the sampler was not checked."}};
        v.expected = false;
        result.verdicts.push_back(v);
    }
    result.as_expected = false;
    return result;
}

namespace {

/// Returns B on the cases of A: of an experiment another arm, else a built-in sampler by its name, or a program.
std::vector<CheckCase> others_of(
    const CheckFlags& flags, std::span<const CheckCase> a, const ProgressMonitor& monitor) {
    if (is_experiment(flags)) {
        std::vector<CheckCase> out = cases_of_arm(flags, flags.against, "--against");
        std::erase_if(out, [](const CheckCase& t) { return t.baseline; });
        return out;
    }
    const std::vector<std::string> names = sampler_names();
    if (std::find(names.begin(), names.end(), flags.against) != names.end())
        return sampler_named_against(flags.against, a);
    const std::string suggestion = did_you_mean(flags.against, names);
    if (!suggestion.empty() && flags.against.find_first_of(" /") == std::string::npos)  // a name, not a command
        throw InputError({"--against " + flags.against, 0, 0}, "no built-in arm" + suggestion);
    for (const char* extension : {".csv", ".npy"})
        if (flags.against.ends_with(extension) && flags.against.find(' ') == std::string::npos)
            throw InputError({"--against " + flags.against, 0, 0},
                "is a file of samples, which has no p and f elsewhere: give it as --samples FILE, and --against an arm "
                "or a program");
    return sampler_against(start_other(flags, monitor), a);
}

}  // namespace

int check_against(const CheckFlags& flags, std::vector<CheckCase> a, std::span<const Waiver> waivers, bool expects_same,
    Progress& monitor) {
    std::erase_if(a, [](const CheckCase& t) { return t.baseline; });
    std::vector<CheckCase> b;
    try {
        b = others_of(flags, a, monitor);
    } catch (const SamplerError& fault) {  // B's own: A has responded
        const CheckResult result = unchecked_result(fault, flags, flags.against);
        monitor.clear();
        print_verdicts(result, flags.verbose);
        write_files(flags, result);
        return exit_of(result.state, flags);
    }
    log_devices(b, monitor);
    CheckResult result = compare_samplers(a, b, test_settings_of(flags), expects_same, monitor);
    if (!waivers.empty()) waive(result, waivers);
    monitor.clear();
    print(against_text(result));
    write_files(flags, result);
    return exit_of(result.state, flags);
}

}  // namespace crescent::cli
