// The input of `crescent compare`: arms (each a set of renders of one view), a reference, regions, assertions. Plain
// data.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/errors.h"
#include "compare/image_file.h"
#include "experiment/assertion.h"
#include "experiment/experiment.h"
#include "experiment/schema.h"
#include "experiment/tree.h"
#include "output/tone_map.h"

namespace crescent {

/// One arm: files of independent renders of the same view. `files` are paths or patterns (*, ?, [..], %d for digits).
struct RenderArm {
    std::string name;
    SourceLocation location;
    std::vector<std::string> files;
    bool moments = false;           // one file with the moments of the renders, see moments.h
    std::string layer;              // part or layer to read; "": the beauty
    std::optional<double> spp;      // samples per pixel of one render
    std::optional<double> seconds;  // the render time of one render
};

/// Pixels where a mask's luminance is above 0 (a render, or a black and white picture in NPY or PFM).
struct MaskPlan {
    std::string name;
    SourceLocation location;
    std::string file;
};

enum class Expectation { nothing, same };

/// How renders are aligned: all must have the same windows, or each is placed in its display window.
enum class Alignment { windows, display };

struct ComparePlan {
    std::string file;  // the TOML, or "crescent compare"
    std::string title;
    std::vector<RenderArm> arms;
    std::vector<std::string> reference;  // files or patterns; empty: none
    std::string reference_layer;
    std::vector<Region> regions;
    std::vector<MaskPlan> masks;
    std::vector<AssertionPlan> assertions;
    bool pair = false;           // renders of two arms with the same number in their names share their random numbers
    bool find_pairs = true;      // without `pair`: renders that share random numbers are looked for
    bool find_outliers = false;  // of two arms with the same noise, see outliers.h
    bool shared_noise = false;   // the noise of a side with few renders is estimated with that of the other
    ImageEncoding encoding = ImageEncoding::automatic;  // of files of whole numbers
    ImageSpace space = ImageSpace::radiance;
    TestedChannels channels = TestedChannels::rgb;
    std::string channel;  // this one alone; "": `channels`
    Alignment align = Alignment::windows;
    bool crop = false;                   // compare the pixels that all data windows share
    double exposure = 1;                 // of photographs
    Theme theme = Theme::dark;           // of plates
    double alpha = 0.01;                 // probability that a call reports a difference if there is none
    double firefly_k = 4;                // a firefly: |Y - Y_ref| > k Y_ref
    double trim = 0;                     // share of pixels left out of relMSE and MAPE, the largest first
    double pixels_per_degree = 67.0206;  // of the viewer, for FLIP: 0.7 m from a 0.7 m wide display of 3840 pixels
    bool flip = true;                    // whether FLIP is measured
    std::optional<double> brightest;     // the largest possible Y of a pixel of one render
    Expectation expect = Expectation::nothing;
    int spectrum_blocks = 1024;  // of the noise's spectrum, see noise.h
    bool count_pixel_p = true;   // whether the histogram of p over pixels is computed, for the report
    unsigned look_number = 0;    // number of this look, of several that share the level; 0: it is the only one
    double smallest = 0.01;      // with expect = "same": the relative difference of Y that must be detectable
    ReadingOptions reading() const {
        return {.encoding = encoding, .space = space, .channels = channels, .channel = channel};
    }
};

/// A flag of the command line: the key that it sets, its value, and its text on the command line.
struct CompareFlag {
    std::vector<std::string> path;  // {"arms", "a", "files"}
    std::string value;              // text, or TOML if `toml` is set
    bool toml = false;
    std::string typed;  // "--arm a=*.exr"
};
/// Applies flags to a file's tree, where they replace its values.
void put_flags(Node& root, const std::vector<CompareFlag>& flags);
/// Reads a compare file ("": none) and applies the flags; all mistakes with their places are in one InputError.
ComparePlan plan_of(const std::vector<CompareFlag>& flags, const std::string& file = {});

/// Returns the names of the arms in a compare file; empty if it cannot be parsed, which plan_of() reports.
std::vector<std::string> compare_arms(const std::string& file);

/// Returns the manual of the TOML file, and its JSON Schema.
std::string compare_schema_text();
std::string compare_schema_json();

// ---- The keys of a compare file and the quantities of its checks: one table each.

/// Returns the table of a compare file; schema() is that of an experiment.
const Section& compare_schema();
const std::vector<QuantityWord>& compare_words();

/// The region with every pixel; never the main result.
inline constexpr const char* whole_frame = "frame";

}  // namespace crescent
