// The handshake of programs, and the errors for those that break the protocol.
#include "check/sources/pipe.h"

#include <cmath>
#include <csignal>
#include <gtest/gtest.h>
#include <limits>
#include <numeric>

#include "check/sources/check_case.h"
#include "check/sources/external.h"
#include "check/sources/pipe_io.h"
#include "samplers/surface_context.h"

namespace crescent {
namespace pipe_test {

/// Returns the error for a program with this time limit and number of draws.
std::string fault_of(const std::string& command, double seconds = 30, std::size_t draws = 100) {
    PipeLimits limits;
    limits.hello_seconds = limits.quiet_seconds = seconds;
    try {
        const auto pipe = start_pipe(command, limits);
        std::vector<PrimarySample> u(draws, {0.5, 0.5});
        std::vector<Draw> out(draws);
        pipe->sample(0, {0, 0, 1}, u, out);
    } catch (const SamplerError& fault) { return fault.what(); }
    return "";
}

TEST(Pipes, SayWhatAProgramDidWrongAndWhere) {
    EXPECT_NE(
        fault_of("sleep 20", 0.5).find("request 1 ('hello 2'): expected 'hello 2 NAME [KEY=VALUE]...', got nothing"),
        std::string::npos);
    EXPECT_NE(fault_of("exec 3<&0; sleep 20 <&3 & exit 0", 5)
                  .find("the program ended with exit code 0, and what it left running"),
        std::string::npos);
    EXPECT_NE(fault_of("echo hallo").find("got 'hallo'"), std::string::npos);
    EXPECT_NE(fault_of("exit 3").find("exit code 3"), std::string::npos);
    EXPECT_NE(fault_of("echo hello 2 x; echo 1; exit 0").find("request"), std::string::npos);
    EXPECT_NE(fault_of("yes").find("got 'y'"), std::string::npos);
    EXPECT_NE(fault_of("read h; echo hello 2 x block=f64; head -c 9 >/dev/null; exit 5").find("exit code 5"),
        std::string::npos);
    EXPECT_NE(fault_of("tr -d '\\n' < /dev/zero").find("more than 4096 bytes"), std::string::npos);
}

/// The library does not change the signals of its process, and a program's end does not kill it.
TEST(Pipes, ThatBreakTouchNoSignal) {
    const auto before = std::signal(SIGPIPE, SIG_DFL);
    try {
        const auto pipe = start_pipe("read hello; echo hello 2 x; read f; echo -; exec <&-; sleep 10");
        std::vector<PrimarySample> u(100000, {0.5, 0.5});
        std::vector<Draw> out(u.size());
        pipe->sample(0, {0, 0, 1}, u, out);
        ADD_FAILURE() << "it answered";
    } catch (const SamplerError& fault) {
        EXPECT_NE(std::string(fault.what()).find("closed its input"), std::string::npos) << fault.what();
    }
    sigset_t pending;
    sigpending(&pending);
    EXPECT_FALSE(sigismember(&pending, SIGPIPE));
    EXPECT_EQ(std::signal(SIGPIPE, before), SIG_DFL);
}

TEST(Greetings, SayWhatAProgramIs) {
    Handshake g;
    EXPECT_EQ(
        read_handshake("hello 2 my glass u=3 domain=sphere wo=both channels=3 weight=yes delta=yes eta=1.5,1.51,1.52 "
                       "transport=importance f=cos reciprocal=no random=own real=f32 block=f64 u_bits=53 "
                       "device=a%20%3Ddevice driver=Mesa%2025%25",
            g)
            .answer_text,
        "");
    EXPECT_EQ(g.name, "my glass");
    EXPECT_EQ(g.traits.numbers, 3);
    EXPECT_EQ(g.traits.channels, 3);
    EXPECT_TRUE(g.traits.delta && g.weight && g.f_cos && g.blocks() && g.traits.importance && g.traits.own_random);
    EXPECT_FALSE(g.traits.reciprocal || g.hemisphere);
    EXPECT_EQ(g.traits.wo, Traits::WoDomain::both);
    EXPECT_DOUBLE_EQ(g.traits.eta->z, 1.52);
    EXPECT_EQ(g.traits.bits, 24);
    EXPECT_EQ(g.traits.u_bits, 53);
    EXPECT_EQ(g.device.text(), "a =device, Mesa 25%, single precision");
}

TEST(Greetings, SayWhatAProgramUsesOfTheSurface) {
    Handshake g;
    EXPECT_EQ(read_handshake("hello 2 mine uses=lights,rho_d,s", g).answer_text, "");
    EXPECT_EQ(g.uses, (std::vector<std::string>{"lights", "rho_d", "s"}));
    EXPECT_TRUE(g.uses_lights());
    EXPECT_EQ(context_columns(g.uses, 2), 1 + 2 * 18 + 3 + 1);
    const std::vector<double> one = example_context(g.uses);
    ASSERT_EQ(one.size(), context_columns(g.uses, 1));
    EXPECT_EQ(one.front(), 1);  // lights
    EXPECT_EQ(one.back(), 32);  // s
}

TEST(Greetings, SayWhatIsKnownWhereAKeyIsNot) {
    const auto fault = [](const char* answer) {
        Handshake g;
        const HandshakeError fault = read_handshake(answer, g);
        return fault ? "expected " + fault.expected + ", " + fault.answer_text : "";
    };
    EXPECT_NE(fault("hello 2 x colour=3").find("expected one of u, domain, wo, channels"), std::string::npos);
    EXPECT_NE(fault("hello 2 x colour=3").find("got the unknown key 'colour'"), std::string::npos);
    EXPECT_NE(fault("hello 2 x weights=yes").find("did you mean 'weight'?"), std::string::npos);
    EXPECT_NE(fault("hello 2 x u=9").find("expected a whole number from 1 to 8 for u, got '9'"), std::string::npos);
    for (const char* text : {"", "%2", "%2x", "a%"})
        EXPECT_NE(fault((std::string("hello 2 x device=") + text).c_str()).find("%20 is a space"), std::string::npos);
    EXPECT_NE(fault("hello 2 x delta=yes").find("weight=yes"), std::string::npos);
    EXPECT_NE(fault("hello 2 x block=f32 u_bits=53").find("expected u_bits=24"), std::string::npos);
    EXPECT_NE(fault("hello 2 x block=f16").find("expected f32 or f64 for block, got 'f16'"), std::string::npos);
    EXPECT_NE(fault("hello 2 x merge=yes").find("expected weight=reciprocal"), std::string::npos)
        << fault("hello 2 x merge=yes");
    EXPECT_NE(fault("hello 2 x weight=reciprocal merge=yes uses=alpha").find("no uses="), std::string::npos);
    EXPECT_NE(fault("hello 2 x u=3 wo=both u=2").find("got the key 'u' twice"), std::string::npos);
    EXPECT_NE(fault("hello 2 u=3").find("no name"), std::string::npos);
    EXPECT_NE(fault("hello 4 x").find("got 'hello 4 x'"), std::string::npos);
    EXPECT_NE(fault("hello 2 x uses=alpha,alpha").find("got 'alpha,alpha'"), std::string::npos);
    EXPECT_NE(fault("hello 1 x").find("got 'hello 1 x'; write 'hello 2 x'"), std::string::npos);
    EXPECT_NE(fault("hello 3 x uses=s").find("write 'hello 2 x uses=s'"), std::string::npos);
}

/// The responses to f are blocks of one NaN and of eight; then an error, and a block of another size.
TEST(Greetings, BlocksThatSayAnErrorAreTold) {
    const std::string nan = "printf '\\000\\000\\000\\000\\000\\000\\370\\177'; ";
    const std::string start =
        "read hello; echo hello 2 x block=f64; head -c 56 >/dev/null; printf '\\001\\000\\000\\000'; " + nan +
        "head -c 392 >/dev/null; printf '\\010\\000\\000\\000'; for k in 1 2 3 4 5 6 7 8; do " + nan + "done; ";
    EXPECT_NE(
        fault_of(
            start + "head -c 408 >/dev/null; printf '\\000\\000\\000\\000\\007\\000\\000\\000no luck'; sleep 3", 2, 10)
            .find("got an error: 'no luck'"),
        std::string::npos);
    EXPECT_NE(fault_of(start + "head -c 408 >/dev/null; printf '\\003\\000\\000\\000'; sleep 3", 2, 10)
                  .find("got a block of 3 rows for one of 10"),
        std::string::npos);
}

/// The responses to f are as above. The program returns its numbers as x and y of a direction, and 2 as the pdf.
TEST(Greetings, BlocksHaveTheDeclaredPrecision) {
    const std::string nan = "printf '\\000\\000\\300\\177'; ";
    const auto pipe =
        start_pipe("read hello; echo hello 2 x block=f32; head -c 32 >/dev/null; printf '\\001\\000\\000\\000'; " +
            nan + "head -c 200 >/dev/null; printf '\\010\\000\\000\\000'; for k in 1 2 3 4 5 6 7 8; do " + nan +
            "done; head -c 20 >/dev/null; printf '\\001\\000\\000\\000'; head -c 8; "
            "printf '\\000\\000\\200\\077\\000\\000\\000\\100'; sleep 1");
    EXPECT_FALSE(pipe->has_f());
    const PrimarySample u(0x123457p-24, 0.75);
    Draw out;
    pipe->sample(0, {0, 0, 1}, {&u, 1}, {&out, 1});
    EXPECT_EQ(out.wi.x, u.x);
    EXPECT_EQ(out.wi.y, u.y);
    EXPECT_EQ(out.wi.z, 1);
    EXPECT_EQ(out.pdf, 2);
}

/// The program returns its number as x of a direction.
TEST(PipeNumbers, AreOddMultiplesOfTheirResolution) {
    const auto received = [](const std::string& key, double u) {
        const auto pipe = start_pipe("read hello; echo 'hello 2 echo u=1 " + key +
            "'; while read what a b c d; do case $what in sample) echo $d 0 1 1;; *) echo -;; esac; done");
        const PrimarySample one(u, 0);
        Draw out;
        pipe->sample(0, {0, 0, 1}, {&one, 1}, {&out, 1});
        return out.wi.x;
    };
    const double third = 1.0 / 3;
    EXPECT_EQ(received("", third), (std::floor(third * 0x1p23) * 2 + 1) * 0x1p-24);
    EXPECT_EQ(received("", 0), 0);  // a corner is sent as it is
    EXPECT_EQ(received("", 1 - 0x1p-24), 1 - 0x1p-24);
    EXPECT_EQ(received("u_bits=53", third), third);
}

/// f fails at w_o = w_i = n, where it is requested first.
TEST(Greetings, FindAnFThatFailsAlongTheNormal) {
    const auto has_f = [](const std::string& answer) {
        return start_pipe("read hello; echo hello 2 x; while read what; do echo " + answer + "; done")->has_f();
    };
    EXPECT_TRUE(has_f("0.1"));
    EXPECT_TRUE(has_f("nan"));
    EXPECT_FALSE(has_f("-"));
}

TEST(PipeNumbers, AreReadAndWrittenExactly) {
    const auto read = [](std::string_view text) {
        double out = -7;
        return take_float(text, out) ? out : -7;
    };
    EXPECT_EQ(read(" \t1.5 2"), 1.5);
    EXPECT_EQ(read("-0x1.8p1"), -3);
    EXPECT_EQ(read("+2"), 2);
    EXPECT_TRUE(std::isnan(read("nan")));
    EXPECT_EQ(read("-inf"), -std::numeric_limits<double>::infinity());
    EXPECT_EQ(read("1e999"), std::numeric_limits<double>::infinity());
    EXPECT_EQ(read("-1e-999"), 0);
    EXPECT_EQ(read("0.000001e310"), 1e304);
    EXPECT_EQ(read("0x1p-9999"), 0);
    for (const char* bad : {"", "x", "1x", "--1", "+-1", "0x", "1,5"}) EXPECT_EQ(read(bad), -7) << bad;
    for (const double v : {0.1, 1 / 3.0, 5e-324, -1.7976931348623157e308}) {
        std::string text;
        append(text, v);
        EXPECT_EQ(read(text), v);
    }
    EXPECT_TRUE(blank(" \t"));
    EXPECT_FALSE(blank(" x"));
    EXPECT_EQ(quote(std::string("a\x01", 2)), "'a\\x01'");
    EXPECT_EQ(quote(std::string(90, 'a')).size(), 80u + 5);
}

TEST(PipeLines, AreAnsweredInOrder) {
    PipeConnection echo("cat", {}, "cat");
    std::vector<std::string> got;
    const auto write = [](std::size_t i, std::string& line) { line = "row " + std::to_string(i); };
    const auto read = [&](std::size_t i, std::string_view line) {
        got.emplace_back(line);
        return line == "row " + std::to_string(i);
    };
    echo.lines(20000, "the same line", write, read);  // more than a pipe holds
    EXPECT_EQ(got.size(), 20000u);
    EXPECT_EQ(got.back(), "row 19999");
    EXPECT_EQ(echo.spending().answers, 20000u);
    const auto never = [](std::size_t, std::string_view) { return false; };
    EXPECT_THROW(echo.lines(1, "another line", write, never), SamplerError);
    EXPECT_FALSE(echo.broken().empty());
    EXPECT_THROW(echo.lines(1, "the same line", write, read), SamplerError);  // nothing is sent any more
}

#ifdef __linux__
/// The program copies what is given in a slot of 16 MiB to its second half, and sends the counts back.
TEST(PipeBlocks, MayBeInMemory) {
    PipeConnection copy(
        "head=$(mktemp); k=0; while dd bs=8 count=1 of=$head 2>/dev/null && [ -s $head ]; do "
        "dd if=/proc/self/fd/3 of=/proc/self/fd/3 bs=1M skip=$((16 * k)) seek=$((16 * k + 8)) count=1 "
        "2>/dev/null; tail -c 4 $head; k=$((1 - k)); done; rm $head",
        {}, "copy", true);
    ASSERT_TRUE(copy.use_memory());
    std::vector<double> in(3 * 65536 + 5), out(in.size());
    std::iota(in.begin(), in.end(), 1.0);
    for (int k = 0; k < 2; ++k) {
        copy.blocks({.operation = "copy",
            .count = in.size(),
            .in = in,
            .out = out,
            .is_single = true,
            .expected = "the same rows",
            .describe = [](std::size_t i) { return "row " + std::to_string(i); }});
        EXPECT_EQ(out, in) << k;
        std::ranges::reverse(in);
    }
}
#endif

TEST(PipeBlocks, NeedMemoryThatWasOffered) {
    EXPECT_THROW(start_pipe("read hello; echo hello 2 x block=f32 memory=yes; sleep 3"), SamplerError);
    PipeConnection other("cat", {}, "cat");
    EXPECT_FALSE(other.use_memory());
}

TEST(PythonSamplers, AreNamedByAFileOrAModule) {
    for (const char* name : {"a.py", "dir/a.py:Glass", "package.module:Glass"}) EXPECT_TRUE(names_python_sampler(name));
    for (const char* name : {"cosine", "a.toml", "./a.so"}) EXPECT_FALSE(names_python_sampler(name)) << name;
}

}  // namespace pipe_test
}  // namespace crescent
