// The hash of a film in pieces, for who may not take the time of all of it at once.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>

namespace crescent::inline films {

/// What hash() of film.h says of planes whose bytes are added in their order.
class FilmHash {
public:
    FilmHash();
    void add(std::span<const std::byte> bytes);
    std::string text() const;

private:
    std::shared_ptr<void> state_;
};

}  // namespace crescent::inline films
