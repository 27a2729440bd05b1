// The list of verdicts equals those of a result, in its order, and those of the manual.
#include <fstream>
#include <gtest/gtest.h>

#include "check/check.h"
#include "check/sources/cases.h"
#include "check/verdict.h"

namespace crescent {
namespace verdict_list_test {

TEST(VerdictList, IsWhatEveryCaseIsGivenInThisOrder) {
    TestSettings few;
    few.wo = {{45, 0}};
    ProgressMonitor monitor;
    const CheckResult j = run_checks(make_cases("uniform", {}, false, few.wo), few, monitor);
    ASSERT_EQ(j.verdicts.size() % verdict_names.size(), 0u);
    for (std::size_t i = 0; i < j.verdicts.size(); ++i)
        EXPECT_EQ(j.verdicts[i].name, verdict_names[i % verdict_names.size()]);
}

/// Every row is for a verdict of the list, in its order; `crescent list verdicts` also has those without a row.
TEST(VerdictList, ManualListsVerdictsInOrder) {
    std::ifstream manual(std::string(CRESCENT_SOURCE_DIR) + "/docs/check.md");
    std::vector<std::string> rows;
    bool in_table = false;
    for (std::string line; std::getline(manual, line);) {
        if (line.starts_with("| verdict | question |")) in_table = true;
        else if (in_table && !line.starts_with('|')) break;
        else if (in_table && !line.starts_with("|---")) rows.push_back(line);
    }
    ASSERT_FALSE(rows.empty());
    auto row = rows.begin();
    for (std::size_t k = 0; k < verdict_names.size(); ++k) {
        const std::string begins =
            "| " + std::string(verdict_names[k]) + " | " + std::string(verdict_questions[k]) + " |";
        if (row != rows.end() && row->starts_with(begins)) ++row;
    }
    EXPECT_EQ(row, rows.end()) << "no verdict of the list comes here with this question: " << *row;
}

}  // namespace verdict_list_test
}  // namespace crescent
