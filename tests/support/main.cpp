// The main function of the test programs. CRESCENT_TEST_FOLDER=src/check/explain runs only the tests of the files in
// that folder, without its subfolders.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
    if (const char* folder = std::getenv("CRESCENT_TEST_FOLDER"); folder && GTEST_FLAG_GET(filter) == "*")
        GTEST_FLAG_SET(filter, tests_of(folder));
    return RUN_ALL_TESTS();
}
