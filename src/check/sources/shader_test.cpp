// What the host of a shader is given, and what is said if it cannot be started. tests/system/shader.sh checks shaders.
#include "check/sources/shader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "base/errors.h"
#include "check/gtest.h"
#include "check/sources/pipe.h"
#include "tests/support/scratch_folder.h"

namespace crescent {
namespace shader_test {

using ::testing::HasSubstr;

class ShaderSampler : public ScratchFolder {
protected:
    ~ShaderSampler() override { ::unsetenv("CRESCENT_PYTHON"); }
    /// The message of shader_sampler() with this interpreter.
    static std::string error_with(const std::string& interpreter, const ShaderOptions& options) {
        ::setenv("CRESCENT_PYTHON", interpreter.c_str(), 1);
        try {
            shader_sampler("lobes.wgsl", options);
        } catch (const OutputError& error) { return error.what(); }
        return "no OutputError";
    }
    /// An interpreter that answers with its words.
    std::string echoing_interpreter() const {
        const std::string file =
            write("python", "#!/bin/sh\nread hello\nprintf 'missing'\nprintf ' <%s>' \"$@\"\necho\n");
        std::filesystem::permissions(file, std::filesystem::perms::owner_all);
        return file;
    }
};

TEST_F(ShaderSampler, GivesItsOptionsToTheHost) {
    const std::string said = error_with(echoing_interpreter(),
        {.sample = "wi = draw(u)",
            .f_cos = "f(wi)",
            .set = {{"alpha", 0.3F}, {"k", {1, 2.5}}, {"n", 3}, {"on", true}},
            .let = {"var s = 1u", "let t = 2"},
            .numbers = 3,
            .include = {"a folder"},
            .define = {{"X", ""}, {"Y", "1"}},
            .domain = "disk x line:0,1",
            .eta = {1.5, 2, 2.5},
            .reciprocal = false,
            .importance = true});
    for (const char* word :
        {"<-m> <crescent_shader>", "<--sample=wi = draw(u)>", "<--f-cos=f(wi)>", "<--set=alpha=0.30000001192092896>",
            "<--set=k=1.0,2.5>", "<--set=n=3>", "<--set=on=true>", "<--let=var s = 1u> <--let=let t = 2>",
            "<--numbers=3>", "<-Ia folder>", "<-DX> <-DY=1>", "<--domain=disk x line:0,1>", "<--eta=1.5,2,2.5>",
            "<--no-reciprocal>", "<--transport=importance>", "<--> <lobes.wgsl>"})
        EXPECT_THAT(said, HasSubstr(word));
    EXPECT_THAT(said, ::testing::Not(HasSubstr("--pdf")));
}

TEST_F(ShaderSampler, GivesFloatsAPointOrAnExponent) {
    EXPECT_EQ(ShaderValue(2.0).text(), "2.0");
    EXPECT_EQ(ShaderValue(-0.25).text(), "-0.25");
    EXPECT_EQ(ShaderValue(1e-30).text(), "1e-30");
}

TEST_F(ShaderSampler, NamesAPartThatIsMissing) {
    EXPECT_THAT(error_with("/nowhere/python", {}), HasSubstr("pip install 'crescent-bench[shader]'"));
}

/// The answers to requests for a pdf have too many numbers.
TEST(ProgramSamplers, AreCheckedAndPrintedAsAStructIs) {
    const std::shared_ptr<const SamplerAdapter> sampler = start_pipe(
        "read hello; echo hello 2 my lobe; while read line; do case $line in f*) echo -;; *) echo 0 0 1 1;; "
        "esac; done");
    EXPECT_EQ(testing::PrintToString(sampler), "my lobe");
    const TestSettings settings{.wo = {{30, 0}}};
    const CheckResult result = check_sampler("mine", sampler, settings);
    EXPECT_EQ(result.state, State::error);
    EXPECT_EQ(result.verdicts[0].arm, "mine");
    EXPECT_THAT(sampler, testing::Not(IsARightSamplerBy(settings)));
}

}  // namespace shader_test
}  // namespace crescent
