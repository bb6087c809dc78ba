#include "common/base/output_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "common/testing/temporary_directory.h"

namespace isotherm {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class OutputFileTest : public ::testing::Test {
 protected:
  static void Make(const std::filesystem::path& path, std::string_view text) {
    std::ofstream(path) << text;
  }
  static std::string ReadAll(const std::filesystem::path& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
  }
  bool HasPartial() const { return std::filesystem::exists(partial_); }

  const testing::TemporaryDirectory folder_;
  const std::filesystem::path path_ = folder_.path() / "cloud.ply";
  const std::filesystem::path partial_ = folder_.path() / "cloud.ply.partial";
};

TEST_F(OutputFileTest, TheNewContentAppearsAsAWhole) {
  Make(path_, "old");
  OutputFile file(path_);
  file.Write("first, ");
  file.Write("second");
  EXPECT_EQ(ReadAll(path_), "old") << "as long as it is not complete";
  ASSERT_TRUE(file.Commit().ok());
  EXPECT_EQ(ReadAll(path_), "first, second");
  EXPECT_FALSE(HasPartial());
}

TEST_F(OutputFileTest, WithoutCommitTheOldFileStaysAndNothingIsLeft) {
  Make(path_, "old");
  {
    OutputFile file(path_);
    file.Write("half");
    EXPECT_TRUE(HasPartial());
  }
  EXPECT_EQ(ReadAll(path_), "old");
  EXPECT_FALSE(HasPartial());
}

TEST_F(OutputFileTest, WhatAnInterruptedRunLeftIsReplaced) {
  Make(partial_, "of the run before, which was longer");
  ASSERT_TRUE(WriteFile(path_, "new").ok());
  EXPECT_EQ(ReadAll(path_), "new");
}

TEST_F(OutputFileTest, F65ALinkOfThePartialNameIsNotFollowed) {
  const std::filesystem::path victim = folder_.path() / "victim";
  Make(victim, "precious");
  std::filesystem::create_symlink(victim, partial_);
  const Status status = WriteFile(path_, "new");
  EXPECT_THAT(status.message(), AllOf(HasSubstr("cloud.ply"), HasSubstr("remove it")));
  EXPECT_EQ(ReadAll(victim), "precious");
  EXPECT_FALSE(std::filesystem::exists(path_));
}

TEST_F(OutputFileTest, AFolderThatIsNotThereIsSaidWithWhatToDo) {
  const std::filesystem::path path = folder_.path() / "no" / "cloud.ply";
  OutputFile file(path);
  file.Write("goes nowhere");
  const Status status = file.Commit();
  EXPECT_EQ(status.code(), StatusCode::kIoError);
  EXPECT_THAT(status.message(), AllOf(HasSubstr(path.string()), HasSubstr("choose a folder")));
}

TEST_F(OutputFileTest, AFolderInTheFilesPlaceIsAnErrorAndLeavesNoPartialFile) {
  std::filesystem::create_directory(path_);
  EXPECT_THAT(WriteFile(path_, "new").message(), HasSubstr("cloud.ply"));
  EXPECT_FALSE(HasPartial());
}

}  // namespace
}  // namespace isotherm
