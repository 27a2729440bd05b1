// The members of each picture are listed once, for both directions. JSON has no NaN and no infinity; they are null.
#include "check/report/result_json.h"

#include <concepts>
#include <fmt/format.h>
#include <limits>

#include "base/errors.h"
#include "check/report/print.h"
#include "output/stored_json.h"

namespace crescent {

namespace {

constexpr const char* format_name = "crescent check 3";
constexpr const char* what_is_read = "what crescent check --json writes";

// ---- Pictures: each visits its members with their keys.

template <class Picture, class Of>
concept PictureOf = std::same_as<std::remove_const_t<Picture>, Of>;

template <PictureOf<BinHistogram> Picture> void visit_members(Picture& m, const auto& visit) {
    visit("arm", m.arm);
    visit("case", m.check_case);
    visit("coordinates", m.coordinates);
    visit("rings", m.rings);
    visit("sectors", m.sectors);
    visit("observed", m.observed);
    visit("expected", m.expected);
    visit("standard_deviation", m.sd);
    visit("ring_edges", m.edges);
    visit("sector_edges", m.sector_edges);
    visit("full_scale", m.full_scale);
    visit("ring_labels", m.ring_labels);
    visit("sector_labels", m.sector_labels);
    visit("ring_axis", m.ring_axis);
    visit("sector_axis", m.sector_axis);
}

template <PictureOf<LineHistogram> Picture> void visit_members(Picture& h, const auto& visit) {
    visit("arm", h.arm);
    visit("case", h.check_case);
    visit("axis", h.axis);
    visit("edges", h.edges);
    visit("observed", h.observed);
    visit("expected", h.expected);
    visit("entries", h.entries);
}

template <PictureOf<WeightHistogram> Picture> void visit_members(Picture& w, const auto& visit) {
    visit("arm", w.arm);
    visit("case", w.check_case);
    visit("log10_edges", w.log10_edges);
    visit("counts", w.counts);
    visit("zeros", w.zeros);
    visit("k", w.k);
    visit("exceedances", w.exceedances);
    visit("threshold", w.threshold);
    visit("sigma", w.sigma);
    visit("plane_of_incidence_p", w.rose_p);
    visit("plane_of_incidence_f", w.rose_f);
}

/// Whether the lists of a picture that was read have the lengths that its page expects.
bool is_whole(const BinHistogram& m) {
    constexpr int largest_side = 4096;
    if (m.rings < 1 || m.sectors < 1 || m.rings > largest_side || m.sectors > largest_side) return false;
    const std::size_t bins = static_cast<std::size_t>(m.rings) * static_cast<std::size_t>(m.sectors);
    const auto fits = [&](const std::vector<double>& list) { return list.empty() || list.size() == bins; };
    return m.observed.size() == bins && fits(m.expected) && fits(m.sd);
}
bool is_whole(const LineHistogram& h) {
    return !h.observed.empty() && h.edges.size() == h.observed.size() + 1 &&
        (h.expected.empty() || h.expected.size() == h.observed.size());
}
bool is_whole(const WeightHistogram& w) {
    return w.log10_edges.size() == (w.counts.empty() ? 0 : w.counts.size() + 1) && w.rose_p.size() == w.rose_f.size();
}

template <class Picture> Json pictures_json(const std::vector<Picture>& pictures) {
    Json out = Json::array();
    for (const Picture& picture : pictures) {
        Json& entry = out.emplace_back(Json::object());
        visit_members(picture, [&](const char* key, const auto& value) {
            if (value != std::remove_cvref_t<decltype(value)>{}) entry[key] = value;
        });
    }
    return out;
}

// ---- Reading.

void read_value(const StoredJson& json, double& to) {
    to = json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}
void read_value(const StoredJson& json, std::vector<double>& to) {
    to.clear();
    for (const StoredJson& value : json.entries()) read_value(value, to.emplace_back());
}
template <class T> void read_value(const StoredJson& json, std::vector<T>& to) {
    to.clear();
    for (const StoredJson& value : json.entries()) to.push_back(value.get<T>());
}
void read_value(const StoredJson& json, auto& to) { json.get_to(to); }

/// Leaves `to` as it is if the object has no such member.
void read_member(const StoredJson& object, const char* key, auto& to) {
    if (object.contains(key)) read_value(object.at(key), to);
}

template <class Picture> std::vector<Picture> read_pictures(const StoredJson& list) {
    std::vector<Picture> out;
    for (const StoredJson& entry : list.entries()) {
        visit_members(out.emplace_back(), [&](const char* key, auto& value) { read_member(entry, key, value); });
        if (!is_whole(out.back())) entry.refuse("expected lists as long as the bins of the picture");
    }
    return out;
}

State state_named(const StoredJson& json) {
    const auto name = json.get<std::string>();
    for (const State s : {State::right, State::wrong, State::inconclusive, State::skipped, State::error})
        if (name == word(s)) return s;
    json.refuse("expected a state");
}

/// The rings of the density that draws imply.
std::optional<ImpliedDensity> implied_in(const StoredJson& evidence) {
    if (!evidence.contains("implied_rings")) return {};
    ImpliedDensity out;
    for (const StoredJson& row : evidence.at("implied_rings").at("rows").entries())
        out.rings.push_back(
            {row.at(0).get<double>(), row.at(1).get<double>(), row.at(2).get<double>(), row.at(3).get<double>()});
    const StoredJson peak = evidence.at("implied_peak");
    out.peak = peak.at("pdf").get<double>();
    out.peak_error = peak.at("standard_error").get<double>();
    return out;
}

/// Of a result without the list: its message as one sentence.
Sentences sentences_in(const StoredJson& verdict) {
    if (!verdict.contains("sentences")) return {{"", verdict.at("message").get<std::string>()}};
    Sentences out;
    for (const StoredJson& entry : verdict.at("sentences").entries()) {
        Sentence& sentence = out.emplace_back();
        entry.at("what").get_to(sentence.what);
        entry.at("text").get_to(sentence.text);
        read_member(entry, "technique", sentence.technique);
    }
    return out;
}

Verdict read_verdict(const StoredJson& json) {
    Verdict v;
    json.at("arm").get_to(v.arm);
    json.at("case").get_to(v.check_case);
    json.at("name").get_to(v.name);
    v.state = state_named(json.at("state"));
    v.sentences = sentences_in(json);
    json.at("expected").get_to(v.expected);
    v.evidence = json.at("evidence").value();
    const StoredJson evidence = json.at("evidence");
    read_member(json, "cause", v.cause);
    read_member(json, "status", v.next_step);
    read_member(json, "why_expected", v.why_expected);
    read_member(json, "waived", v.waived);
    read_member(json, "size", v.size);
    read_member(json, "no_sample", v.nothing);
    read_member(json, "below_with_pdf", v.outside);
    read_member(json, "place", v.place);
    read_member(json, "first_failure", v.first_failure);
    if (json.contains("w_o")) v.wo = json.at("w_o").get<std::pair<double, double>>();
    if (json.contains("integral")) v.integral = json.at("integral").get<double>();
    if (evidence.contains("would_have_found"))
        for (const auto& [kind, size] : evidence.at("would_have_found").items()) read_value(size, v.hidden[kind]);
    v.implied = implied_in(evidence);
    return v;
}

StoredResult stored_result(const StoredJson& json) {
    if (json.at("format").get<std::string>() != format_name)
        json.at("format").refuse(std::string("expected the format '") + format_name + "'");
    StoredResult out;
    read_member(json, "version", out.source.version);
    read_member(json, "commit", out.source.commit);
    read_member(json, "command", out.source.command);
    CheckResult& result = out.result;
    result.state = state_named(json.at("state"));
    json.at("as_expected").get_to(result.as_expected);
    json.at("alpha").get_to(result.alpha);
    json.at("tests").get_to(result.tests);
    json.at("failed_once").get_to(result.screened);
    json.at("failed_twice").get_to(result.confirmed);
    read_member(json, "questions", result.questions);
    read_member(json, "unmet_expectations", result.unmet);
    for (const StoredJson& l : json.at("left_out").entries())
        result.left_out.push_back({l.at("arm").get<std::string>(), l.at("case").get<std::string>(),
            l.at("verdicts").get<std::vector<std::string>>(), l.at("why").get<std::string>()});
    if (json.contains("devices"))
        for (const StoredJson& entry : json.at("devices").entries()) {
            EvaluationDevice& device =
                result.devices.emplace_back(entry.at("arm").get<std::string>(), EvaluationDevice{}).second;
            read_member(entry, "name", device.name);
            read_member(entry, "driver", device.driver);
            read_member(entry, "precision", device.precision);
        }
    for (const StoredJson& verdict : json.at("verdicts").entries()) result.verdicts.push_back(read_verdict(verdict));
    result.maps = read_pictures<BinHistogram>(json.at("maps"));
    result.lines = read_pictures<LineHistogram>(json.at("lines"));
    result.weights = read_pictures<WeightHistogram>(json.at("weights"));
    return out;
}

// ---- Writing.

Json cases_of(const CheckResult& result) {
    Json out = Json::array();
    for (const Verdict& v : result.verdicts)
        if (Json entry = {{"arm", v.arm}, {"case", v.check_case}}; out.empty() || out.back() != entry)
            out.push_back(std::move(entry));
    return out;
}

Json verdict_as_json(const Verdict& v) {
    Json out = {{"arm", v.arm}, {"case", v.check_case}, {"name", v.name}, {"state", word(v.state)},
        {"message", v.message()}, {"sentences", Json::array()}};
    for (const Sentence& sentence : v.sentences) {
        Json& entry = out["sentences"].emplace_back(Json{{"what", sentence.what}, {"text", sentence.text}});
        if (sentence.technique > 0) entry["technique"] = sentence.technique;
    }
    if (!v.cause.empty()) out["cause"] = v.cause;
    if (const std::string next = next_step_text(v); !next.empty()) out["status"] = next;
    out["expected"] = v.expected;
    if (!v.why_expected.empty()) out["why_expected"] = v.why_expected;
    if (v.waived) out["waived"] = true;
    if (v.wo) out["w_o"] = *v.wo;
    if (v.size != 0) out["size"] = v.size;
    if (v.nothing != 0) out["no_sample"] = v.nothing;
    if (v.outside != 0) out["below_with_pdf"] = v.outside;
    if (!v.place.empty()) out["place"] = v.place;
    if (v.first_failure) out["first_failure"] = true;
    if (v.integral) out["integral"] = *v.integral;
    out["evidence"] = v.evidence;
    return out;
}

}  // namespace

std::string verdict_json(const CheckResult& result, const ResultSource& source) {
    Json root = {{"format", format_name}};
    for (const auto& [key, value] :
        {std::pair("version", &source.version), {"commit", &source.commit}, {"command", &source.command}})
        if (!value->empty()) root[key] = *value;
    root["state"] = word(result.state);
    root["as_expected"] = result.as_expected;
    root["alpha"] = result.alpha;
    root["tests"] = result.tests;
    root["failed_once"] = result.screened;
    root["failed_twice"] = result.confirmed;
    if (result.questions > 0) root["questions"] = result.questions;
    for (const auto& [arm, device] : result.devices) {
        Json entry = {{"arm", arm}};
        for (const auto& [key, value] :
            {std::pair("name", &device.name), {"driver", &device.driver}, {"precision", &device.precision}})
            if (!value->empty()) entry[key] = *value;
        root["devices"].push_back(std::move(entry));
    }
    if (!result.unmet.empty()) root["unmet_expectations"] = result.unmet;
    root["requested"] = cases_of(result);
    root["left_out"] = Json::array();
    for (const SkippedCase& l : result.left_out)
        root["left_out"].push_back({{"arm", l.arm}, {"case", l.check_case}, {"verdicts", l.verdicts}, {"why", l.why}});
    root["verdicts"] = Json::array();
    for (const Verdict& v : result.verdicts) root["verdicts"].push_back(verdict_as_json(v));
    root["maps"] = pictures_json(result.maps);
    root["lines"] = pictures_json(result.lines);
    root["weights"] = pictures_json(result.weights);
    return root.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

StoredResult read_verdict_json(const std::string& text, const std::string& name) {
    return result_from_json(parse_json(text, name, what_is_read), name);
}

StoredResult result_from_json(const Json& json, const std::string& name) {
    try {
        return stored_result(json);
    } catch (const StoredJsonError& error) {
        throw InputError({name, 0, 0}, fmt::format("expected {}: {}", what_is_read, error.what()));
    }
}

}  // namespace crescent
