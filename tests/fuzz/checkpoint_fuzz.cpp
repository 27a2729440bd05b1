// Any bytes as a checkpoint: its metrics are those of the experiment's regions, and what is read is written again as
// the same bytes. The checksum of each item is made right first, since no mutation would guess it.
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/errors.h"
#include "run/checkpoint_items.h"

namespace {

using namespace crescent;

constexpr std::size_t head_bytes = 16;

/// Sets the length of each item that is longer than what follows, and every checksum.
void make_right(std::string& bytes, std::size_t from) {
    while (bytes.size() - from > head_bytes) {
        std::uint64_t size = 0;
        std::memcpy(&size, &bytes[from], sizeof size);
        size = std::min<std::uint64_t>(size, bytes.size() - from - head_bytes);
        const std::uint64_t sum = XXH3_64bits_withSeed(&bytes[from] + head_bytes, size, size);
        std::memcpy(&bytes[from], &size, sizeof size);
        std::memcpy(&bytes[from] + sizeof size, &sum, sizeof sum);
        from += head_bytes + size;
    }
}

Experiment with_two_regions() {
    Experiment experiment;
    experiment.regions = {{"H", {0, 0, 1, 1}, {}}, {"S", {0, 0, 1, 1}, {}}};
    return experiment;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const Experiment experiment = with_two_regions();
    static const std::string key = key_item("key");
    const std::string raw(reinterpret_cast<const char*>(data), size);
    (void)read_items(raw, "key", experiment);
    std::string bytes = key + raw;
    make_right(bytes, key.size());
    const CheckpointContent content = read_items(bytes, "key", experiment);
    ensure(content.has_key && content.bytes >= key.size() && content.bytes <= bytes.size(), "a part of the bytes");
    for (const RunMetrics& run : content.metrics)
        ensure(run.regions.size() == 2 && run.regions[1].region == "S", "the regions of the experiment");
    const std::string again = key + metrics_item(content.metrics);
    const CheckpointContent same = read_items(again, "key", experiment);
    ensure(same.metrics.size() == content.metrics.size() && same.bytes == again.size(), "what is written is read");
    ensure(key + metrics_item(same.metrics) == again, "every bit is kept");
    return 0;
}
