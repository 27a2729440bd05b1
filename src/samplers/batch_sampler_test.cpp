// Each kind of query reaches the function that answers it.
#include "samplers/batch_sampler.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"

namespace crescent {
namespace batch_sampler_test {

using ::testing::Each;
using Kind = SamplerQuery::Kind;

/// Answers draws with the density 2, pdf with 3 and f with 5.
class Constants : public BatchSampler {
public:
    SamplerDeclaration declaration() const override { return {.name = "constants", .has_f = true}; }
    mutable int calls = 0;

protected:
    void draw_rows(const SamplerQuery& query, std::span<Draw> out) const override {
        ++calls;
        EXPECT_EQ(query.u.size(), out.size());
        std::ranges::fill(out, Draw{{0, 0, 1}, 2});
    }
    void pdf_rows(const SamplerQuery& /*query*/, std::span<double> out) const override { answer(3, out); }
    void f_rows(const SamplerQuery& /*query*/, std::span<double> out) const override { answer(5, out); }

private:
    void answer(double value, std::span<double> out) const {
        ++calls;
        std::ranges::fill(out, value);
    }
};

const std::vector<Pair> pairs(3, Pair{{0, 0, 1}, {0, 0, 1}});

TEST(BatchSamplers, AnswerEachKindByItsFunction) {
    const Constants sampler;
    const std::vector<PrimarySample> u(3);
    std::vector<Draw> draws(3);
    sampler.sample(0, {0, 0, 1}, u, draws);
    for (const Draw& draw : draws) EXPECT_EQ(draw.pdf, 2);
    std::vector<double> values(3);
    const auto expect = [&](Kind kind, double value) {
        sampler.values(kind, 0, pairs, values);
        EXPECT_THAT(values, Each(value));
    };
    for (const Kind kind : {Kind::pdf, Kind::exact_pdf}) expect(kind, 3);
    for (const Kind kind : {Kind::f, Kind::target, Kind::reference_f}) expect(kind, 5);
    EXPECT_EQ(sampler.calls, 6);
    expect(Kind::mis_weight, 1);
    EXPECT_EQ(sampler.calls, 6) << "one technique has the weight 1 without a call";
}

TEST(BatchSamplers, HaveFInEachChannel) {
    std::vector<Vec3d> channels(3);
    Constants().f_channels(pairs, channels);
    for (const Vec3d& f : channels) EXPECT_TRUE(f.x == 5 && f.y == 5 && f.z == 5);
}

TEST(BatchSamplers, AreNotCalledForAQueryWithoutRows) {
    const Constants sampler;
    for (const Kind kind : {Kind::sample, Kind::pdf, Kind::f, Kind::f_channels, Kind::weigh})
        sampler.evaluate({.kind = kind}, {});
    EXPECT_EQ(sampler.calls, 0);
}

TEST(BatchSamplers, ThatDoNotWeighAreNotAskedTo) {
    std::vector<double> values(3);
    EXPECT_THROW(Constants().values(Kind::weigh, 0, pairs, values), Bug);
}

}  // namespace batch_sampler_test
}  // namespace crescent
