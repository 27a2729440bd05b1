// The text of a failing test for a result: few lines, in a fixed order, in calls of C++.
#include "check/report/summary.h"

#include <gtest/gtest.h>

#include <sstream>

#include "check/report/print.h"

namespace crescent {
namespace summary_test {

CheckResult of_verdicts(std::initializer_list<std::tuple<const char*, State, double, const char*>> verdicts) {
    CheckResult j;
    for (const auto& [name, state, theta, cause] : verdicts) {
        Verdict v;
        v.arm = "sampler";
        v.name = name;
        v.state = state;
        v.cause = cause;
        v.check_case = "w_o " + std::to_string(static_cast<int>(theta)) + " deg";
        v.wo = {theta, 0};
        v.sentences = {{"finding", std::string("What of ") + name + ".\nHow large."}};
        j.verdicts.push_back(v);
    }
    return j;
}

std::vector<std::string> lines(const std::string& text) {
    std::vector<std::string> out;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) out.push_back(line);
    return out;
}

TEST(WhatIsWrong, HasMessageSizePlaceCauseAndNextStep) {
    const auto message = lines(what_is_wrong(of_verdicts({{"normalised", State::wrong, 60, ""},
        {"density", State::right, 60, ""}, {"normalised", State::wrong, 30, "A factor 2."}})));
    ASSERT_EQ(message.size(), 4u);
    EXPECT_EQ(message[0], "normalised is wrong: What of normalised. How large.");
    EXPECT_EQ(message[1], "  at 2 of 2 w_o, worst at w_o 60 deg");
    EXPECT_EQ(message[2], "  A factor 2.");
    EXPECT_EQ(message[3].find("Next: crescent::IsARightSamplerBy(settings) with settings.wo = {{60, 0}}"), 0u)
        << message[3];
}

TEST(WhatIsWrong, HasAtMostEightLinesForManyFaults) {
    const CheckResult j = of_verdicts(
        {{"valid", State::wrong, 0, "A."}, {"support", State::wrong, 0, "B."}, {"normalised", State::wrong, 0, "C."},
            {"density", State::wrong, 0, "D."}, {"tail", State::inconclusive, 0, ""}, {"mean", State::error, 0, ""}});
    for (std::size_t most : {5u, 8u, 12u}) {
        const auto message = lines(what_is_wrong(j, most));
        EXPECT_LE(message.size(), most);
        EXPECT_GE(message.size() + 3, most);
        EXPECT_EQ(message[0].find("valid is wrong"), 0u);
        std::string text;
        for (const std::string& line : message) text += line;
        for (const Verdict& v : j.verdicts)
            if (v.state != State::error) EXPECT_NE(text.find(v.name), std::string::npos) << v.name << "\n" << text;
    }
    EXPECT_EQ(what_is_wrong(of_verdicts({{"valid", State::right, 0, ""}})), "");
}

TEST(Summaries, HaveWhatIsStatedOnce) {
    CheckResult j = of_verdicts({{"normalised", State::wrong, 30, ""}, {"normalised", State::wrong, 60, "A cause."},
        {"normalised", State::right, 0, ""}, {"normalised", State::wrong, 89, ""}});
    const auto integral = [](const std::string& size) {
        return Sentences{{"integral", "p integrates to " + size + "."}, {"expected", "Expected 1."}};
    };
    const Sentences sentences[] = {integral("1.2 +- 0.1"), integral("1.5 +- 0.1"), {},
        {{"no integral", "Nothing else is like it."}, {"expected", "Expected 0.9."}}};
    const double size[] = {0.2, 0.5, 0, 0.1};
    for (std::size_t i = 0; i < 4; ++i) {
        j.verdicts[i].sentences = sentences[i];
        j.verdicts[i].size = size[i];
    }
    const auto message_lines = lines(summary_of(j));
    EXPECT_EQ(message_lines.at(0),
        "sampler, normalised: wrong at 3 of 4 w_o (30 to 89 deg), worst at w_o 60 deg. p integrates to 1.5 +- 0.1. "
        "Expected 1. A cause.");
    EXPECT_EQ(details_of(j), "\nsampler, normalised: wrong\n  [w_o 89 deg] Nothing else is like it.\n");
    EXPECT_EQ(summary_of(j).find("1.2"), std::string::npos);
}

TEST(Summaries, TellWhatEachOfSeveralTechniquesStates) {
    CheckResult j = of_verdicts({{"normalised", State::wrong, 30, ""}, {"normalised", State::wrong, 60, ""}});
    j.verdicts[0].sentences = {{"integral", "Sampler 1 of 2: p integrates to 1.5.", 1}};
    j.verdicts[1].sentences = {{"integral", "Sampler 2 of 2: p integrates to 1.2.", 2}};
    EXPECT_EQ(details_of(j), "\nsampler, normalised: wrong\n  [w_o 60 deg] Sampler 2 of 2: p integrates to 1.2.\n");
}

TEST(Summaries, NameThePlaceOfAFaultThatIsNotAtAWo) {
    CheckResult j = of_verdicts({{"valid", State::wrong, 0, ""}, {"valid", State::right, 30, ""}});
    j.verdicts[0].place = "w_o = (-1, 0, 0)";
    EXPECT_EQ(summary_of(j).find("sampler, valid: wrong at w_o = (-1, 0, 0). "), 0u) << summary_of(j);
}

TEST(NextStep, OfAThoroughCheckIsNotAnother) {
    Verdict v;
    v.next = {NextStep::Kind::more_draws, 4, false};
    EXPECT_EQ(next_step_text(v).find("--full draws more"), 0u);
    v.next.times = 300;
    EXPECT_NE(next_step_text(v).find("only 12 times"), std::string::npos);
    v.next.thorough = true;
    EXPECT_EQ(next_step_text(v), "about 3e+02 times as many draws are needed as --full makes.");
    v.next.times = 9e68;
    EXPECT_EQ(next_step_text(v), "more draws are needed than can be made.");
    v.next.times = 0;
    EXPECT_EQ(next_step_text(v), "");
}

TEST(NextStep, HasTheTermsOfEachFrontEnd) {
    CheckResult j = of_verdicts({{"density", State::inconclusive, 0, ""}});
    j.verdicts[0].next = {NextStep::Kind::more_draws, 4};
    EXPECT_NE(summary_of(j).find("--full"), std::string::npos) << summary_of(j);
    EXPECT_EQ(what_is_wrong(j).find("--"), std::string::npos) << what_is_wrong(j);
    EXPECT_NE(what_is_wrong(j).find("TestSettings::thorough()"), std::string::npos) << what_is_wrong(j);
    EXPECT_NE(next_step_text(j.verdicts[0], FrontEnd::python).find("full=True"), std::string::npos);
}

}  // namespace summary_test
}  // namespace crescent
