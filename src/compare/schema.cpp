// The table of a compare file: the same machinery as an experiment's, so keys, places, hints and manual come with it.
#include "compare/schema.h"

#include "experiment/schema.h"

namespace crescent::inline comparing {

namespace {

constexpr Range none{}, share{0, 1, false, true}, positive{0, 1e12, true}, pixel_range{0, 65535};
constexpr Requirement required = Requirement::required, optional = Requirement::optional,
                      defaulted = Requirement::defaulted;

Section arms() {
    return {"arms", Multiplicity::named, required,
        "Sets of independent renders of one view: several seeds of A, several of B.", in<&ComparePlan::arms>,
        {{"files", Type::texts, none, "", required, "",
             "Paths or patterns (*, ?, [a-z], %d for digits) of the renders, relative to this file.",
             to<&RenderArm::files>},
            {"layer", Type::text, none, "", defaulted, "\"\"", "Which part or layer of each file; else the beauty.",
                to<&RenderArm::layer>},
            {"spp", Type::number, positive, "samples/pixel", optional, "what the files say",
                "Samples a pixel of one render.", to<&RenderArm::spp>},
            {"seconds", Type::number, positive, "s", optional, "what the files say", "What one render took.",
                to<&RenderArm::seconds>}},
        {}};
}

Section regions() {
    return {"regions", Multiplicity::named, optional, "Boxes in which errors are measured.", in<&ComparePlan::regions>,
        {{"box", Type::box, pixel_range, "pixels", required, "",
            "[x0, y0, x1, y1], both ends inside, origin bottom-left.", to<&Region::box>}},
        {}};
}

Section masks() {
    return {"masks", Multiplicity::named, optional, "Sets of pixels in which errors are measured.",
        in<&ComparePlan::masks>,
        {{"file", Type::text, none, "", required, "",
            "A picture of the renders' size, relative to this file; pixels above 0 belong to it.",
            to<&MaskPlan::file>}},
        {}};
}

Section assertions() {
    return {"assertions", Multiplicity::titled, optional, "Claims that must hold, for a build server.",
        in<&ComparePlan::assertions>,
        {{"check", Type::check, none, "", required, "", "Two quantities, e.g. \"rmse.H(a) < rmse.H(b)\".",
            to<&AssertionPlan::text>}},
        {}};
}

}  // namespace

const Section& compare_schema() {
    static const Section root = {"", Multiplicity::one, required, "Renders of other programs, compared.", {},
        {{"title", Type::text, none, "", defaulted, "\"renders compared\"", "One line.", to<&ComparePlan::title>},
            {"reference", Type::texts, none, "", optional, "none",
                "Paths or patterns of the converged image, relative to this file.", to<&ComparePlan::reference>},
            {"reference_layer", Type::text, none, "", defaulted, "\"\"", "Which part or layer of it.",
                to<&ComparePlan::reference_layer>},
            {"pair", Type::flag, none, "", defaulted, "false",
                "Renders of two arms with the same number in their names share their random numbers.",
                to<&ComparePlan::pair>},
            {"align", Type::word, none, "", defaulted, "\"windows\"",
                "windows: renders whose data windows differ are refused; display: each is placed in its display "
                "window, with 0 outside of its data window.",
                to<&ComparePlan::align>, {"windows", "display"}},
            {"crop", Type::flag, none, "", defaulted, "false",
                "Compare the pixels that the data windows of all renders share; regions are counted from their "
                "bottom-left.",
                to<&ComparePlan::crop>},
            {"exposure", Type::number, {0, 1e6, true}, "", defaulted, "1", "Of photographs.",
                to<&ComparePlan::exposure>},
            {"theme", Type::word, none, "", defaulted, "\"dark\"", "Ground and inks of plates.",
                to<&ComparePlan::theme>, {"dark", "light"}},
            {"alpha", Type::number, {1e-9, 0.5}, "", defaulted, "0.01",
                "Chance that a call tells of a difference where there is none.", to<&ComparePlan::alpha>},
            {"brightest", Type::number, positive, "", optional, "not known",
                "The most that Y of a pixel of one render can be, where something bounds it, such as a clamp: a "
                "difference that rarer events up to it could make is not called one.",
                to<&ComparePlan::brightest>},
            {"firefly_k", Type::number, {0, 1e6, true}, "", defaulted, "4",
                "A firefly is a pixel with |Y - Y_ref| > firefly_k Y_ref.", to<&ComparePlan::firefly_k>},
            {"trim", Type::number, share, "", defaulted, "0",
                "Share of pixels that relMSE and MAPE leave out, the largest first.", to<&ComparePlan::trim>},
            {"pixels_per_degree", Type::number, {1, 1000}, "", defaulted, "67.0206",
                "Of the viewer of FLIP: 0.7 m from a display 0.7 m wide with 3840 pixels.",
                to<&ComparePlan::pixels_per_degree>},
            {"flip", Type::flag, none, "", defaulted, "true", "Whether FLIP is measured: it takes longest.",
                to<&ComparePlan::flip>},
            {"expect", Type::word, none, "", defaulted, "\"nothing\"",
                "same: a difference between arms fails the call.", to<&ComparePlan::expect>, {"nothing", "same"}},
            {"smallest", Type::number, {1e-6, 10}, "", defaulted, "0.01",
                "With expect = \"same\": the relative difference of mean Y that must have been seen.",
                to<&ComparePlan::smallest>}},
        {arms(), regions(), masks(), assertions()}};
    return root;
}

const std::vector<QuantityWord>& compare_words() {
    static const std::vector<QuantityWord> words = {
        {"rmse", true, QuantityOf::compared, "root mean square error of Y of one render against the reference"},
        {"var", true, QuantityOf::compared, "mean variance of Y of one render, over renders"},
        {"bias2", true, QuantityOf::compared, "squared bias of Y, MSE less variance; may be below 0 by noise"},
        {"relmse", true, QuantityOf::compared, "mean of (Y - Y_ref)^2 / (Y_ref^2 + 0.01)"},
        {"mape", true, QuantityOf::compared, "mean of |Y - Y_ref| / (|Y_ref| + 0.01)"},
        {"fireflies", true, QuantityOf::compared, "pixels with |Y - Y_ref| > firefly_k Y_ref, of one render"},
        {"y_mean", true, QuantityOf::compared, "mean Y"},
        {"flip", true, QuantityOf::compared, "mean HDR-FLIP of the arm's first render against the reference"},
        {"flip_ldr", true, QuantityOf::compared, "mean LDR-FLIP of the two photographs, at the exposure of the plates"},
        {"efficiency", true, QuantityOf::compared, "1 / (variance x seconds)"},
        {"unit_time", true, QuantityOf::compared,
            "seconds after which the mean of renders has a variance of 1: variance x seconds"},
        {"sample_var", true, QuantityOf::compared, "variance of one sample: variance x samples a pixel"},
    };
    return words;
}

std::string compare_schema_text() {
    std::string out = manual_of(compare_schema());
    out += "\nQuantities of a check; REGION may also be a mask, or 'frame', the whole image\n";
    for (const QuantityWord& word : compare_words())
        out += "  " + form_of(word) + "\n      " + std::string(word.means) + "\n";
    return out;
}

std::string compare_schema_json() { return json_schema_of(compare_schema(), "crescent comparison"); }

}  // namespace crescent::inline comparing
