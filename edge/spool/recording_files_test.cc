#include "edge/spool/recording_files.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "common/testing/temporary_directory.h"
#include "edge/spool/recording_name.h"

namespace isotherm {
namespace {

const CaptureTime kNow{std::chrono::seconds(1'700'000'000)};

TEST(RecordingPathTest, OffMeansNoFile) { EXPECT_EQ(RecordingPath("off", kNow, 1), std::nullopt); }

TEST(RecordingPathTest, AFileIsTakenAsGiven) {
  EXPECT_EQ(RecordingPath("a/b.mcap", kNow, 1), "a/b.mcap");
}

TEST(RecordingPathTest, F40SessionsOfOneSecondGetFilesOfTheirOwn) {
  std::set<std::filesystem::path> names;
  for (std::uint64_t session = 0; session < 1000; ++session)
    names.insert(*RecordingPath("scans/", kNow, session));
  EXPECT_EQ(names.size(), 1000U);
  EXPECT_EQ(names.begin()->string().substr(0, 27), "scans/edge-20231114-221320-");
  EXPECT_EQ(RecordingPath("/tmp", kNow, 1)->parent_path(), "/tmp");
}

class RecordingFilesTest : public ::testing::Test {
 protected:
  RecordingDescription Description() const {
    return {path_, std::chrono::milliseconds(500), std::nullopt, {{"software", {{"name", "x"}}}}};
  }

  const ::isotherm::testing::TemporaryDirectory folder_;
  const std::filesystem::path path_ = folder_.path() / "scan.mcap";
};

TEST_F(RecordingFilesTest, EachFileHasTheWholeBeginning) {
  RecordingFiles files(Description());
  for (const char* name : {"scan.mcap", "scan-2.mcap", "scan-3.mcap"}) {
    Result<RecordingFile> file = files.Next();
    ASSERT_TRUE(file.has_value());
    EXPECT_EQ(file->path.filename(), name);
    ASSERT_TRUE(file->writer->Close().ok());
    const auto reader = RecordingReader::Open(file->path);
    ASSERT_TRUE(reader.has_value());
    EXPECT_EQ((*reader)->info().metadata.at("software").at("name"), "x");
  }
}

TEST_F(RecordingFilesTest, ACameraThatCameLateIsInTheFilesThatFollow) {
  RecordingFiles files(Description());
  ASSERT_TRUE(files.Next().has_value());
  RigUpdate update;
  update.rig.emplace().thermal =
      CameraModel{.width = 382, .height = 288, .fx = 500.0, .fy = 500.0, .cx = 190.5, .cy = 143.5};
  update.rig->thermal_scale = {0.02, 0.0};
  update.cameras = {{"thermal", "optris-sdk"}};
  files.Update(update);
  Result<RecordingFile> file = files.Next();
  ASSERT_TRUE(file.has_value());
  ASSERT_TRUE(file->writer->Close().ok());
  const auto reader = RecordingReader::Open(file->path);
  ASSERT_TRUE(reader.has_value());
  const Result<Rig> rig = (*reader)->ReadRig();
  ASSERT_TRUE(rig.has_value()) << rig.error().message();
  EXPECT_EQ(rig->thermal_scale, update.rig->thermal_scale);
  EXPECT_EQ((*reader)->info().metadata.at("cameras"), update.cameras);
}

TEST_F(RecordingFilesTest, F37AFileThatExistsStaysAsItIs) {
  std::ofstream(path_) << "precious";
  RecordingFiles files(Description());
  const Result<RecordingFile> file = files.Next();
  ASSERT_TRUE(file.has_value());
  EXPECT_EQ(file->path.filename(), "scan-2.mcap");
  std::string text;
  std::ifstream(path_) >> text;
  EXPECT_EQ(text, "precious");
}

TEST_F(RecordingFilesTest, ADeviceIsWrittenToAsItIs) {
  RecordingFiles files({"/dev/null", std::chrono::milliseconds(500), std::nullopt, {}});
  for (int i = 0; i < 2; ++i) {
    const Result<RecordingFile> file = files.Next();
    ASSERT_TRUE(file.has_value());
    EXPECT_EQ(file->path, "/dev/null");
  }
}

TEST_F(RecordingFilesTest, F41OnAFullDiskNoEmptyFileIsLeft) {
  // /dev/full takes the place of a full disk; it is a device and must itself survive.
  RecordingFiles files({"/dev/full", std::chrono::milliseconds(500), std::nullopt, {}});
  const Result<RecordingFile> file = files.Next();
  ASSERT_FALSE(file.has_value());
  EXPECT_EQ(file.error().code(), StatusCode::kResourceExhausted);
  EXPECT_TRUE(std::filesystem::exists("/dev/full"));
}

}  // namespace
}  // namespace isotherm
