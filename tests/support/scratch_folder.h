// A folder that is removed after the test.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "base/errors.h"

namespace crescent {

class ScratchFolder : public ::testing::Test {
protected:
    ScratchFolder()
        : folder_(
              std::filesystem::temp_directory_path() / fmt::format("crescent-compare-{}-{}", ::getpid(), count_++)) {
        std::filesystem::create_directories(folder_);
    }
    ~ScratchFolder() override { std::filesystem::remove_all(folder_); }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    std::string write(const std::string& name, const std::string& bytes) const {
        std::ofstream(path(name), std::ios::binary) << bytes;
        return path(name);
    }
    static std::string bytes_of(const std::string& file) {
        std::ifstream in(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    }
    /// Returns the message of an InputError; "" if there is none.
    template <class Work> static std::string refusal(const Work& work) {
        try {
            (void)work();
        } catch (const InputError& error) { return error.what(); }
        return "";
    }

private:
    std::filesystem::path folder_;
    static inline int count_ = 0;
};

}  // namespace crescent
