// Replaces Boost's mutex if there are no threads; found before its own.
#pragma once

namespace boost::detail {

struct lightweight_mutex {
    struct scoped_lock {
        explicit scoped_lock(lightweight_mutex&) {}
    };
};

}  // namespace boost::detail
