#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <filesystem>

#include "common/recording/recording.h"
#include "common/recording/testing/recording_data.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using testing::kScanStart;
using testing::MakeDepth;
using testing::ReadAll;
using testing::WriterTo;

class RecordingFileTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern =
        (std::filesystem::temp_directory_path() / "recording_test_XXXXXX").string();
    ASSERT_NE(::mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_;
};

TEST_F(RecordingFileTest, CreatesFoldersAndRefusesToOverwrite) {
  const auto path = folder_ / "a" / "b" / "scan.mcap";
  {
    auto writer = RecordingWriter::Create(path, {});
    ASSERT_TRUE(writer) << writer.error().message();
    ASSERT_TRUE((*writer)->Write(MakeDepth(0, kScanStart), std::nullopt).ok());
  }
  const auto reader = RecordingReader::Open(path);
  ASSERT_TRUE(reader) << reader.error().message();
  EXPECT_EQ(ReadAll(**reader).items.size(), 1U);
  const auto again = RecordingWriter::Create(path, {});
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().code(), StatusCode::kInvalidArgument);
  EXPECT_THAT(again.error().message(), HasSubstr(path.string()));
}

TEST_F(RecordingFileTest, MissingFilesAndFoldersAreNamed) {
  const auto missing = RecordingReader::Open(folder_ / "none.mcap");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code(), StatusCode::kNotFound);
  EXPECT_THAT(missing.error().message(), HasSubstr("none.mcap"));
  EXPECT_FALSE(RecordingReader::Open(folder_));
}

TEST_F(RecordingFileTest, APipeIsRefusedAtOnceAndNamed) {
  const auto pipe = folder_ / "pipe.mcap";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const auto reader = RecordingReader::Open(pipe);  // Nobody will ever write to it.
  ASSERT_FALSE(reader);
  EXPECT_EQ(reader.error().code(), StatusCode::kInvalidArgument);
  EXPECT_THAT(reader.error().message(), HasSubstr("pipe.mcap is a folder, a pipe or a device"));
}

TEST_F(RecordingFileTest, FullDiskIsReportedAtOnceOnTheFirstWrite) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  const auto writer = RecordingWriter::Create("/dev/full", {});
  ASSERT_FALSE(writer);
  EXPECT_EQ(writer.error().code(), StatusCode::kResourceExhausted);
  EXPECT_THAT(writer.error().message(), HasSubstr("/dev/full"));
}

TEST(RecordingOptionsTest, ImpossibleOptionsAreRefused) {
  const auto disk = std::make_shared<MemorySink::Disk>();
  EXPECT_EQ(WriterTo(disk, {.flush_interval = 1001ms}), nullptr);
  EXPECT_EQ(WriterTo(disk, {.flush_interval = 0ms}), nullptr);
  EXPECT_EQ(WriterTo(disk, {.chunk_bytes = 100}), nullptr);
  EXPECT_NE(WriterTo(disk, {.flush_interval = 1000ms}), nullptr);
}

}  // namespace
}  // namespace isotherm
