// The domains of random variables that a sampler may draw from: directions, and points of other sets, each with the
// measure of its density.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace crescent {

/// One factor of a product of domains.
struct DomainPart {
    enum class Kind { hemisphere, sphere, disk, square, cube, triangle, line, set };
    Kind kind = Kind::sphere;
    double from = 0, to = 0;  // of a line; either may be infinite
    std::uint32_t count = 0;  // entries of a set

    /// Numbers that describe a point: three of a direction.
    std::size_t coordinates() const;
    std::size_t dimensions() const;
    /// Why this point does not belong to it, such as "is outside the unit disk"; "" if it does.
    std::string fault(std::span<const double> point) const;
    bool is_infinite() const;
};

/// A product of up to four dimensions.
class Domain {
public:
    static constexpr std::size_t most_dimensions = 4;
    static constexpr std::size_t most_coordinates = 6;
    static constexpr std::uint32_t most_entries = 1000000;

    explicit Domain(std::vector<DomainPart> parts);
    /// As users write it: "disk", "line:0,inf", "set:3 x hemisphere". None: another text.
    static std::optional<Domain> read(std::string_view text);
    /// What read() expects, for messages.
    static constexpr const char* expected =
        "hemisphere, sphere, disk, square, cube, triangle, line:A,B with A < B (-inf and inf too), set:N with N from 1 "
        "to 1000000, or a product of these with an x between them, of four dimensions at most";
    /// "expected ...", with the nearest name, for a text that read() does not accept.
    static std::string refusal(std::string_view text);

    const std::vector<DomainPart>& parts() const { return parts_; }
    /// As it was written.
    const std::string& name() const { return name_; }
    std::size_t coordinates() const;
    std::size_t dimensions() const;
    /// Whether it is the sphere or the upper hemisphere alone.
    bool is_direction() const;
    /// Whether one of its parts is an infinite line.
    bool is_infinite() const;
    /// Why this point does not belong to it; "" if it does.
    std::string fault(std::span<const double> point) const;
    /// The point in words: "x = 0.25", "entry 17", "(x, y) = (0.1, 0.7)".
    std::string text(std::span<const double> point) const;
    /// What its density is per: "1/sr", "per area", "per length", a probability.
    std::string unit() const;

private:
    std::vector<DomainPart> parts_;
    std::string name_;
};

}  // namespace crescent
