// A sampler is queried in blocks of a quarter of a part; if the next one does not fit, the import api.pause leaves the
// module. The locals are saved in 128 KiB of memory, whose first two words are its bounds.
#include "pause.h"

#include <array>

#include "parts.h"

namespace crescent::web {

namespace {

/// Provided by the page: leaves the module, or returns to it.
extern "C" __attribute__((import_module("api"), import_name("pause"))) void door_pause();

/// The cost of one query of a sampler, in samples of a pixel: it is evaluated in double and one by one.
constexpr std::uint64_t answer_cost = 40;
constexpr std::size_t most_answers = most_of_part / answer_cost / 4;

/// Calls ask(from, count) for all of `size` in blocks.
template <class Ask> void in_blocks(std::size_t size, const Ask& ask) {
    for (std::size_t from = 0; from < size; from += most_answers) {
        const std::size_t count = std::min(most_answers, size - from);
        make_room(count * answer_cost);
        ask(from, count);
    }
}

class Paused : public ForwardingAdapter {
public:
    using ForwardingAdapter::ForwardingAdapter;
    void sample(int t, Vec3d wo, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        in_blocks(u.size(), [&](std::size_t from, std::size_t count) {
            inner().sample(t, wo, u.subspan(from, count), out.subspan(from, count));
        });
    }
    void pdf(int t, std::span<const Pair> at, std::span<double> out) const override {
        ask(at, out, [&](auto a, auto o) { inner().pdf(t, a, o); });
    }
    void exact_pdf(int t, std::span<const Pair> at, std::span<double> out) const override {
        ask(at, out, [&](auto a, auto o) { inner().exact_pdf(t, a, o); });
    }
    void mis_weight(int t, std::span<const Pair> at, std::span<double> out) const override {
        ask(at, out, [&](auto a, auto o) { inner().mis_weight(t, a, o); });
    }
    void f(std::span<const Pair> at, std::span<double> out) const override {
        ask(at, out, [&](auto a, auto o) { inner().f(a, o); });
    }
    void f_channels(std::span<const Pair> at, std::span<Vec3d> out) const override {
        ask(at, out, [&](auto a, auto o) { inner().f_channels(a, o); });
    }
    void reference_f(std::span<const Pair> at, std::span<double> out) const override {
        ask(at, out, [&](auto a, auto o) { inner().reference_f(a, o); });
    }
    void yield_to_host(std::size_t steps) const override { make_room(steps * step_cost); }

private:
    template <class Value, class Ask>
    void ask(std::span<const Pair> at, std::span<Value> out, const Ask& answer) const {
        in_blocks(at.size(),
            [&](std::size_t from, std::size_t count) { answer(at.subspan(from, count), out.subspan(from, count)); });
    }
};

/// Where a paused call keeps its locals: two addresses, from and to, then the memory between them.
alignas(16) std::array<std::uint32_t, 1 << 15> kept;

}  // namespace

void make_room(std::uint64_t cost) {
    if (work_of_part() + static_cast<double>(cost) > static_cast<double>(most_of_part)) door_pause();
    count_work(cost);
}

std::shared_ptr<const SamplerAdapter> paused(std::shared_ptr<const SamplerAdapter> sampler) {
    return std::make_shared<Paused>(std::move(sampler));
}

/// Returns that memory, empty.
CRESCENT_EXPORT(pause_buffer)()->const void* {
    kept[0] = static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(kept.data() + 4));
    kept[1] = static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(kept.data() + kept.size()));
    return kept.data();
}

}  // namespace crescent::web
