// The summary on the terminal: its first line, its width, its words.
#include <sstream>

#include <gtest/gtest.h>

#include "output/format.h"
#include "tests/support/sample_report.h"

namespace crescent::testing {
namespace summary_test {

std::string summary(const Sample& s, const std::string& dir = "out", bool colour = false) {
    return terminal_summary(s.inputs(), s.timing, dir, {}, colour);
}
std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

std::size_t widest(const std::string& text) {
    std::size_t most = 0;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) most = std::max(most, width(line));
    return most;
}

TEST(Summary, SaysFirstThatAllHold) { EXPECT_EQ(first_line(summary(Sample())), "all 2 assertions hold"); }

TEST(Summary, SaysFirstWhichFail) {
    Sample s;
    s.metrics.assertions[1] = {"no bad samples", false, 3, 0, "==", "bad == 0"};
    EXPECT_EQ(first_line(summary(s)), "1 of 2 assertions FAIL: no bad samples");
    EXPECT_NE(summary(s).find("measured 3, must be == 0"), std::string::npos);
}

TEST(Summary, StaysWithinEightyColumnsWhateverTheNames) {
    Sample s;
    const std::string name =
        "Äöüß: ein sehr langer Name, der mit Umlauten beginnt und nirgends auf der Welt in eine Zeile passt";
    for (ArmPlan& arm : s.experiment.arms) arm.name += name;
    for (SeedSpread& b : s.metrics.bands) {
        b.key.arm += name;
        b.band.q05 = -1.2345678e-123;
        b.band.q95 = 9.87e200;
    }
    for (RunMetrics& r : s.metrics.runs) {
        r.key.arm += name;
        r.bad = 1'000'000'000'000;
    }
    for (AssertionResult& a : s.metrics.assertions) {
        a.name = name + a.name;
        a.pass = false;
        a.bound = -1.2345e-300;
    }
    s.metrics.film_hashes[name] = name;
    s.timing.isa = name;
    const std::string text = summary(s, "/" + name + name);
    EXPECT_LE(widest(text), 80u) << text;
    EXPECT_TRUE(first_line(text).starts_with("2 of 2 assertions FAIL: ")) << text;
    EXPECT_NE(text.find("Äöüß"), std::string::npos);
    const std::string terminal = terminal_summary(s.inputs(), s.timing, "/" + name + name, {}, false, 0);
    EXPECT_EQ(terminal.find("…"), std::string::npos) << terminal;
    EXPECT_NE(terminal.find("/" + name + name + "/metrics.json"), std::string::npos);
    EXPECT_NE(terminal.find(s.metrics.bands[0].key.arm + " "), std::string::npos);
}

TEST(Summary, PrintsHashesSpeedAndWhereToLook) {
    const std::string text = summary(Sample(), "out/here");
    EXPECT_NE(text.find("phong n=64 s=32"), std::string::npos);
    EXPECT_NE(text.find("0123456789abcdef"), std::string::npos);
    EXPECT_NE(text.find("8 Msamples/s"), std::string::npos);
    EXPECT_NE(text.find("out/here/report.html"), std::string::npos);
}

TEST(Summary, HasTheSharesOfTheStages) {
    Sample s;
    s.timing.stages = {{"references", 0.25}, {"films", 1.25}, {"metrics", 0.05}, {"report", 0.5}};
    EXPECT_NE(summary(s).find("  10 % references; 50 % films; 20 % report\n"), std::string::npos) << summary(s);
    s.timing.stages = {{"references", 0.25}, {"films", 1.25}, {"tails, furnaces and article checks", 0.25},
        {"plates and films on disk", 0.25}, {"report", 0.5}};
    EXPECT_NE(summary(s).find("  10 % references; 50 % films; 10 % tails, furnaces and article checks;\n"
                              "  10 % plates and films on disk; 20 % report\n"),
        std::string::npos)
        << summary(s);
}

TEST(Summary, FilmNameOmitsSIfItsArmIgnoresS) {
    Sample s;
    EXPECT_NE(summary(s).find("  cosine n=64  "), std::string::npos) << summary(s);
    EXPECT_EQ(summary(s).find("cosine n=64 s="), std::string::npos) << summary(s);
    EXPECT_NE(summary(s).find("phong n=64 s=32"), std::string::npos) << summary(s);
}

TEST(Summary, WritesHeavyTailInPlaceOfTheBand) {
    Sample s;
    EXPECT_EQ(summary(s).find("heavy tail"), std::string::npos);
    s.band("phong", "rmse.S").band.heavy = true;
    EXPECT_NE(summary(s).find("heavy tail"), std::string::npos);
}

TEST(Summary, CountsBadSamplesOnlyWhereThereAreAny) {
    Sample s;
    EXPECT_EQ(summary(s).find("bad sample"), std::string::npos);
    s.metrics.runs[0].bad = 2;
    EXPECT_NE(summary(s).find("2 bad samples"), std::string::npos);
}

TEST(Summary, IsColouredOnlyWhereAsked) {
    EXPECT_EQ(summary(Sample()).find('\x1b'), std::string::npos);
    EXPECT_NE(summary(Sample(), "out", true).find("\x1b[32m"), std::string::npos);
}

TEST(PrimarySample, ReadableFiguresKeepFourPlaces) {
    EXPECT_EQ(figures(7.75694), "7.757");
    EXPECT_EQ(figures(0.1332529), "0.1333");
    EXPECT_EQ(figures(21358), "21358");
    EXPECT_EQ(figures(0), "0");
    EXPECT_EQ(figures(9.99996), "10.00");
    EXPECT_EQ(figures(999.96), "1000") << "whole from there on";
    EXPECT_EQ(figures(999.94), "999.9");
    EXPECT_EQ(figures_of("fireflies", 12), "12");
    EXPECT_EQ(figures_of("fireflies", 536.5), "536.5");
    EXPECT_EQ(figures_of("fireflies", 3.75), "4");
    EXPECT_EQ(figures_of("fireflies", 21358), "21358");
}

TEST(PrimarySample, AreClippedByCodePointsInTheMiddle) {
    EXPECT_EQ(width("äöü"), 3u);
    EXPECT_EQ(clip("äöüäöü", 5), "äö…öü");
    EXPECT_EQ(clip("short", 5), "short");
}

}  // namespace summary_test
}  // namespace crescent::testing
