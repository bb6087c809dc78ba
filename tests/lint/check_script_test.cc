// deploy/check.sh: which files it looks at.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "common/testing/temporary_directory.h"
#include "tests/support/process.h"

namespace isotherm::lint {
namespace {

constexpr system_test::Seconds kPatience{60};

/// A repository with the script and a history of its own.
class CheckScriptTest : public ::testing::Test {
 protected:
  CheckScriptTest() {
    std::filesystem::create_directories(root() / "deploy");
    std::filesystem::copy_file(ISOTHERM_SOURCE_DIR "/deploy/check.sh", root() / "deploy/check.sh");
    Run("git init --quiet && git config user.name test && git config user.email test@test");
  }
  std::filesystem::path root() const { return folder_.path(); }
  std::string Run(const std::string& script) const {
    const system_test::Finished finished = system_test::RunToEnd(
        {"/bin/bash", {"-c", "cd '" + root().string() + "' && " + script}, {}}, kPatience);
    EXPECT_EQ(finished.status, 0) << script << "\n" << finished.output;
    return finished.output;
  }
  void Commit(const std::string& file, const std::string& text) const {
    std::ofstream(root() / file) << text << "\n";
    Run("git add . && git commit --quiet -m " + file);
  }
  /// A version, two changes after it, and one that is not committed.
  void MakeHistory() const {
    Commit("before.cc", "0");
    Commit("CMakeLists.txt", "project(isotherm VERSION 0.2.0 LANGUAGES C CXX)");
    Commit("first.cc", "1");
    Commit("CMakeLists.txt",
           "project(isotherm VERSION 0.2.0 LANGUAGES C CXX)\nadd_subdirectory(a)");
    Commit("second.h", "2");
    std::ofstream(root() / "uncommitted.cc") << "3\n";
  }
  std::string List() const { return Run("bash deploy/check.sh --list"); }

  const testing::TemporaryDirectory folder_;
};

TEST_F(CheckScriptTest, WithoutATagItIsWhatChangedSinceTheVersionWasSetTheNewestFirst) {
  MakeHistory();
  EXPECT_EQ(List(), "uncommitted.cc\nsecond.h\nfirst.cc\n");
}

TEST_F(CheckScriptTest, ATagCountsMore) {
  MakeHistory();
  Run("git tag v0.3 HEAD~1");
  EXPECT_EQ(List(), "uncommitted.cc\nsecond.h\n");
}

TEST_F(CheckScriptTest, OfAHistoryThatIsCutOffItIsAll) {
  MakeHistory();
  Run("git clone --quiet --depth 1 file://$PWD cut && rm -rf cut/deploy && cp -r deploy cut");
  EXPECT_EQ(Run("cd cut && bash deploy/check.sh --list"), "before.cc\nfirst.cc\nsecond.h\n");
}

}  // namespace
}  // namespace isotherm::lint
