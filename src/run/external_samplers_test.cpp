// Samplers of arms that are not built in: which are opened, and the mistakes that name their arm.
#include "run/external_samplers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "tests/support/test_scene.h"

namespace crescent {
namespace external_samplers_test {

using ::testing::HasSubstr;

class Fixed : public SamplerSource {
public:
    std::string name() const override { return "fixed"; }
    void sample(int, Vec3d, std::span<const PrimarySample>, std::span<Draw>) const override {}
    void pdf(int, std::span<const Pair>, std::span<double>) const override {}
};

/// The small scene with the arm "mine".
Experiment with_arm(const std::string& value) { return test::small_scene({"arms.mine." + value, "arms.mine.n=[4]"}); }

template <class Error> std::string message_of(const Experiment& e) {
    try {
        (void)open_external(e);
    } catch (const Error& error) { return error.what(); }
    return "";
}

TEST(ExternalArms, GivenSamplersAreNotOpened) {
    const auto fixed = std::make_shared<Fixed>();
    const Experiment e = with_arm("exec='./no such program'");
    const ExternalSamplers all = open_external(e, 0, {{"mine", fixed}});
    EXPECT_EQ(external_of(all, "mine"), fixed.get());
    EXPECT_EQ(external_of(all, "cosine"), nullptr);
    EXPECT_TRUE(open_external(test::small_scene()).empty());
}

TEST(ExternalArms, MistakesNameTheArm) {
    EXPECT_THAT(message_of<InputError>(with_arm("exec='./nowhere 2>/dev/null'")), HasSubstr("arms.mine.exec"));
    EXPECT_THAT(message_of<OutputError>(with_arm("exec='exit 3'")), HasSubstr("'mine'"));
    EXPECT_THAT(message_of<OutputError>(with_arm("exec='exit 3'")), HasSubstr("exit code 3"));
}

TEST(ExternalArms, ProgramsMayChangeBetweenRuns) {
    EXPECT_TRUE(may_change(with_arm("exec='./it'")));
    EXPECT_FALSE(may_change(test::small_scene()));
    EXPECT_FALSE(may_change(with_arm("plugin='./it.so'")));  // its hash is a part of the experiment's
}

}  // namespace external_samplers_test
}  // namespace crescent
