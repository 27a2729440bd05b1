// A host process is started if a thread calls and none is free, and then kept. A request has the surface once for each
// run of rows.
#include "check/sources/plugin.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <vector>

#include "base/errors.h"
#include "base/host_program.h"
#include "base/process.h"
#include "base/progress.h"
#include "base/shared_memory.h"
#include "base/text.h"
#include "check/sources/external.h"
#include "check/sources/plugin_host.h"
#include "samplers/batch_sampler.h"

namespace crescent {

namespace {

using Clock = std::chrono::steady_clock;

/// The declaration of a library in the handshake of its host.
struct PluginInfo {
    std::string name;
    int numbers = 2;
    bool has_pdf = false, has_f = false, is_serial = false;
    std::vector<std::string> uses{};  // of context_names(); empty: s, alpha, diffuse and lobe
};

struct Call {
    const char* function;
    Vec3d wo;  // of the first row
    /// "in crescent_sampler_sample at w_o = (0, 0, 1)".
    std::string text() const {
        return fmt::format("in {} at w_o = ({:.9g}, {:.9g}, {:.9g})", function, wo.x, wo.y, wo.z);
    }
};

/// A process with the library loaded. Used by one thread at a time, and not after a fault.
class Host {
public:
    Host(const std::string& library, const PipeLimits& limits)
        : library_(printable(library)),
          limits_(limits),
          process_({.argv = {plugin_host_name, library},
              .file = host_program(),
              .label = std::filesystem::path(library).filename().string(),
              .shared = memory_.file()}) {
        read_handshake(receive_line("while it was opened"));
    }
    ~Host() { process_.end(200); }
    Host(const Host&) = delete;
    Host& operator=(const Host&) = delete;

    const PluginInfo& info() const { return info_; }

    /// Sends one request: its runs, and the random numbers or directions of its rows. The answer is valid until the
    /// next request.
    PluginRows query(
        char operation, const SceneRows& batch, std::span<const double> input, std::size_t rows, const Call& call) {
        const PluginRows block(memory_.at(), rows, input.size() / rows);
        std::ranges::copy(input, block.input);
        const std::size_t lights = batch.lights.size();
        const std::size_t surface = info_.uses.empty() ? 4 : context_columns(info_.uses, lights);
        const PluginRequest head{.operation = operation,
            .runs = static_cast<std::uint32_t>(batch.runs.size()),
            .rows = static_cast<std::uint32_t>(rows),
            .columns = static_cast<std::uint32_t>(surface)};
        std::vector<double> columns;
        for (std::size_t i = 0; i < batch.runs.size(); ++i) {
            const SurfaceRun& r = batch.runs[i];
            columns.insert(columns.end(), {static_cast<double>(r.rows), r.wo.x, r.wo.y, r.wo.z});
            if (info_.uses.empty())
                columns.insert(columns.end(), {r.surface.s, r.surface.alpha, r.surface.diffuse, r.surface.lobe});
            else add_context(info_.uses, r, batch.lights, batch.lights_of_run(i), columns);
        }
        std::string front(reinterpret_cast<const char*>(&head), sizeof head);
        front.append(reinterpret_cast<const char*>(columns.data()), columns.size() * sizeof(double));
        const std::string what = call.text();
        send(front, what);
        PluginAnswer answer{};
        receive({reinterpret_cast<char*>(&answer), sizeof answer}, what);
        if (answer.rows == 0) {
            std::string text(std::min<std::size_t>(answer.bytes, 4096), ' ');
            receive(text, what);
            throw SamplerError(fmt::format("the plugin {} {} {}", library_, printable(text), what));
        }
        if (answer.rows != rows || answer.bytes != 0)
            throw SamplerError(fmt::format("the plugin {} answered {} rows with {} bytes of text {}: expected {} rows",
                library_, answer.rows, answer.bytes, what, rows));
        return block;
    }

private:
    std::string library_;
    PipeLimits limits_;
    SharedMemory memory_{PluginRows::bytes};
    Process process_;
    PluginInfo info_;

    void send(std::string_view bytes, const std::string& what) {
        for (Clock::time_point last = Clock::now(); !bytes.empty();) {
            const ssize_t n = process_.write(bytes);
            if (n > 0) {
                bytes.remove_prefix(static_cast<std::size_t>(n));
                last = Clock::now();
            } else if (n < 0 && errno != EAGAIN && errno != EINTR) throw_ended(what);
            else wait(true, last, what);
        }
    }
    void receive(std::span<char> to, const std::string& what) {
        for (Clock::time_point last = Clock::now(); !to.empty();) {
            const ssize_t n = process_.read(to.data(), to.size());
            if (n > 0) {
                to = to.subspan(static_cast<std::size_t>(n));
                last = Clock::now();
            } else if (n == 0) throw_ended(what);
            else wait(false, last, what);
        }
    }
    /// A handshake has a name and a few numbers: what is longer is none, and its rest would be taken for answers.
    std::string receive_line(const std::string& what) {
        constexpr std::size_t longest = 4096;
        std::string line;
        for (char c = 0; line.size() < longest; line += c) {
            receive({&c, 1}, what);
            if (c == '\n') return line;
        }
        throw OutputError(fmt::format(
            "cannot open the plugin {}: expected a handshake of one line of at most {} bytes, found '{}...'", library_,
            longest, printable(line, 60)));
    }
    void wait(bool is_write, Clock::time_point last, const std::string& what) {
        process_.wait_ready(is_write, !is_write, 50);
        if (limits_.stop && limits_.stop->load()) throw Interrupted{};
        if (std::chrono::duration<double>(Clock::now() - last).count() > limits_.call_seconds)
            throw SamplerError(
                fmt::format("the plugin {} was stopped after {:g} s {}: expected an answer in that time "
                            "(--timeout)",
                    library_, limits_.call_seconds, what));
    }
    [[noreturn]] void throw_ended(const std::string& what) {
        const std::optional<ProcessEnd> end = process_.ended(1000);
        throw SamplerError(end ? fmt::format("the plugin {} ended its process by {} {}", library_, end->text(), what)
                               : fmt::format("the plugin {} closed its pipe to crescent {}", library_, what));
    }

    void read_uses(std::string_view names) {
        if (!take_context_names(names, info_.uses))
            throw OutputError(
                fmt::format("cannot open the plugin {}: crescent_sampler_uses gives '{}': expected {}, each "
                            "once, separated by commas",
                    library_, printable(names, 200), fmt::join(context_names(), ", ")));
    }

    void read_handshake(std::string_view line) {
        const std::string expected = fmt::format("{}... name=NAME", plugin_handshake);
        const auto reject = [&](std::string_view answer) {
            throw OutputError(fmt::format("cannot open the plugin {}: {} answers '{}', expected '{}'", library_,
                printable(host_program()), printable(answer, 200), expected));
        };
        if (!line.starts_with(plugin_handshake)) reject(line);
        std::string_view remainder = line.substr(std::strlen(plugin_handshake));
        if (remainder.starts_with("error "))
            throw OutputError(fmt::format("cannot open the plugin {}: {}", library_, printable(remainder.substr(6))));
        while (!remainder.empty() && info_.name.empty()) {
            const std::size_t equals = std::min(remainder.find('='), remainder.size() - 1);
            const std::string_view key = remainder.substr(0, equals);
            remainder.remove_prefix(equals + 1);
            const std::string_view value = key == "name" ? remainder : remainder.substr(0, remainder.find(' '));
            remainder.remove_prefix(std::min(value.size() + 1, remainder.size()));
            if (key == "name") info_.name = printable(value);
            if (key == "numbers") std::from_chars(value.data(), value.data() + value.size(), info_.numbers);
            if (key == "pdf") info_.has_pdf = value == "1";
            if (key == "f") info_.has_f = value == "1";
            if (key == "serial") info_.is_serial = value == "1";
            if (key == "uses") read_uses(value);
        }
        if (info_.name.empty()) reject(line);
    }
};

class Plugin : public BatchSampler {
public:
    Plugin(const std::string& path, const PipeLimits& limits, const SurfaceParameters& surface)
        : path_(path), limits_(limits), surface_(surface) {
        free_hosts_.push_back(std::make_unique<Host>(path_, limits_));
        info_ = free_hosts_.front()->info();
    }

    SamplerDeclaration declaration() const override {
        return {.name = info_.name,
            .traits = {.numbers = info_.numbers, .has_pdf = info_.has_pdf},
            .has_f = info_.has_f,
            .has_drawn_f = info_.has_f,
            .serial = info_.is_serial,
            .limited = true,
            .uses = info_.uses};
    }
    QueryUsage spending() const override { return {answers_.load(std::memory_order_relaxed), 0, 0}; }

private:
    /// Calls work(scene, first row, rows) for parts of the rows that fit a request: at the points of a scene, or on the
    /// surface of a check, a run for each w_o.
    template <class Work> void in_requests(const SamplerQuery& query, const Work& work) const {
        if (query.scene) return work(*query.scene, std::size_t{0}, query.rows());
        std::vector<SurfaceRun> runs;
        std::vector<LightAtPoint> lights_at;
        const bool has_light = std::ranges::find(info_.uses, "lights") != info_.uses.end();
        for (std::size_t first = 0; first < query.rows(); first += plugin_rows) {
            const std::size_t rows = std::min<std::size_t>(plugin_rows, query.rows() - first);
            runs.clear();
            if (query.kind == SamplerQuery::Kind::sample) runs.push_back(on_surface(query.wo, rows));
            else
                for (const Pair& pair : query.pairs.subspan(first, rows)) {
                    if (runs.empty() || !same(runs.back().wo, pair.wo)) runs.push_back(on_surface(pair.wo, 0));
                    ++runs.back().rows;
                }
            SceneRows scene{.runs = runs};
            if (has_light) {
                lights_at.assign(runs.size(), example_.at);
                scene.lights = {&example_.light, 1};
                scene.lights_at = lights_at;
            }
            work(scene, first, rows);
        }
    }
    static bool same(Vec3d a, Vec3d b) { return a.x == b.x && a.y == b.y && a.z == b.z; }
    /// The surface of a check: a grey albedo.
    SurfaceRun on_surface(Vec3d wo, std::size_t rows) const {
        const double grey = surface_.diffuse;
        return {.wo = wo, .surface = surface_, .rows = rows, .rho_d = {grey, grey, grey}};
    }

    void draw_rows(const SamplerQuery& query, std::span<Draw> out) const override {
        const auto numbers = static_cast<std::size_t>(info_.numbers);
        std::vector<double> room;
        const std::span<const double> u = query.u.packed(numbers, room);
        in_requests(query, [&](const SceneRows& scene, std::size_t first, std::size_t rows) {
            const Call call{"crescent_sampler_sample", scene.runs.front().wo};
            on_host([&](Host& host) {
                const PluginRows block = host.query('s', scene, u.subspan(first * numbers, rows * numbers), rows, call);
                for (std::size_t i = 0; i < rows; ++i) {
                    const double* w = block.wi + 3 * i;
                    out[first + i] = Draw{{w[0], w[1], w[2]}, block.values[i]};
                }
            });
        });
        answers_.fetch_add(out.size(), std::memory_order_relaxed);
    }
    void pdf_rows(const SamplerQuery& query, std::span<double> out) const override {
        values('p', "crescent_sampler_pdf", query, out);
    }
    void f_rows(const SamplerQuery& query, std::span<double> out) const override {
        values('f', "crescent_sampler_f", query, out);
    }
    void values(char operation, const char* function, const SamplerQuery& query, std::span<double> out) const {
        std::vector<double> wi;
        in_requests(query, [&](const SceneRows& scene, std::size_t first, std::size_t rows) {
            wi.clear();
            for (const Pair& pair : query.pairs.subspan(first, rows))
                wi.insert(wi.end(), {pair.wi.x, pair.wi.y, pair.wi.z});
            on_host([&](Host& host) {
                const PluginRows block = host.query(operation, scene, wi, rows, {function, scene.runs.front().wo});
                std::copy_n(block.values, rows, out.subspan(first, rows).begin());
            });
        });
        answers_.fetch_add(out.size(), std::memory_order_relaxed);
    }

    /// Calls with a host that no other thread uses. After a failure neither the host nor the plugin is used again.
    template <class Work> void on_host(const Work& work) const {
        std::unique_lock<std::mutex> one_at_a_time(serial_, std::defer_lock);
        if (info_.is_serial) one_at_a_time.lock();
        std::unique_ptr<Host> host = take_host();
        try {
            if (!host) host = std::make_unique<Host>(path_, limits_);
            work(*host);
        } catch (const std::runtime_error& fault) {
            const std::lock_guard<std::mutex> guard(lock_);
            if (fault_.empty()) fault_ = fault.what();
            throw;
        }
        const std::lock_guard<std::mutex> guard(lock_);
        free_hosts_.push_back(std::move(host));
    }
    std::unique_ptr<Host> take_host() const {
        const std::lock_guard<std::mutex> guard(lock_);
        if (!fault_.empty()) throw SamplerExited("the plugin was given up: " + fault_);
        if (free_hosts_.empty()) return nullptr;
        std::unique_ptr<Host> host = std::move(free_hosts_.back());
        free_hosts_.pop_back();
        return host;
    }

    std::string path_;
    PipeLimits limits_;
    SurfaceParameters surface_;
    PluginInfo info_;
    ExampleLight example_ = example_light();
    mutable std::atomic<std::uint64_t> answers_{0};
    mutable std::mutex serial_, lock_;
    mutable std::vector<std::unique_ptr<Host>> free_hosts_;  // both guarded by lock_
    mutable std::string fault_;
};

static_assert(sizeof(SurfaceParameters) == 4 * sizeof(double));

}  // namespace

std::shared_ptr<const SamplerAdapter> open_plugin(
    const std::string& path, const PipeLimits& limits, const SurfaceParameters& surface) {
    return std::make_shared<Plugin>(path, limits, surface);
}

}  // namespace crescent
