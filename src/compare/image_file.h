// Pictures of 8 and 16 bits a channel (PNG, JPEG, BMP, TGA, PNM) and Radiance HDR as renders: how stored numbers become
// values, and how far quantisation moves them.
#pragma once

#include <string>

#include "images/open_file.h"

namespace crescent {

struct Render;

/// How the numbers of an integer file encode radiance. automatic: as the file states it (gAMA of PNG), else sRGB.
enum class ImageEncoding { automatic, srgb, linear };
/// What is tested of an integer file: radiance, or the numbers themselves over the largest one.
enum class ImageSpace { radiance, display };

/// Whether the alpha channel is tested besides the colours.
enum class TestedChannels { rgb, rgba };

/// How renders are read, besides their layer.
struct ReadingOptions {
    ImageEncoding encoding = ImageEncoding::automatic;
    ImageSpace space = ImageSpace::radiance;
    TestedChannels channels = TestedChannels::rgb;
    std::string channel;  // this channel alone is tested; "": `channels`
    /// Whether other channels than the colours are read.
    bool is_partial() const { return channels != TestedChannels::rgb || !channel.empty(); }
};

/// Numbers 0 to `levels` - 1 in a file, and their decoding. levels 0: floating point.
struct Quantisation {
    double levels = 0;
    bool srgb = false;  // of IEC 61966-2-1, else proportional
    /// Returns half of the step between the values of neighbouring numbers, at a value: by how much rounding moves it
    /// at most.
    double half_step(double value) const;
    /// Returns the number, 0 to levels - 1, that encodes a value.
    double number_of(double value) const;
    bool operator==(const Quantisation&) const = default;
};

/// Returns whether the file is a picture that read_image() reads: by its first bytes, TGA by its name. Throws
/// InputError for kinds of a format that are not read.
bool is_image(const OpenFile& file, std::string_view first);
/// Reads it. Throws InputError.
Render read_image(const OpenFile& file, const ReadingOptions& options);

}  // namespace crescent
