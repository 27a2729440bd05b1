// Numbers as text: exactly for machines, in four figures for people. No units; none are added.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace crescent::inline pages {

/// The shortest decimal that reads back as the same double; "nan", "inf", "-inf" for what has no decimal.
std::string shortest(double x);

/// For reading: `digits` significant figures, whole numbers from 1000 on, "0.0001" as the smallest plain fraction and
/// an exponent below it. NaN and infinities by name.
std::string figures(double x, int digits = 4);

/// At most six significant figures and no trailing zeros: "3", "1.99966".
std::string compact(double x);

/// As figures(), but a meter that counts (fireflies) stays a whole number, or a half between two where it is a median.
std::string figures_of(std::string_view meter, double x);

/// A ratio or share in percent, "6.7 %"; at most `digits` significant figures.
std::string percent(double fraction, int digits = 3);

/// Code points in UTF-8 text: the columns it takes in a terminal where every character is one wide.
std::size_t width(std::string_view utf8);

/// At most `columns` code points; what was cut leaves an ellipsis in the middle.
std::string clip(std::string_view utf8, std::size_t columns);

/// Padded with blanks to `columns` code points, on the right or on the left; clipped where longer.
std::string left(std::string_view utf8, std::size_t columns);
std::string right(std::string_view utf8, std::size_t columns);

/// "1 sample", "64 samples".
std::string plural(std::uint64_t count, std::string_view noun);

}  // namespace crescent::inline pages
