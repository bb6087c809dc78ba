// What came late is in the recording and in the results in the end, as if it had come in time.

#include "ground/service/scan_completion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>
#include <variant>

#include "common/dataset/import.h"
#include "common/recording/recording.h"
#include "common/testing/temporary_directory.h"
#include "ground/offline/reconstruct.h"

namespace isotherm {
namespace {

using ::testing::HasSubstr;

class ScanCompletionTest : public ::testing::Test {
 protected:
  ScanCompletionTest() {
    options_.mutable_volume()->set_voxel_size_m(0.004);
    ImportRequest import;
    import.dataset.folder = ISOTHERM_SOURCE_DIR "/tests/data/furnace_excerpt";
    import.recording = whole_;
    EXPECT_TRUE(ImportDataset(import));
    std::filesystem::create_directories(scan_);
  }
  /// Writes those frames of the whole recording that `is_wanted` says into `file`, and counts them.
  /// Returns how many.
  std::uint64_t Write(const std::filesystem::path& file,
                      const std::function<bool(std::uint64_t depth_frame)>& is_wanted) {
    const auto reader = RecordingReader::Open(whole_).value();
    const auto writer = RecordingWriter::Create(file, {}).value();
    EXPECT_TRUE(writer->Write(reader->ReadRig().value()).ok());
    std::uint64_t depth_frames = 0, written = 0;
    while (const auto item = reader->Next().value()) {
      const auto* depth = std::get_if<RecordedDepth>(&*item);
      const auto* thermal = std::get_if<RecordedThermal>(&*item);
      if (depth != nullptr) ++depth_frames;
      if ((depth == nullptr && thermal == nullptr) || !is_wanted(depth_frames)) continue;
      const Status status = depth != nullptr ? writer->Write(depth->frame, depth->arrival)
                                             : writer->Write(thermal->frame, thermal->arrival);
      EXPECT_TRUE(status.ok()) << status.message();
      ++written;
      ++(depth != nullptr ? recording_.depth_frames : recording_.thermal_frames);
    }
    EXPECT_TRUE(writer->Close().ok());
    return written;
  }
  /// The scan's recording lacks an outage's frames, which came late.
  void Record(std::uint64_t outage_begin, std::uint64_t outage_end) {
    const auto in_outage = [=](std::uint64_t number) {
      return number > outage_begin && number <= outage_end;
    };
    recording_.path = scan_ / "scan.mcap";
    recording_.files = {recording_.path};
    recording_.late_files = {scan_ / "scan-late.mcap"};
    recording_.depth_frames = recording_.thermal_frames = 0;
    Write(recording_.path, [&](auto number) { return !in_outage(number); });
    recording_.late_frames = Write(recording_.late_files.front(), in_outage);
    recording_.closed = true;
  }
  Result<std::string> Complete() {
    return CompleteScan({.options = options_,
                         .folder = scan_,
                         .recording = recording_,
                         .describe = [](Json& stats) { stats["link"]["depth"]["late"] = 7; },
                         .go_on =
                             [this] {
                               ++steps_;
                               if (stops_behind_merging_ && !std::filesystem::exists(Late()))
                                 stop_.request_stop();
                             },
                         .stop = stop_.get_token()});
  }
  static std::string Content(const std::filesystem::path& file) {
    std::ostringstream content;
    content << std::ifstream(file).rdbuf();
    return content.str();
  }

  std::filesystem::path Late() const { return recording_.late_files.front(); }

  const testing::TemporaryDirectory folder_;
  const std::filesystem::path whole_ = folder_.path() / "whole.mcap";
  const std::filesystem::path scan_ = folder_.path() / "scan";
  GroundOptions options_;
  RecordingProgress recording_;
  std::stop_source stop_;
  bool stops_behind_merging_ = false;
  int steps_ = 0;
};

TEST_F(ScanCompletionTest, ResultsAreThoseOfAScanWithoutOutage) {
  Record(15, 30);
  ASSERT_TRUE(NeedsCompletion(options_, recording_));
  const Result<std::string> told = Complete();
  ASSERT_TRUE(told) << told.error().message();
  EXPECT_THAT(*told, HasSubstr("these results have them"));
  EXPECT_GT(steps_, 10) << "somebody watches whether it gets on";

  ReconstructRequest reference;
  reference.recording = whole_;
  reference.output_dir = folder_.path() / "reference";
  reference.options = options_;
  ASSERT_TRUE(Reconstruct(reference));
  for (const char* file : {"model.iso", "trajectory.txt", "mesh.ply"}) {
    const std::string content = Content(scan_ / file);
    EXPECT_FALSE(content.empty()) << file;
    EXPECT_TRUE(content == Content(reference.output_dir / file)) << file;
  }
  EXPECT_EQ(Json::parse(Content(scan_ / "stats.json"))["link"]["depth"]["late"], 7);
  EXPECT_FALSE(std::filesystem::exists(recording_.late_files.front()));

  // The control: without what came late the results are others.
  std::filesystem::remove_all(scan_);
  std::filesystem::create_directories(scan_);
  Record(15, 30);
  reference.recording = recording_.path;
  ASSERT_TRUE(Reconstruct(reference));
  EXPECT_FALSE(Content(folder_.path() / "reference/model.iso").empty());
  reference.recording = whole_;
  reference.output_dir = folder_.path() / "again";
  ASSERT_TRUE(Reconstruct(reference));
  EXPECT_FALSE(Content(folder_.path() / "reference/model.iso") ==
               Content(folder_.path() / "again/model.iso"));
}

TEST_F(ScanCompletionTest, AFewFramesAreOnlyRecorded) {
  Record(15, 15);
  recording_.late_frames = 0;
  EXPECT_FALSE(NeedsCompletion(options_, recording_)) << "nothing came late";
  std::filesystem::remove_all(scan_);
  std::filesystem::create_directories(scan_);
  Record(40, 41);
  recording_.late_frames = 1;  // Of more than a hundred.
  const Result<std::string> told = Complete();
  ASSERT_TRUE(told) << told.error().message();
  EXPECT_THAT(*told, HasSubstr("do without"));
  EXPECT_FALSE(std::filesystem::exists(scan_ / "model.iso"));
  EXPECT_FALSE(std::filesystem::exists(recording_.late_files.front()));
}

TEST_F(ScanCompletionTest, WhenItIsToldToStopBothFilesStayAsTheyWere) {
  Record(15, 30);
  const std::string before = Content(recording_.path),
                    late = Content(recording_.late_files.front());
  stop_.request_stop();
  EXPECT_FALSE(Complete());
  EXPECT_TRUE(Content(recording_.path) == before);
  EXPECT_TRUE(Content(recording_.late_files.front()) == late);
}

TEST_F(ScanCompletionTest, WhenItIsToldToStopLaterTheRecordingIsWholeAndTheResultsAreAsTheyWere) {
  Record(15, 30);
  std::ofstream(scan_ / "stats.json") << "of the live model";
  stops_behind_merging_ = true;
  const Result<std::string> told = Complete();
  ASSERT_FALSE(told);
  EXPECT_THAT(told.error().message(), HasSubstr("is complete, the results are not made anew"));
  EXPECT_FALSE(std::filesystem::exists(Late()));
  EXPECT_EQ(Content(scan_ / "stats.json"), "of the live model");
  const auto reader = RecordingReader::Open(recording_.path).value();
  EXPECT_EQ(reader->info().messages_by_topic.at("/depth") +
                reader->info().messages_by_topic.at("/thermal"),
            recording_.depth_frames + recording_.thermal_frames);
}

TEST_F(ScanCompletionTest, AFileOfWhichNotAllCanBeReadIsNotReplaced) {
  Record(15, 30);
  ++recording_.depth_frames;  // The recorder counted one more.
  const std::string before = Content(recording_.path);
  const Result<std::string> told = Complete();
  ASSERT_FALSE(told);
  EXPECT_THAT(told.error().message(), HasSubstr("can be read back"));
  EXPECT_TRUE(Content(recording_.path) == before);
  EXPECT_TRUE(std::filesystem::exists(Late()));
}

TEST_F(ScanCompletionTest, AFileThatIsGoneIsSaidAndTheOtherStays) {
  Record(15, 30);
  std::filesystem::remove(recording_.late_files.front());
  const std::string before = Content(recording_.path);
  const Result<std::string> told = Complete();
  ASSERT_FALSE(told);
  EXPECT_THAT(told.error().message(), HasSubstr("scan-late.mcap"));
  EXPECT_TRUE(Content(recording_.path) == before);
}

TEST_F(ScanCompletionTest, ItCanBeTurnedOff) {
  Record(15, 30);
  options_.mutable_live()->mutable_expert()->set_complete(false);
  EXPECT_FALSE(NeedsCompletion(options_, recording_));
}

}  // namespace
}  // namespace isotherm
