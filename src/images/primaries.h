// Colours with primaries other than Rec.709: RGB to CIE XYZ and back from the chromaticities of a file, and from one
// set of primaries to another. White points are adapted by Bradford's transform (Lam 1985), as in ICC profiles.
#pragma once

#include <array>
#include <string>

#include "base/vec.h"

namespace crescent {

/// CIE 1931 xy of the three primaries and of white (R = G = B).
struct Chromaticities {
    std::array<double, 2> red{0.64, 0.33}, green{0.30, 0.60}, blue{0.15, 0.06}, white{0.3127, 0.3290};  // Rec.709
};

/// Returns whether they describe colours: finite, a white point with luminance, primaries not on one line.
bool is_valid(const Chromaticities& c);
/// Returns whether no coordinate differs by more than 0.001: the same primaries, written with other digits.
bool same_primaries(const Chromaticities& a, const Chromaticities& b);
/// Returns "Rec.709", or the eight numbers.
std::string to_string(const Chromaticities& c);

using Matrix3 = std::array<std::array<double, 3>, 3>;

Rgb transformed(const Matrix3& m, const Rgb& v);
/// Scaled so that white has Y = 1. For Rec.709 the second row is luminance_weights, as rounded in ITU-R BT.709.
Matrix3 rgb_to_xyz(const Chromaticities& c);
/// Without adaptation of the white point.
Matrix3 xyz_to_rgb(const Chromaticities& c);
/// Converts RGB between two sets of primaries; white stays white. Files that contain XYZ in R, G and B (red 1 0, green
/// 0 1, blue 0 0) are not adapted.
Matrix3 conversion(const Chromaticities& from, const Chromaticities& to);
/// Weights of R, G and B in Y.
Rgb luminance_weights_of(const Chromaticities& c);

}  // namespace crescent
