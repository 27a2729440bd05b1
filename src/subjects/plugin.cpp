// dlopen() and dlsym(); the functions of sampler_plugin.h are handed whole batches of plain doubles. Those of a library
// that is serial are called under a lock. Every call is noted for its thread, and nothing that is thrown there gets
// beyond it as it is.
#include "subjects/plugin.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <filesystem>
#include <mutex>
#include <vector>

#include "base/contents.h"
#include "base/errors.h"
#include "base/text.h"
#include "subjects/faults.h"
#include "subjects/sampler_plugin.h"

namespace crescent::inline subjects {

namespace {

struct Close {
    void operator()(void* library) const { dlclose(library); }
};

/// dlopen takes a name without a slash for one of the system's libraries.
std::string as_path(const std::string& path) { return path.find('/') == std::string::npos ? "./" + path : path; }

constinit thread_local PluginCall current{};

/// What is called is noted while it lives.
class Noted {
public:
    explicit Noted(const PluginCall& call) {
        current = call;
        std::atomic_signal_fence(std::memory_order_seq_cst);
    }
    ~Noted() {
        std::atomic_signal_fence(std::memory_order_seq_cst);
        current = {};
    }
    Noted(const Noted&) = delete;
    Noted& operator=(const Noted&) = delete;
};

/// Calls into a library; what it throws becomes a fault of it.
template <class Call> auto called(const PluginCall& what, Call&& call) {
    const Noted noted(what);
    try {
        return call();
    } catch (const std::exception& e) {
        throw SubjectFault(fmt::format("the plugin {} threw '{}'", to_string(what), printable(e.what())));
    } catch (...) { throw SubjectFault(fmt::format("the plugin {} threw something", to_string(what))); }
}

class Plugin : public PluginSampler {
public:
    Plugin(const std::string& path, const OutsideSurface& surface) : path_(path), surface_(surface) {
        library_.reset(told<void*>("dlopen", [&] { return dlopen(as_path(path).c_str(), RTLD_NOW | RTLD_LOCAL); }));
        if (!library_) throw OutputError(fmt::format("cannot open the plugin {}: {}", path, printable(dlerror())));
        const auto abi = told<unsigned>("crescent_sampler_abi", needed<unsigned (*)()>("crescent_sampler_abi"));
        if (abi != CRESCENT_SAMPLER_ABI)
            throw OutputError(fmt::format("the plugin {} has version {} of the interface; this program has version {}",
                path, abi, CRESCENT_SAMPLER_ABI));
        sample_ = needed<decltype(sample_)>("crescent_sampler_sample");
        pdf_ = found<decltype(pdf_)>("crescent_sampler_pdf");
        f_ = found<decltype(f_)>("crescent_sampler_f");
        if (const auto numbers = found<unsigned (*)()>("crescent_sampler_numbers"))
            numbers_ = static_cast<int>(std::min(told<unsigned>("crescent_sampler_numbers", numbers), 1000u));
        if (numbers_ < 1 || numbers_ > Numbers::most)
            throw OutputError(fmt::format(
                "the plugin {} takes {} random numbers a sample: expected 1 to {}", path, numbers_, Numbers::most));
        if (const auto serial = found<int (*)()>("crescent_sampler_serial"))
            serial_ = told<int>("crescent_sampler_serial", serial) != 0;
        const auto named = found<const char* (*)()>("crescent_sampler_name");
        const char* name = named ? told<const char*>("crescent_sampler_name", named) : nullptr;
        name_ = name ? printable(name) : std::filesystem::path(path).filename().string();
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
        call("crescent_sampler_sample", batch.wo,
            [&] { return sample_(out.size(), &wo[0].x, batch.u.data(), &surface[0].s, &wi[0].x, &pdf[0]); });
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
        ask("crescent_sampler_pdf", pdf_, at, surface_, out);
    }
    void f(std::span<const Pair> at, std::span<double> out) const override {
        ask("crescent_sampler_f", f_, at, surface_, out);
    }
    bool has_density() const override { return pdf_ != nullptr; }
    void density(
        Vec3d wo, const OutsideSurface& surface, std::span<const Vec3d> wi, std::span<double> out) const override {
        std::vector<Pair> at;
        for (const Vec3d& w : wi) at.push_back({wo, w});
        ask("crescent_sampler_pdf", pdf_, at, surface, out);
    }

private:
    using Answer = int (*)(size_t, const double*, const double*, const double*, double*);

    template <class F> F found(const char* symbol) const { return reinterpret_cast<F>(dlsym(library_.get(), symbol)); }
    template <class F> F needed(const char* symbol) const {
        if (const F there = found<F>(symbol)) return there;
        throw OutputError(fmt::format("the plugin {} has no function {}: see sampler_plugin.h", path_, symbol));
    }

    /// What is asked once, when the library is opened.
    template <class R, class Call> R told(const char* what, Call&& ask_it) const {
        return called({path_.c_str(), what, {}}, [&]() -> R { return ask_it(); });
    }

    template <class Call> void call(const char* what, Vec3d wo, Call&& ask_it) const {
        std::unique_lock<std::mutex> one_at_a_time(lock_, std::defer_lock);
        if (serial_) one_at_a_time.lock();
        if (const int code = called({path_.c_str(), what, wo}, ask_it); code != 0)
            throw SubjectFault(fmt::format("the plugin {}: {} gave {}: expected 0", path_, what, code));
    }

    void ask(const char* what, Answer answer, std::span<const Pair> at, const OutsideSurface& on,
        std::span<double> out) const {
        if (at.empty()) return;
        std::vector<Vec3d> wo, wi;
        for (const Pair& pair : at) wo.push_back(pair.wo), wi.push_back(pair.wi);
        const std::vector<OutsideSurface> surface(at.size(), on);
        call(what, wo[0], [&] { return answer(at.size(), &wo[0].x, &wi[0].x, &surface[0].s, out.data()); });
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

PluginCall plugin_call() noexcept { return current; }

std::string to_string(const PluginCall& call) {
    std::string out = fmt::format("{}: {}", printable(call.library), call.what);
    if (call.wo.x != 0 || call.wo.y != 0 || call.wo.z != 0)
        out += fmt::format(" at w_o = ({:.9g}, {:.9g}, {:.9g})", call.wo.x, call.wo.y, call.wo.z);
    return out;
}

std::uint64_t plugin_mark(const std::string& path) {
    const std::string bytes = contents_of(path);
    return XXH3_64bits(bytes.data(), bytes.size());
}

}  // namespace crescent::inline subjects
