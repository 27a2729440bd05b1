// Neutral: toe, compression of the peak, desaturation, with the constants of the specification. sRGB: the standard's
// two pieces; bytes by comparison with the decoded (k - 1/2)/255, from a first guess in 1024 steps.
#include "output/tone_map.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "math/functions.h"

namespace crescent {

namespace {

// The constants of the specification: F90 reflectance 4 %, compression begins at 0.8 - F90, desaturation K_d.
constexpr double fresnel = 0.04;
constexpr double start = 0.8 - fresnel;
constexpr double desaturation = 0.15;

// Linear values at which round(255 srgb_encode) steps from k - 1 to k, and for each of 1024 equal steps of the linear
// range the byte at its lower end: two or three comparisons then determine any value.
struct Thresholds {
    std::array<double, 257> step;
    std::array<unsigned char, 1025> first;
    Thresholds() {
        step[0] = 0;
        for (int k = 1; k < 256; ++k) step[k] = srgb_decode((k - 0.5) / 255);
        step[256] = 2;  // never reached
        int k = 0;
        for (int i = 0; i <= 1024; ++i) {
            while (i / 1024.0 >= step[k + 1]) ++k;
            first[i] = static_cast<unsigned char>(k);
        }
    }
};

}  // namespace

Rgb neutral(const Rgb& colour) {
    auto [r, g, b] = colour;
    double x = std::min({r, g, b});
    // The toe removes the reflection of the surface, 4 %: x - 6.25 x^2 = x (1 - x / (4 fresnel)) meets it at x = 2
    // fresnel.
    double offset = x < 2 * fresnel ? x - x * x / (4 * fresnel) : fresnel;
    r -= offset;
    g -= offset;
    b -= offset;
    double peak = std::max({r, g, b});
    if (peak < start) return {r, g, b};

    constexpr double d = 1 - start;
    double new_peak = 1 - d * d / (peak + d - start);
    double scale = new_peak / peak;
    double white = 1 - 1 / (desaturation * (peak - new_peak) + 1);
    auto mix = [&](double c) { return c * scale * (1 - white) + new_peak * white; };
    return {mix(r), mix(g), mix(b)};
}

double srgb_encode(double linear) {
    double x = std::clamp(linear, 0.0, 1.0);
    return x <= 0.0031308 ? 12.92 * x : 1.055 * math::pow(x, 1 / 2.4) - 0.055;
}

double srgb_decode(double encoded) {
    double x = std::clamp(encoded, 0.0, 1.0);
    return x <= 0.04045 ? x / 12.92 : math::pow((x + 0.055) / 1.055, 2.4);
}

unsigned char srgb_byte(double linear) {
    static const Thresholds table;
    if (!(linear > 0)) return 0;
    if (linear >= 1) return 255;
    int k = table.first[static_cast<int>(linear * 1024)];
    while (linear >= table.step[k + 1]) ++k;
    return static_cast<unsigned char>(k);
}

Srgb8 photograph(const Rgb& radiance, double exposure) {
    Rgb exposed;
    for (int c = 0; c < 3; ++c) {
        if (!std::isfinite(radiance[c])) return not_a_number_colour;
        exposed[c] = std::max(0.0, exposure * radiance[c]);
    }
    Rgb mapped = neutral(exposed);
    return {srgb_byte(mapped[0]), srgb_byte(mapped[1]), srgb_byte(mapped[2])};
}

// ---- Each channel runs linearly between neighbouring bytes of the published table and is rounded to the nearest.

namespace {

// The published table: 256 entries of three sRGB bytes in hexadecimal. Copyright 2019 Google LLC, author Anton
// Mikhailov, Apache-2.0.
constexpr std::string_view entries =
    "30123b32154333184a341b51351e5836215f37246638276d392a733a2d793b2f803c32863d358b3e38913f3b973f3e9c"
    "4040a24143a74146ac4249b1424bb5434eba4451bf4454c34456c74559cb455ccf455ed34661d64664da4666dd4669e0"
    "466be3476ee64771e94773eb4776ee4778f0477bf2467df44680f64682f84685fa4687fb458afc458cfd448ffe4391fe"
    "4294ff4196ff4099ff3e9bfe3d9efe3ba0fd3aa3fc38a5fb37a8fa35abf833adf731aff52fb2f42eb4f22cb7f02ab9ee"
    "28bceb27bee925c0e723c3e422c5e220c7df1fc9dd1ecbda1ccdd81bd0d51ad2d21ad4d019d5cd18d7ca18d9c818dbc5"
    "18ddc218dec018e0bd19e2bb19e3b91ae4b61ce6b41de7b21fe9af20eaac22ebaa25eca727eea42aefa12cf09e2ff19b"
    "32f29835f39438f4913cf58e3ff68a43f78746f8844af8804ef97d52fa7a55fa7659fb735dfc6f61fc6c65fd6969fd66"
    "6dfe6271fe5f75fe5c79fe597dff5680ff5384ff5188ff4e8bff4b8fff4992ff4796fe4499fe429cfe409ffd3fa1fd3d"
    "a4fc3ca7fc3aa9fb39acfb38affa37b1f936b4f836b7f735b9f635bcf534bef434c1f334c3f134c6f034c8ef34cbed34"
    "cdec34d0ea34d2e935d4e735d7e535d9e436dbe236dde037dfdf37e1dd37e3db38e5d938e7d739e9d539ebd339ecd13a"
    "eecf3aefcd3af1cb3af2c93af4c73af5c53af6c33af7c13af8be39f9bc39faba39fbb838fbb637fcb336fcb136fdae35"
    "fdac34fea933fea732fea431fea130fe9e2ffe9b2dfe992cfe962bfe932afe9029fd8d27fd8a26fc8725fc8423fb8122"
    "fb7e21fa7b1ff9781ef9751df8721cf76f1af66c19f56918f46617f36315f26014f15d13f05b12ef5811ed5510ec530f"
    "eb500eea4e0de84b0ce7490ce5470be4450ae2430ae14109df3f08dd3d08dc3b07da3907d83706d63506d43305d23105"
    "d02f05ce2d04cc2b04ca2a04c82803c52603c32503c12302be2102bc2002b91e02b71d02b41b01b21a01af1801ac1701"
    "a91601a71401a41301a112019e10019b0f01980e01950d01920b018e0a018b09028808028507028106027e05027a0403";
constexpr int digit(char c) { return c <= '9' ? c - '0' : c - 'a' + 10; }
constexpr int byte_of(int entry, int channel) {
    const auto digits = static_cast<std::size_t>(6 * entry + 2 * channel);
    return 16 * digit(entries[digits]) + digit(entries[digits + 1]);
}

}  // namespace

Srgb8 turbo(double t) {
    if (std::isnan(t)) return not_a_number_colour;
    double position = std::clamp(t, 0.0, 1.0) * 255;
    int low = std::min(static_cast<int>(position), 254);
    double f = position - low;
    Srgb8 out;
    for (int c = 0; c < 3; ++c) {
        out[c] = static_cast<unsigned char>(byte_of(low, c) * (1 - f) + byte_of(low + 1, c) * f + 0.5);
    }
    return out;
}

}  // namespace crescent
