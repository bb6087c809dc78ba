// tests/skips.sh: continuous integration fails when something is skipped that tests/skips.txt does
// not list.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "common/testing/temporary_directory.h"
#include "tests/support/process.h"

namespace isotherm::lint {
namespace {

using system_test::Finished;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kPassed = " 10/200 Test #100: some_test .............   Passed    0.01 sec\n";

class SkipsTest : public ::testing::Test {
 protected:
  Finished Check(const std::string& printed, const std::string& details,
                 const std::string& preset = "release") const {
    const std::filesystem::path printed_file = folder_.path() / "ctest.log";
    const std::filesystem::path details_file = folder_.path() / "LastTest.log";
    std::ofstream(printed_file) << printed;
    std::ofstream(details_file) << details;
    return system_test::RunToEnd({"/bin/bash",
                                  {ISOTHERM_SOURCE_DIR "/tests/skips.sh", preset,
                                   printed_file.string(), details_file.string()},
                                  {}},
                                 system_test::Seconds(60));
  }

  const testing::TemporaryDirectory folder_;
};

TEST_F(SkipsTest, NothingSkippedIsFine) {
  EXPECT_EQ(Check(kPassed, "[       OK ] A.B\n").status, 0);
}

TEST_F(SkipsTest, AListedCaseIsNamedAndFine) {
  const Finished checked =
      Check(kPassed, "[  SKIPPED ] AccuracyTest.RealKinectRoom (0 ms)\n[  SKIPPED ] 1 test\n");
  EXPECT_EQ(checked.status, 0) << checked.output;
  EXPECT_THAT(checked.output, HasSubstr("AccuracyTest.RealKinectRoom\n"));
}

TEST_F(SkipsTest, ACaseThatIsNotListedFails) {
  const Finished checked = Check(kPassed, "[  SKIPPED ] New/SomeTest.Case/3 (0 ms)\n");
  EXPECT_EQ(checked.status, 1) << checked.output;
  EXPECT_THAT(checked.output, Not(HasSubstr("4 ms")));
}

TEST_F(SkipsTest, ATestThatEndsWithStatus77Fails) {
  const Finished checked =
      Check(std::string(kPassed) +
                "  3/200 Test  #17: mcap_interoperability_test .......***Skipped   0.01 sec\n",
            "");
  EXPECT_EQ(checked.status, 1) << checked.output;
  EXPECT_THAT(checked.output, HasSubstr("mcap_interoperability_test"));
}

TEST_F(SkipsTest, WhatIsListedForOnePresetIsForThatOnly) {
  const std::string skipped =
      "[  SKIPPED ] RecordingMemoryTest.WhatIsMeasuredIsWhatIsUsedInBetween (0 ms)\n";
  EXPECT_EQ(Check(kPassed, skipped, "asan").status, 0);
  EXPECT_EQ(Check(kPassed, skipped, "release").status, 1);
}

}  // namespace
}  // namespace isotherm::lint
