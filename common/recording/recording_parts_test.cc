#include "common/recording/recording_parts.h"

#include <gtest/gtest.h>

#include <fstream>

#include "common/testing/temporary_directory.h"

namespace isotherm {
namespace {

TEST(RecordingPartsTest, PartsLieBesideTheFirst) {
  EXPECT_EQ(PartPath("a/scan.mcap", 1), "a/scan.mcap");
  EXPECT_EQ(PartPath("a/scan.mcap", 3), "a/scan-3.mcap");
}

TEST(RecordingPartsTest, ANameThatIsTakenIsPassedOver) {
  const testing::TemporaryDirectory folder;
  const std::filesystem::path path = folder.path() / "scan.mcap";
  EXPECT_EQ(NextFreePart(path, 0), 1);
  std::ofstream(folder.path() / "scan-2.mcap").put('x');
  EXPECT_EQ(NextFreePart(path, 1), 3);
}

TEST(RecordingPartsTest, OnlyAnErrorOfTheDiskEndsAFile) {
  EXPECT_FALSE(EndsFile(OkStatus()));
  EXPECT_FALSE(EndsFile(InvalidArgument("before the epoch")));
  EXPECT_FALSE(EndsFile(DataLoss("wrong size")));
  EXPECT_TRUE(EndsFile(IoError("input/output error")));
  EXPECT_TRUE(EndsFile(ResourceExhausted("no space left")));
}

TEST(RecordingPartsTest, AFileWithoutFramesIsRemovedADeviceIsNot) {
  const testing::TemporaryDirectory folder;
  const std::filesystem::path path = folder.path() / "scan.mcap";
  std::ofstream(path).put('x');
  EXPECT_FALSE(RemoveIfWithoutFrames(path, {.thermal_frames = 1}));
  EXPECT_FALSE(RemoveIfWithoutFrames(path, {.failed = 1, .unsynced = 1}));
  EXPECT_TRUE(std::filesystem::exists(path));
  EXPECT_TRUE(RemoveIfWithoutFrames(path, {}));
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_TRUE(IsDevice("/dev/null"));
  EXPECT_FALSE(RemoveIfWithoutFrames("/dev/null", {}));
}

}  // namespace
}  // namespace isotherm
