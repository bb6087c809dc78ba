#include "common/base/partial_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <optional>
#include <sstream>
#include <utility>

#include "common/testing/temporary_directory.h"

namespace isotherm {
namespace {

using ::testing::HasSubstr;

class PartialFileTest : public ::testing::Test {
 protected:
  static void Make(const std::filesystem::path& path, std::string_view text) {
    std::ofstream(path) << text;
  }
  std::string Target() const {
    std::ostringstream text;
    text << std::ifstream(target_).rdbuf();
    return text.str();
  }
  std::ptrdiff_t FilesInFolder() const {
    return std::distance(std::filesystem::directory_iterator(folder_.path()), {});
  }

  const testing::TemporaryDirectory folder_;
  const std::filesystem::path target_ = folder_.path() / "scan.mcap";
};

TEST_F(PartialFileTest, TheFileGetsItsNameWhenItIsComplete) {
  const Result<PartialFile> file = PartialFile::Create(target_, false);
  ASSERT_TRUE(file.has_value());
  EXPECT_FALSE(std::filesystem::exists(file->path())) << "the writer makes it";
  Make(file->path(), "scan");
  EXPECT_FALSE(std::filesystem::exists(target_));
  ASSERT_TRUE(file->Commit().ok());
  EXPECT_EQ(Target(), "scan");
  EXPECT_EQ(FilesInFolder(), 1);
}

TEST_F(PartialFileTest, WhatIsUnfinishedIsRemovedAndTheOldFileStays) {
  Make(target_, "old");
  {
    const Result<PartialFile> file = PartialFile::Create(target_, true);
    ASSERT_TRUE(file.has_value());
    Make(file->path(), "half");
    EXPECT_EQ(FilesInFolder(), 2);
  }
  EXPECT_EQ(Target(), "old");
  EXPECT_EQ(FilesInFolder(), 1);
}

TEST_F(PartialFileTest, WhoWasMovedFromRemovesNothing) {
  std::optional<Result<PartialFile>> created = PartialFile::Create(target_, false);
  ASSERT_TRUE(created->has_value());
  const PartialFile file = std::move(**created);
  Make(file.path(), "scan");
  created.reset();
  ASSERT_TRUE(file.Commit().ok());
  EXPECT_EQ(Target(), "scan");
}

TEST_F(PartialFileTest, AFileIsReplacedOnlyIfThatWasSaid) {
  Make(target_, "old");
  const Result<PartialFile> refused = PartialFile::Create(target_, false);
  ASSERT_FALSE(refused.has_value());
  EXPECT_THAT(refused.error().message(), HasSubstr("--force replaces it"));
  const Result<PartialFile> file = PartialFile::Create(target_, true);
  ASSERT_TRUE(file.has_value());
  Make(file->path(), "new");
  ASSERT_TRUE(file->Commit().ok());
  EXPECT_EQ(Target(), "new");
}

TEST_F(PartialFileTest, WhatIsNoFileIsRefusedAlsoIfItMayBeReplaced) {
  for (const char* path : {"/dev/null", "/", ""}) {
    EXPECT_FALSE(PartialFile::Create(path, true).has_value()) << path;
  }
  EXPECT_FALSE(PartialFile::Create(folder_.path(), true).has_value());
  EXPECT_FALSE(PartialFile::Create(folder_.path() / "", true).has_value());
}

TEST_F(PartialFileTest, AFileThatNobodyWroteCannotBeCommitted) {
  const Result<PartialFile> file = PartialFile::Create(target_, false);
  ASSERT_TRUE(file.has_value());
  EXPECT_THAT(file->Commit().message(), HasSubstr("scan.mcap"));
}

}  // namespace
}  // namespace isotherm
