// An item is the length of its body and the XXH3-64 of length and body, each of 8 bytes, and the body. Numbers are
// stored as the bytes of this machine, so that a double keeps every bit; the build is part of the key.
#include "run/checkpoint_items.h"

#include <cstring>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace crescent {

namespace {

constexpr std::size_t head_bytes = 2 * sizeof(std::uint64_t);

/// Appends values to a body.
class Writer {
public:
    template <class T> void operator()(const T& value) {
        body_.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    void operator()(const std::string& text) {
        (*this)(std::uint64_t{text.size()});
        body_ += text;
    }
    std::string item() const {
        const std::uint64_t size = body_.size();
        std::string item(reinterpret_cast<const char*>(&size), sizeof size);
        const std::uint64_t sum = XXH3_64bits_withSeed(body_.data(), body_.size(), size);
        item.append(reinterpret_cast<const char*>(&sum), sizeof sum);
        return item + body_;
    }

private:
    std::string body_;
};

/// Takes values from a body; after its end every value is invalid.
class Reader {
public:
    explicit Reader(std::string_view body) : remainder_(body) {}

    template <class T> void operator()(T& value) {
        is_valid = is_valid && remainder_.size() >= sizeof value;
        if (!is_valid) return;
        std::memcpy(&value, remainder_.data(), sizeof value);
        remainder_.remove_prefix(sizeof value);
    }
    void operator()(std::string& text) {
        std::uint64_t size = 0;
        (*this)(size);
        is_valid = is_valid && size <= remainder_.size();
        if (!is_valid) return;
        text = remainder_.substr(0, size);
        remainder_.remove_prefix(size);
    }
    bool complete() const { return is_valid && remainder_.empty(); }

    bool is_valid = true;

private:
    std::string_view remainder_;
};

#define CRESCENT_FIELD(name, Type) io(values.name);
template <class Stream, class Region> void transfer_region(Stream& io, Region& values) {
    io(values.region);
    io(values.pixels);
    io(values.flip);
    io(values.mse);
    io(values.mse_error);
    io(values.reference_error);
    CRESCENT_REGION_METRICS(CRESCENT_FIELD)
}

template <class Stream, class Run> void transfer(Stream& io, Run& values) {
    io(values.key.arm);
    io(values.key.n);
    io(values.key.s);
    io(values.key.seed);
    for (auto& region : values.regions) transfer_region(io, region);
    CRESCENT_FRAME_METRICS(CRESCENT_FIELD)
}
#undef CRESCENT_FIELD

/// Takes the body of the first item of `bytes`; empty if the item is incomplete or damaged.
std::optional<std::string_view> take_body(std::string_view& bytes) {
    std::uint64_t head[2];
    if (bytes.size() < head_bytes) return {};
    std::memcpy(head, bytes.data(), head_bytes);
    if (head[0] > bytes.size() - head_bytes) return {};
    const std::string_view body = bytes.substr(head_bytes, head[0]);
    if (XXH3_64bits_withSeed(body.data(), body.size(), head[0]) != head[1]) return {};
    bytes.remove_prefix(head_bytes + body.size());
    return body;
}

/// Appends the metrics of a body; returns false if it is not made of metrics of these regions.
bool add_metrics(std::string_view body, const Experiment& experiment, std::vector<RunMetrics>& out) {
    Reader in(body);
    while (in.is_valid && !in.complete()) {
        RunMetrics run;
        run.regions.resize(experiment.regions.size());
        transfer(in, run);
        for (std::size_t i = 0; i < run.regions.size(); ++i)
            in.is_valid = in.is_valid && run.regions[i].region == experiment.regions[i].name;
        if (in.is_valid) out.push_back(std::move(run));
    }
    return in.is_valid;
}

}  // namespace

std::string key_item(std::string_view key) {
    Writer out;
    out(std::string(key));
    return out.item();
}

std::string metrics_item(const std::vector<RunMetrics>& metrics) {
    Writer out;
    for (const RunMetrics& run : metrics) transfer(out, run);
    return out.item();
}

CheckpointContent read_items(std::string_view bytes, std::string_view key, const Experiment& experiment) {
    CheckpointContent out;
    const std::string first = key_item(key);
    if (!bytes.starts_with(first)) return out;
    out.has_key = true;
    out.bytes = first.size();
    std::string_view remainder = bytes.substr(first.size());
    while (const std::optional<std::string_view> body = take_body(remainder)) {
        const std::size_t count = out.metrics.size();
        if (!add_metrics(*body, experiment, out.metrics)) {
            out.metrics.resize(count);
            break;
        }
        out.bytes = bytes.size() - remainder.size();
    }
    return out;
}

}  // namespace crescent
