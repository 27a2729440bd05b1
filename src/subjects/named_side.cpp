// A fault is thrown again with the side in front and with its kind kept: too slow, given up before, or new.
#include "subjects/named_side.h"

#include <fmt/format.h>

#include "base/text.h"
#include "subjects/faults.h"
#include "subjects/forwarded.h"

namespace crescent::inline subjects {

namespace {

constexpr std::string_view opening = "sampler ";  // no fault of a sampler itself begins so

class NamedSide : public ForwardedSampler {
public:
    NamedSide(std::shared_ptr<const JudgedSampler> sampler, const std::string& side)
        : ForwardedSampler(std::move(sampler)),
          who_(fmt::format("{}{} ({}): ", opening, side, printable(inner().name(), 40))) {}
    void sample(int t, Vec3d wo, std::span<const Numbers> u, std::span<Draw> out) const override {
        ask([&] { inner().sample(t, wo, u, out); });
    }
    void pdf(int t, std::span<const Pair> at, std::span<double> out) const override {
        ask([&] { inner().pdf(t, at, out); });
    }
    void exact_pdf(int t, std::span<const Pair> at, std::span<double> out) const override {
        ask([&] { inner().exact_pdf(t, at, out); });
    }
    void mis_weight(int t, std::span<const Pair> at, std::span<double> out) const override {
        ask([&] { inner().mis_weight(t, at, out); });
    }
    void f(std::span<const Pair> at, std::span<double> out) const override {
        ask([&] { inner().f(at, out); });
    }
    void f_channels(std::span<const Pair> at, std::span<Vec3d> out) const override {
        ask([&] { inner().f_channels(at, out); });
    }
    void true_f(std::span<const Pair> at, std::span<double> out) const override {
        ask([&] { inner().true_f(at, out); });
    }

private:
    std::string who_;

    std::string told(const SubjectFault& fault) const {
        const std::string_view what = fault.what();
        return what.starts_with(opening) ? std::string(what) : who_ + std::string(what);
    }
    template <class Call> void ask(Call&& call) const {
        try {
            call();
        } catch (const SubjectTooSlow& fault) { throw SubjectTooSlow(told(fault)); } catch (const SubjectGone& fault) {
            throw SubjectGone(told(fault));
        } catch (const SubjectFault& fault) { throw SubjectFault(told(fault)); }
    }
};

}  // namespace

std::shared_ptr<const JudgedSampler> named_side(std::shared_ptr<const JudgedSampler> sampler, const std::string& side) {
    if (!sampler->draws_at_will() || !sampler->limited()) return sampler;
    return std::make_shared<NamedSide>(std::move(sampler), side);
}

}  // namespace crescent::inline subjects
