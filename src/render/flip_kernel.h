// The interface of FLIP's work per pixel (metrics/flip.h), which is compiled for each instruction set with the kernels.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace crescent {

// ---- Colour spaces of FLIP: linear Rec.709 and XYZ (IEC 61966-2-1), relative to the white of (1, 1, 1).

using ColourMatrix = double[3][3];
inline constexpr ColourMatrix xyz_of_rgb = {{10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
    {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
    {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382}};
inline constexpr ColourMatrix rgb_of_xyz = {{3.241003275, -1.537398934, -0.498615861},
    {-0.969224334, 1.875930071, 0.041554224}, {0.055639423, -0.204011202, 1.057148933}};

/// Narkowicz's fit of ACES, including its exposure of 0.6: (a x^2 + b x) / (c x^2 + d x + e).
struct AcesFit {
    double a = 0.6 * 0.6 * 2.51, b = 0.6 * 0.03, c = 0.6 * 0.6 * 2.43, d = 0.6 * 0.59, e = 0.14;
};
inline constexpr AcesFit aces_fit;

/// Filters of 2 reach + 1 weights; each is applied along rows and, after that, along columns.
struct FlipFilters {
    int reach = 0;
    /// Contrast sensitivities, each with a sum of 1 over the plane. That of blue and yellow is a sum of two Gaussians,
    /// whose shares are part of `blue_yellow_down`.
    const float *achromatic = nullptr, *red_green = nullptr;
    const float *blue_yellow[2] = {}, *blue_yellow_down[2] = {};
    /// A Gaussian and its first and second derivative, for edges and points of lightness.
    const float *smooth = nullptr, *edge = nullptr, *point = nullptr;
};

inline constexpr std::size_t flip_row_multiple = 32;  // numbers: the lanes of the widest pack
constexpr std::size_t flip_stride(int width) {
    return (static_cast<std::size_t>(width) + flip_row_multiple - 1) / flip_row_multiple * flip_row_multiple;
}

/// A part of two pictures and what surrounds it.
struct FlipTile {
    int width = 0, height = 0;
    /// Linear Rec.709 of the reference and of the test picture: (width + 2 reach) x (height + 2 reach), with rows of
    /// flip_stride(width + 2 reach).
    const float* pixels[2][3] = {};
    std::span<const float> exposures;  // factors of radiance before tone mapping; none: channels in [0, 1]
    FlipFilters filters;
    float* memory = nullptr;  // flip_memory() numbers, 0 at first
    float* out = nullptr;     // the largest FLIP over the exposures; rows of flip_stride(width)
};

/// Returns how many numbers a tile needs while it is computed.
constexpr std::size_t flip_memory(int width, int height, int reach) {
    const std::size_t lines = 3 * (flip_stride(width + 2 * reach) + 2 * flip_row_multiple);
    return lines + 2 * 7 * static_cast<std::size_t>(height + 2 * reach) * flip_stride(width);
}

using FlipKernel = void (*)(const FlipTile&);
/// Returns the kernel for a name of isas(); "" means the best. Throws InputError like kernels_for().
FlipKernel flip_kernel_for(const std::string& isa);

}  // namespace crescent
