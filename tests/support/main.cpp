// The main function of the test programs. CRESCENT_TEST_FOLDER=src/check/explain runs only the tests of the files in
// that folder, without its subfolders; empty, it is not set.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <string>

namespace {

bool is_in_folder(const testing::TestInfo& test, const std::string& folder) {
    const std::string file = test.file() ? test.file() : "";
    const std::size_t slash = file.rfind('/');
    return slash != std::string::npos && file.substr(0, slash).ends_with("/" + folder);
}

/// Returns a filter of GoogleTest: the suites and tests of the folder by name.
std::string tests_of(const std::string& folder) {
    std::string filter;
    const testing::UnitTest& program = *testing::UnitTest::GetInstance();
    for (int s = 0; s < program.total_test_suite_count(); ++s) {
        const testing::TestSuite& suite = *program.GetTestSuite(s);
        for (int t = 0; t < suite.total_test_count(); ++t) {
            const testing::TestInfo& test = *suite.GetTestInfo(t);
            if (is_in_folder(test, folder)) filter += std::string(suite.name()) + "." + test.name() + ":";
        }
    }
    return filter;
}

}  // namespace

int main(int argc, char** argv) {
    testing::InitGoogleMock(&argc, argv);
    const char* folder = std::getenv("CRESCENT_TEST_FOLDER");
    if (folder && *folder && GTEST_FLAG_GET(filter) == "*") {
        const std::string filter = tests_of(folder);
        if (filter.empty()) {
            std::fprintf(
                stderr, "CRESCENT_TEST_FOLDER=%s: no test is in this folder; expected src/math or another\n", folder);
            return 2;
        }
        GTEST_FLAG_SET(filter, filter);
    }
    return RUN_ALL_TESTS();
}
