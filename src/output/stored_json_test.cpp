// A stored result that was changed: the field and what was expected are named, without the codes of the library.
#include "output/stored_json.h"

#include <functional>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"

namespace crescent {
namespace stored_json_test {

using testing::HasSubstr;
using testing::Not;

std::string error_of(const std::function<void()>& read) {
    try {
        read();
    } catch (const StoredJsonError& error) { return error.what(); }
    return "nothing";
}

TEST(StoredJson, NamesTheFieldAndWhatWasExpected) {
    const Json json = parse_json(R"({"runs": [{"seed": 1}, {"seed": "seven", "at": [1, 2], "n": -1, "x": 1.5}]})");
    const StoredJson second = StoredJson(json).at("runs").entries()[1];
    EXPECT_EQ(error_of([&] { (void)second.at("seed").get<std::uint32_t>(); }),
        "runs[1].seed: expected a whole number of at least 0, found \"seven\"");
    EXPECT_EQ(error_of([&] { (void)second.at("seed").number(); }),
        "runs[1].seed: expected a number, \"nan\", \"inf\" or \"-inf\", found \"seven\"");
    EXPECT_EQ(error_of([&] { (void)second.at("arm"); }), "runs[1]: expected an object with 'arm', found none");
    EXPECT_EQ(
        error_of([&] { (void)second.at("at").at("k"); }), "runs[1].at: expected an object with 'k', found a list of 2");
    EXPECT_EQ(
        error_of([&] { (void)second.at("at").at(2); }), "runs[1].at: expected a list of at least 3, found a list of 2");
    EXPECT_EQ(error_of([&] { (void)second.at("at").get<std::vector<std::string>>(); }),
        "runs[1].at: expected a list, each entry a text, found a list of 2");
    EXPECT_THAT(error_of([&] { (void)second.at("n").get<std::uint64_t>(); }), HasSubstr("found -1"));
    EXPECT_THAT(error_of([&] { (void)second.at("x").get<int>(); }), HasSubstr("found 1.5"));
    EXPECT_EQ(
        error_of([&] { (void)StoredJson(json).at("runs").items(); }), "runs: expected an object, found a list of 2");
    EXPECT_EQ(second.at("at").get<std::vector<int>>(), (std::vector<int>{1, 2}));
    EXPECT_EQ(second.value("none", std::string("otherwise")), "otherwise");
}

TEST(StoredJson, GoesIntoOtherJsonAsASingleValue) {
    const Json json = parse_json(R"({"name": "a", "empty": null, "holds": true, "list": [1], "object": {}})");
    const StoredJson stored(json);
    EXPECT_EQ(Json({{"x", stored.at("name")}, {"y", stored.at("empty")}, {"z", stored.at("holds")}}),
        Json({{"x", "a"}, {"y", nullptr}, {"z", true}}));
    EXPECT_EQ(error_of([&] { (void)Json({{"x", stored.at("list")}}); }),
        "list: expected a text, a number, true, false or null, found a list of 1");
    EXPECT_THAT(error_of([&] { (void)Json({{"x", stored.at("object")}}); }), HasSubstr("object: expected a text"));
}

TEST(StoredJson, HidesTheCodesOfTheLibrary) {
    for (const char* text : {"{", "[1, 2", "{\"a\": nan}", ""}) try {
            (void)parse_json(text, "file.json", "a result");
            FAIL() << text;
        } catch (const InputError& error) {
            EXPECT_THAT(error.what(), HasSubstr("file.json: expected a result: "));
            EXPECT_THAT(error.what(), Not(HasSubstr("json.exception")));
        }
    const Json json = {{"a", 1}};
    const auto fault_of = [&](const std::function<void()>& read) {
        try {
            read();
        } catch (const Json::exception& error) { return unreadable_json(error); }
        return std::string("nothing");
    };
    EXPECT_EQ(fault_of([&] { (void)json.at("b"); }), "expected an object with 'b', found none");
    EXPECT_EQ(
        fault_of([&] { (void)json.at("a").get<std::string>(); }), "expected a value of type string, found number");
    EXPECT_EQ(fault_of([&] { (void)json.at("a").at("b"); }), "expected a value of another type, found number");
}

}  // namespace stored_json_test
}  // namespace crescent
