// Templates: what is escaped, repeated and left out, and that a name which the model lacks is an error.
#include "output/templates.h"

#include <gtest/gtest.h>

#include "base/errors.h"

namespace crescent::testing {
namespace templates_test {

std::string rendered(std::string_view text, const Json& model) {
    const Template all[] = {{"page.html", text}, {"part.html", "<{{name}}>"}};
    return render_page(all, "page.html", model);
}

TEST(Templates, EscapeTextButNotMarkup) {
    EXPECT_EQ(rendered("{{x}} {{{x}}}", {{"x", "<b>&\x02"}}), "&lt;b&gt;&amp;\xEF\xBF\xBD <b>&\x02");
}

TEST(Templates, WriteNumbersExactly) {
    EXPECT_EQ(rendered("{{a}} {{b}} {{c}}", {{"a", 0.1}, {"b", 7}, {"c", 18446744073709551615u}}),
        "0.1 7 18446744073709551615");
}

TEST(Templates, LeaveOutWhatIsEmptyOrFalse) {
    const Json model = {{"none", Json::array()}, {"no", false}, {"words", ""}, {"null", nullptr}};
    EXPECT_EQ(
        rendered("{{#none}}1{{/none}}{{#no}}2{{/no}}{{#words}}3{{/words}}{{#null}}4{{/null}}{{words}}", model), "");
    EXPECT_EQ(rendered("{{^none}}1{{/none}}{{^no}}2{{/no}}{{^words}}3{{/words}}{{^null}}4{{/null}}", model), "1234");
}

TEST(Templates, RepeatASectionForEachElement) {
    EXPECT_EQ(rendered("{{#all}}{{.}};{{/all}}", {{"all", {"a", "b"}}}), "a;b;");
    EXPECT_EQ(rendered("{{#has_all}}x{{/has_all}}", {{"all", {"a", "b"}}}), "x");
    EXPECT_EQ(rendered("{{#has_all}}x{{/has_all}}", {{"all", Json::array()}}), "");
    EXPECT_EQ(rendered("{{#all}}{{> part.html}}{{/all}}", {{"all", {{{"name", "a"}}, {{"name", "b"}}}}}), "<a><b>");
}

TEST(Templates, CountInTheOrderOfThePage) {
    EXPECT_EQ(rendered("{{count.a}}{{#all}}{{count.a}}{{/all}}{{count.b}}", {{"all", {"x", "y"}}}), "1231");
}

TEST(Templates, RefuseNamesThatTheModelLacks) {
    for (const char* text : {"{{absent}}", "{{{absent}}}", "{{#absent}}x{{/absent}}", "{{^absent}}x{{/absent}}",
             "{{x.absent}}", "{{> absent.html}}", "{{> part.html}}"})
        EXPECT_THROW(rendered(text, {{"x", {{"y", 1}}}}), Bug) << text;
}

TEST(Templates, RefuseTextThatIsNoTemplate) {
    EXPECT_THROW(rendered("{{#x}}", {{"x", 1}}), Bug);
    EXPECT_THROW(rendered("{{x", {{"x", 1}}), Bug);
}

}  // namespace templates_test
}  // namespace crescent::testing
