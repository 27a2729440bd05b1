// A domain is a list of parts. Names are read part by part, between the letters x.
#include "samplers/domains/domain.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "base/text.h"

namespace crescent {

namespace {

using Kind = DomainPart::Kind;

/// What is known of each kind of part, in the order of Kind.
struct KindOfPart {
    const char* name;
    std::size_t coordinates, dimensions;
    const char* symbols;  // of its coordinates
    const char* unit;     // of a density
};
constexpr KindOfPart kinds_of_parts[] = {{"hemisphere", 3, 2, "w", "1/sr"}, {"sphere", 3, 2, "w", "1/sr"},
    {"disk", 2, 2, "(x, y)", "per area"}, {"square", 2, 2, "(x, y)", "per area"},
    {"cube", 3, 3, "(x, y, z)", "per volume"}, {"triangle", 2, 2, "(b0, b1)", "per area"},
    {"line", 1, 1, "x", "per length"}, {"set", 1, 1, "entry", "a probability"}};

const KindOfPart& kind_of(const DomainPart& part) { return kinds_of_parts[static_cast<std::size_t>(part.kind)]; }

/// How far single precision may miss the edge of a domain.
constexpr double edge = 1e-6;

std::string_view trimmed(std::string_view s) {
    while (!s.empty() && s.front() == ' ') s.remove_prefix(1);
    while (!s.empty() && s.back() == ' ') s.remove_suffix(1);
    return s;
}

bool read_number(std::string_view text, double& out) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (text == "inf" || text == "+inf") return out = infinity, true;
    if (text == "-inf") return out = -infinity, true;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
    return error == std::errc{} && end == text.data() + text.size() && std::isfinite(out);
}

bool read_line(std::string_view values, DomainPart& out) {
    const std::size_t comma = values.find(',');
    if (comma == std::string_view::npos) return false;
    return read_number(trimmed(values.substr(0, comma)), out.from) &&
        read_number(trimmed(values.substr(comma + 1)), out.to) && out.from < out.to &&
        (out.is_infinite() || std::isfinite(out.to - out.from));
}

bool read_set(std::string_view values, DomainPart& out) {
    const auto [end, error] = std::from_chars(values.data(), values.data() + values.size(), out.count);
    return error == std::errc{} && end == values.data() + values.size() && out.count >= 1 &&
        out.count <= Domain::most_entries;
}

std::optional<DomainPart> read_part(std::string_view text) {
    const std::size_t colon = text.find(':');
    const std::string_view name = text.substr(0, colon);
    const std::string_view values = colon == text.npos ? "" : text.substr(colon + 1);
    for (std::size_t k = 0; k < std::size(kinds_of_parts); ++k) {
        if (name != kinds_of_parts[k].name) continue;
        DomainPart out{static_cast<Kind>(k)};
        const bool valid = out.kind == Kind::line ? read_line(values, out)
            : out.kind == Kind::set               ? read_set(values, out)
                                                  : colon == text.npos;
        return valid ? std::optional(out) : std::nullopt;
    }
    return {};
}

std::string name_of(const DomainPart& part) {
    const std::string name = kind_of(part).name;
    if (part.kind == Kind::line) return fmt::format("{}:{},{}", name, part.from, part.to);
    if (part.kind == Kind::set) return fmt::format("{}:{}", name, part.count);
    return name;
}

}  // namespace

std::size_t DomainPart::coordinates() const { return kind_of(*this).coordinates; }
std::size_t DomainPart::dimensions() const { return kind_of(*this).dimensions; }
bool DomainPart::is_infinite() const { return kind == Kind::line && (!std::isfinite(from) || !std::isfinite(to)); }

std::string DomainPart::fault(std::span<const double> x) const {
    if (std::ranges::any_of(x, [](double v) { return std::isnan(v); })) return "is not a number";
    const auto is_within = [](double v, double low, double high) { return v >= low - edge && v <= high + edge; };
    switch (kind) {
        case Kind::hemisphere:
        case Kind::sphere: {
            const double square = x[0] * x[0] + x[1] * x[1] + x[2] * x[2];
            constexpr double unit = 2e-5;
            if (!(std::fabs(square - 1) <= unit)) return "is not of length 1";
            return kind == Kind::hemisphere && x[2] < -edge ? "is below the hemisphere" : "";
        }
        case Kind::disk: return x[0] * x[0] + x[1] * x[1] <= 1 + edge ? "" : "is outside the unit disk";
        case Kind::square:
        case Kind::cube:
            return std::ranges::all_of(x, [&](double v) { return is_within(v, 0, 1); }) ? "" : "is outside [0, 1]";
        case Kind::triangle:
            return is_within(x[0], 0, 1) && is_within(x[1], 0, 1) && x[0] + x[1] <= 1 + edge
                ? ""
                : "is outside the triangle";
        case Kind::line: {
            const double size = is_infinite() ? 1 : to - from, slack = edge * size;
            const bool is_inside = std::isfinite(x[0]) && x[0] >= from - slack && x[0] <= to + slack;
            return is_inside ? "" : fmt::format("is outside [{:g}, {:g}]", from, to);
        }
        case Kind::set:
            if (x[0] != std::floor(x[0])) return "is not an integer";
            return x[0] >= 0 && x[0] < count ? "" : fmt::format("is not one of the entries 0 to {}", count - 1);
    }
    return "";
}

Domain::Domain(std::vector<DomainPart> parts) : parts_(std::move(parts)) {
    for (const DomainPart& part : parts_) name_ += (name_.empty() ? "" : " x ") + name_of(part);
}

std::optional<Domain> Domain::read(std::string_view text) {
    std::vector<DomainPart> parts;
    std::size_t dimensions = 0;
    for (bool last = false; !last;) {
        const std::size_t cross = text.find('x');  // no name of a part has this letter
        last = cross == text.npos;
        const std::optional<DomainPart> part = read_part(trimmed(text.substr(0, cross)));
        if (!part) return {};
        parts.push_back(*part);
        dimensions += part->dimensions();
        if (!last) text.remove_prefix(cross + 1);
    }
    if (dimensions > most_dimensions) return {};
    return Domain(std::move(parts));
}

std::string Domain::refusal(std::string_view text) {
    std::vector<std::string> names;
    for (const KindOfPart& kind : kinds_of_parts) names.emplace_back(kind.name);
    return fmt::format("expected {}{}", expected, did_you_mean(text.substr(0, text.find(':')), names));
}

std::size_t Domain::coordinates() const {
    std::size_t out = 0;
    for (const DomainPart& part : parts_) out += part.coordinates();
    return out;
}

std::size_t Domain::dimensions() const {
    std::size_t out = 0;
    for (const DomainPart& part : parts_) out += part.dimensions();
    return out;
}

bool Domain::is_infinite() const { return std::ranges::any_of(parts_, &DomainPart::is_infinite); }

bool Domain::is_direction() const {
    return parts_.size() == 1 && (parts_[0].kind == Kind::sphere || parts_[0].kind == Kind::hemisphere);
}

std::string Domain::fault(std::span<const double> point) const {
    for (const DomainPart& part : parts_) {
        std::string fault = part.fault(point.first(part.coordinates()));
        if (!fault.empty()) return fault;
        point = point.subspan(part.coordinates());
    }
    return "";
}

std::string Domain::text(std::span<const double> point) const {
    std::string out;
    for (const DomainPart& part : parts_) {
        const auto x = point.first(part.coordinates());
        point = point.subspan(part.coordinates());
        out +=
            fmt::format("{}{}{}", out.empty() ? "" : ", ", kind_of(part).symbols, part.kind == Kind::set ? " " : " = ");
        if (x.size() == 1) out += fmt::format("{:.7g}", x[0]);
        else out += fmt::format("({:.6g})", fmt::join(x, ", "));
    }
    return out;
}

std::string Domain::unit() const {
    if (parts_.size() == 1) return kind_of(parts_[0]).unit;
    return "per unit of the product measure";
}

}  // namespace crescent
