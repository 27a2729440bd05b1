// Both ways to set a formula against markup written out by hand; a formula outside the list is a Bug.
#include "output/formula.h"

#include <gtest/gtest.h>

#include "base/errors.h"

namespace crescent::formula {
namespace formula_test {

TEST(Formulas, AreSetAsMathMl) {
    EXPECT_EQ(mathml("u_1<q"), "<mrow><msub><mi>u</mi><mn>1</mn></msub><mo>&lt;</mo><mi>q</mi></mrow>");
    EXPECT_EQ(mathml(R"(\frac{1}{2\pi})"), "<mfrac><mn>1</mn><mrow><mn>2</mn><mi>π</mi></mrow></mfrac>");
    EXPECT_EQ(mathml(R"(\lvert x\rvert^2)"),
        "<msup><mrow><mo form=\"prefix\" stretchy=\"false\">|</mo><mi>x</mi>"
        "<mo form=\"postfix\" stretchy=\"false\">|</mo></mrow><mn>2</mn></msup>");
    EXPECT_EQ(html("about $n$ & on"), "about <math><mi>n</mi></math> & on");
}

TEST(Formulas, StandOnOneLineOfPango) {
    EXPECT_EQ(pango(R"(\frac{1}{2\pi\,(1-\cos\beta)})"), "1/(2π (1 − cos β))");
    EXPECT_EQ(pango(R"(\frac{D(m)\,(n\cdot m)}{4(\omega_o\cdot m)})"), "D(m) (n·m)/(4(ω<sub>o</sub>·m))");
    EXPECT_EQ(pango(R"(\frac{(n\cdot\omega)}{\pi})"), "(n·ω)/π");
    EXPECT_EQ(pango(R"(w_i=\frac{p_i}{p_1+p_2})"), "w<sub>i</sub> = p<sub>i</sub>/(p<sub>1</sub> + p<sub>2</sub>)");
}

TEST(Formulas, TakeNumbersForALetterAndItsSuccessor) {
    const char* tex = R"(\frac{s+1}{2\pi}\,(\omega\cdot R)_+^s)";
    EXPECT_EQ(pango(tex), "(s+1)/(2π) (ω·R)<sup>s</sup>");
    EXPECT_EQ(pango(tex, {'s', "32", "33"}), "33/(2π) (ω·R)<sup>32</sup>");
    EXPECT_EQ(pango("u^{1/(s+1)}", {'s', "32", "33"}), "u<sup>1/(33)</sup>");
    EXPECT_EQ(pango("e^{-2s}", {'s', "40", "41"}), "e<sup>−2·40</sup>");
}

TEST(Formulas, OfWordsThatAreNotKnownAreABug) {
    EXPECT_THROW(mathml(R"(\unknown)"), Bug);
    for (const char* tex :
        {R"(\unknown)", "\\", "(a", "a^", R"(\frac{a})", R"(\mathrm{a)", "a!", R"(\lvert a)", "a)", "{a"}) {
        EXPECT_THROW(mathml(tex), Bug) << tex;
    }
    EXPECT_THROW(html("about $n"), Bug);
    EXPECT_THROW(html("$(a$"), Bug);
}

}  // namespace formula_test
}  // namespace crescent::formula
