// A cache of values by number, in the order of first use: whoever asks again asks mostly in that order.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace crescent::inline reference {

template <class V> class Replay {
public:
    Replay() { asked_.reserve(64), values_.reserve(64); }
    /// The value for x, until the next call: make(), where it was not asked for before the last rewind.
    template <class Make> const V& operator()(double x, Make&& make) {
        const auto last = asked_.begin() + static_cast<std::ptrdiff_t>(known_);
        auto at = std::find(asked_.begin() + static_cast<std::ptrdiff_t>(next_), last, x);
        if (at == last) at = std::find(asked_.begin(), last, x);
        if (at == last) {
            asked_.push_back(x), values_.push_back(make());
            return values_.back();
        }
        next_ = static_cast<std::size_t>(at - asked_.begin()) + 1;
        return values_[next_ - 1];
    }
    void rewind() { next_ = 0, known_ = asked_.size(); }

private:
    std::vector<double> asked_;
    std::vector<V> values_;
    std::size_t next_ = 0, known_ = 0;  // asked for before the last rewind; where the search begins
};

}  // namespace crescent::inline reference
