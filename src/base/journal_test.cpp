// Journals: complete records are read back after a kill or disk errors in the rest.
#include "base/journal.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace crescent::inline base {
namespace {

namespace fs = std::filesystem;
using Texts = std::vector<std::string>;

struct Listener : ProgressMonitor {
    int message = 0;
    void log(std::string_view) override { ++message; }
};

class Journals : public testing::Test {
protected:
    mutable Listener monitor_;
    fs::path folder_ = fs::path(testing::TempDir()) / ("journals-" + std::to_string(::getpid()));
    std::string path_ = folder_ / "deep" / "one";
    void SetUp() override { fs::remove_all(folder_); }
    void TearDown() override { fs::remove_all(folder_); }

    Texts read(Journal& journal) const {
        Texts out;
        journal.read(
            [&](Journal::Bytes bytes) { out.emplace_back(reinterpret_cast<const char*>(bytes.data()), bytes.size()); });
        return out;
    }
    Texts read(const std::string& key = "work") const {
        Journal journal(path_, key, monitor_);
        return read(journal);
    }
    static void append(Journal& journal, const Texts& parts) {
        std::vector<Journal::Bytes> bytes;
        for (const std::string& part : parts) bytes.push_back(std::as_bytes(std::span(part)));
        journal.append(bytes);
    }
    void write(const std::vector<Texts>& records) const {
        Journal journal(path_, "work", monitor_);
        for (const Texts& record : records) append(journal, record);
    }
};

TEST_F(Journals, GiveRecordsBackInOrder) {
    EXPECT_TRUE(read().empty());
    EXPECT_FALSE(fs::exists(folder_)) << "reading makes nothing";
    write({{"first"}, {"sec", "", "ond"}, {""}});
    EXPECT_EQ(read(), (Texts{"first", "second", ""}));
}

TEST_F(Journals, TornRecordIsDroppedAndWritingContinues) {
    write({{"one"}, {"two"}, {"three"}});
    std::ifstream whole(path_, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(whole), {}};
    const Texts all = {"one", "two", "three"};
    for (std::size_t length = 0; length < bytes.size(); ++length) {
        std::ofstream(path_, std::ios::binary | std::ios::trunc) << bytes.substr(0, length);
        Journal journal(path_, "work", monitor_);
        Texts kept = read(journal);
        ASSERT_LT(kept.size(), all.size()) << length;
        EXPECT_TRUE(std::equal(kept.begin(), kept.end(), all.begin())) << length;
        append(journal, {"new"});
        kept.push_back("new");
        Journal elsewhere = std::move(journal);  // releases the file at the end of this iteration
        EXPECT_TRUE(read().empty()) << "another reader, while the file is in use";
        fs::copy_file(path_, path_ + "-copy", fs::copy_options::overwrite_existing);
        Journal copy(path_ + "-copy", "work", monitor_);
        EXPECT_EQ(read(copy), kept) << length;
    }
}

TEST_F(Journals, EndBeforeAWrongByte) {
    write({{"one"}, {"two"}, {"three"}});
    std::fstream file(path_, std::ios::in | std::ios::out | std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    file.seekp(static_cast<std::streamoff>(bytes.find("two")));
    file.put('x');
    file.close();
    EXPECT_EQ(read(), Texts{"one"});
}

TEST_F(Journals, OfOtherWorkAreIgnored) {
    write({{"one"}});
    EXPECT_TRUE(read("other work").empty());
}

TEST_F(Journals, RejectRecordsOfOtherWork) {
    write({{"one"}});
    {
        Journal other(path_ + "-other", "work", monitor_);
        append(other, {"two"});
        Journal stranger(path_ + "-stranger", "strange work", monitor_);
        append(stranger, {"theirs"});
    }
    const auto add_bytes_of = [&](const std::string& from) {
        std::ifstream in(from, std::ios::binary);
        std::ofstream(path_, std::ios::binary | std::ios::app) << in.rdbuf();
    };
    add_bytes_of(path_ + "-stranger");
    EXPECT_EQ(read(), Texts{"one"});
    add_bytes_of(path_ + "-other");
    EXPECT_EQ(read(), (Texts{"one", "work", "two"}))
        << "of the same work, and whole: the reader must know it from its own";
}

TEST_F(Journals, DoNotFollowALink) {
    fs::create_directories(folder_ / "deep");
    std::ofstream(folder_ / "victim") << "victim";
    fs::create_symlink(folder_ / "victim", path_);
    write({{"one"}});
    std::ifstream victim(folder_ / "victim");
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(victim), {}), "victim");
    EXPECT_EQ(monitor_.message, 1);
}

TEST_F(Journals, ReportThatTheyCannotBeWritten) {
    fs::create_directories(folder_);
    std::ofstream(folder_ / "deep") << "a file where the folder should be";
    write({{"one"}, {"two"}});
    EXPECT_EQ(monitor_.message, 1) << "once, and the work goes on";
}

}  // namespace
}  // namespace crescent::inline base
