// dlopen() and dlsym(); the functions of sampler_plugin.h are handed whole batches of plain doubles. Those of a library
// that is serial are called under a lock.
#include "verdicts/plugin.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <filesystem>
#include <mutex>
#include <vector>

#include "base/contents.h"
#include "base/errors.h"
#include "base/text.h"
#include "verdicts/judge.h"
#include "verdicts/sampler_plugin.h"

namespace crescent::inline verdicts {

namespace {

struct Close {
    void operator()(void* library) const { dlclose(library); }
};

/// dlopen takes a name without a slash for one of the system's libraries.
std::string as_path(const std::string& path) { return path.find('/') == std::string::npos ? "./" + path : path; }

class Plugin : public PluginSampler {
public:
    Plugin(const std::string& path, const OutsideSurface& surface) : path_(path), surface_(surface) {
        library_.reset(dlopen(as_path(path).c_str(), RTLD_NOW | RTLD_LOCAL));
        if (!library_) throw OutputError(fmt::format("cannot open the plugin {}: {}", path, printable(dlerror())));
        const auto abi = needed<unsigned (*)()>("crescent_sampler_abi")();
        if (abi != CRESCENT_SAMPLER_ABI)
            throw OutputError(fmt::format("the plugin {} has version {} of the interface; this program has version {}",
                path, abi, CRESCENT_SAMPLER_ABI));
        sample_ = needed<decltype(sample_)>("crescent_sampler_sample");
        pdf_ = found<decltype(pdf_)>("crescent_sampler_pdf");
        f_ = found<decltype(f_)>("crescent_sampler_f");
        if (const auto numbers = found<unsigned (*)()>("crescent_sampler_numbers"))
            numbers_ = static_cast<int>(std::min(numbers(), 1000u));
        if (numbers_ < 1 || numbers_ > Numbers::most)
            throw OutputError(fmt::format(
                "the plugin {} takes {} random numbers a sample: expected 1 to {}", path, numbers_, Numbers::most));
        if (const auto serial = found<int (*)()>("crescent_sampler_serial")) serial_ = serial() != 0;
        const auto name = found<const char* (*)()>("crescent_sampler_name");
        name_ = name && name() ? printable(name()) : std::filesystem::path(path).filename().string();
    }

    std::string name() const override { return name_; }
    int numbers() const override { return numbers_; }
    bool serial() const override { return serial_; }
    Traits traits() const override {
        Traits traits;
        traits.numbers = numbers_;
        traits.has_pdf = pdf_ != nullptr;
        return traits;
    }
    bool has_f() const override { return f_ != nullptr; }

    void draw(const OutsideBatch& batch, std::span<OutsideDraw> out) const override {
        const std::vector<Vec3d> wo(out.size(), batch.wo);
        const std::vector<OutsideSurface> surface(out.size(), batch.surface);
        std::vector<Vec3d> wi(out.size());
        std::vector<double> pdf(out.size());
        call("sample", [&] { return sample_(out.size(), &wo[0].x, batch.u.data(), &surface[0].s, &wi[0].x, &pdf[0]); });
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = {wi[i], pdf[i]};
    }

    void sample(int /*technique*/, Vec3d wo, std::span<const Numbers> u, std::span<Draw> out) const override {
        std::vector<double> numbers;
        for (const Numbers& row : u)
            for (int k = 0; k < numbers_; ++k) numbers.push_back(row[k]);
        std::vector<OutsideDraw> draws(u.size());
        if (!u.empty()) draw({wo, surface_, numbers}, draws);
        count(u.size());
        std::ranges::transform(draws, out.begin(), [](const OutsideDraw& d) { return Draw{d.wi, d.pdf}; });
    }
    void pdf(int /*technique*/, std::span<const Pair> at, std::span<double> out) const override {
        ask("pdf", pdf_, at, out);
    }
    void f(std::span<const Pair> at, std::span<double> out) const override { ask("f", f_, at, out); }

private:
    using Answer = int (*)(size_t, const double*, const double*, const double*, double*);

    template <class F> F found(const char* symbol) const { return reinterpret_cast<F>(dlsym(library_.get(), symbol)); }
    template <class F> F needed(const char* symbol) const {
        if (const F there = found<F>(symbol)) return there;
        throw OutputError(fmt::format("the plugin {} has no function {}: see sampler_plugin.h", path_, symbol));
    }

    template <class Call> void call(const char* what, Call&& ask_it) const {
        std::unique_lock<std::mutex> one_at_a_time(lock_, std::defer_lock);
        if (serial_) one_at_a_time.lock();
        if (const int code = ask_it(); code != 0)
            throw SubjectFault(
                fmt::format("the plugin {}: crescent_sampler_{} gave {}: expected 0", path_, what, code));
    }

    void ask(const char* what, Answer answer, std::span<const Pair> at, std::span<double> out) const {
        if (at.empty()) return;
        std::vector<Vec3d> wo, wi;
        for (const Pair& pair : at) wo.push_back(pair.wo), wi.push_back(pair.wi);
        const std::vector<OutsideSurface> surface(at.size(), surface_);
        call(what, [&] { return answer(at.size(), &wo[0].x, &wi[0].x, &surface[0].s, out.data()); });
        count(at.size());
    }

    std::string path_, name_;
    OutsideSurface surface_;
    std::unique_ptr<void, Close> library_;
    int (*sample_)(size_t, const double*, const double*, const double*, double*, double*) = nullptr;
    Answer pdf_ = nullptr, f_ = nullptr;
    int numbers_ = 2;
    bool serial_ = false;
    mutable std::mutex lock_;
};

static_assert(sizeof(Vec3d) == 3 * sizeof(double) && sizeof(OutsideSurface) == 4 * sizeof(double));

}  // namespace

std::shared_ptr<const PluginSampler> open_plugin(const std::string& path, const OutsideSurface& surface) {
    return std::make_shared<Plugin>(path, surface);
}

std::uint64_t plugin_mark(const std::string& path) {
    const std::string bytes = contents_of(path);
    return XXH3_64bits(bytes.data(), bytes.size());
}

}  // namespace crescent::inline verdicts
