#include "edge/spool/older_recordings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <string>

#include "common/testing/temporary_directory.h"

namespace isotherm {
namespace {

using ::testing::ElementsAre;

/// A folder with recordings, as old as they are asked to be.
class OlderRecordingsTest : public ::testing::Test {
 protected:
  void Put(const std::string& name, std::size_t bytes, int age_h) const {
    std::ofstream(Path(name)) << std::string(bytes, 'x');
    std::filesystem::last_write_time(
        Path(name), std::filesystem::file_time_type::clock::now() - std::chrono::hours(age_h));
  }
  std::filesystem::path Path(const std::string& name) const { return folder_.path() / name; }
  std::optional<DeletedRecording> Delete() const {
    return DeleteOldestFetched(folder_.path(), Path(present_));
  }
  std::set<std::string> Files() const {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
      names.insert(entry.path().filename());
    return names;
  }

  const testing::TemporaryDirectory folder_;
  const std::string present_ = "edge-20260103-000000-00000003.mcap";
  const std::string old_ = "edge-20260101-000000-00000001.mcap";
  const std::string old_2_ = "edge-20260101-000000-00000001-2.mcap";
  const std::string newer_ = "edge-20260102-000000-00000002.mcap";
};

TEST_F(OlderRecordingsTest, TheOldestThatWasFetchedGoesFirstAndNothingElse) {
  Put(present_, 100, 0);
  Put(old_, 30, 9);
  Put(newer_, 20, 5);
  Put("notes.mcap", 7, 99);
  EXPECT_EQ(RecordingsSize(folder_.path()), 150U) << "what an edge has written";
  EXPECT_FALSE(Delete()) << "nothing was fetched";
  EXPECT_EQ(FetchedSize(folder_.path(), Path(present_)), 0U);
  for (const std::string& name : {present_, old_, newer_})
    EXPECT_TRUE(MarkFetched(Path(name), std::filesystem::file_size(Path(name))).ok());
  EXPECT_EQ(FetchedSize(folder_.path(), Path(present_)), 50U);
  std::optional<DeletedRecording> deleted = Delete();
  ASSERT_TRUE(deleted);
  EXPECT_EQ(deleted->name, old_);
  EXPECT_EQ(deleted->bytes, 30U);
  deleted = Delete();
  ASSERT_TRUE(deleted);
  EXPECT_EQ(deleted->name, newer_);
  EXPECT_FALSE(Delete()) << "the present one stays";
  EXPECT_THAT(Files(), ElementsAre(present_, present_ + ".fetched", "notes.mcap"));
}

TEST_F(OlderRecordingsTest, ARecordingOfTwoFilesGoesOnlyIfBothWereFetched) {
  Put(old_, 30, 9);
  Put(old_2_, 10, 8);
  EXPECT_TRUE(MarkFetched(Path(old_), 30).ok());
  EXPECT_FALSE(Delete());
  EXPECT_TRUE(MarkFetched(Path(old_2_), 10).ok());
  EXPECT_EQ(Delete().value_or(DeletedRecording()).bytes, 40U);
  EXPECT_TRUE(Files().empty());
}

TEST_F(OlderRecordingsTest, AFileThatHasChangedSinceWasNotFetched) {
  Put(old_, 30, 9);
  EXPECT_EQ(MarkFetched(Path(old_), 31).code(), StatusCode::kNotFound) << "not the whole of it";
  EXPECT_FALSE(IsFetched(Path(old_)));
  EXPECT_TRUE(MarkFetched(Path(old_), 30).ok());
  EXPECT_TRUE(IsFetched(Path(old_)));
  std::ofstream(Path(old_), std::ios::app) << "index";
  EXPECT_FALSE(IsFetched(Path(old_)));
  EXPECT_FALSE(Delete());
}

TEST_F(OlderRecordingsTest, AMarkThatIsDamagedIsNone) {
  Put(old_, 30, 9);
  for (const char* const text : {"", "x", "-30", "0"}) {
    std::ofstream(Path(old_ + ".fetched")) << text;
    EXPECT_FALSE(IsFetched(Path(old_))) << text;
  }
}

TEST_F(OlderRecordingsTest, FilesGoOneByOneTheOldestFirstAndThePresentRecordingLast) {
  const std::string present_2 = "edge-20260103-000000-00000003-2.mcap";
  const std::string present_10 = "edge-20260103-000000-00000003-10.mcap";
  // Its clock was wrong when it began.
  Put(present_2, 100, 999);
  Put(present_10, 100, 1000);
  Put(old_, 30, 9);
  Put(old_2_, 30, 8);
  Put(newer_, 20, 5);
  ASSERT_TRUE(MarkFetched(Path(newer_), 20).ok());
  Put("notes.mcap", 7, 99);
  std::vector<std::string> deleted;
  for (int i = 0; i < 6; ++i) {
    const auto file = DeleteOldestFile(folder_.path(), Path(present_));
    if (!file) continue;
    deleted.push_back(file->path.filename().string());
    EXPECT_EQ(file->is_of_present, i >= 3) << file->path;
    EXPECT_EQ(file->was_fetched, file->path == Path(newer_));
  }
  EXPECT_THAT(deleted, ElementsAre(old_, old_2_, newer_, present_2, present_10));
  EXPECT_THAT(Files(), ElementsAre("notes.mcap"));
}

}  // namespace
}  // namespace isotherm
