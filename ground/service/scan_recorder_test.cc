// A recording of the ground on a disk that fails and works again.
#include "ground/service/scan_recorder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <set>

#include "common/recording/testing/recording_data.h"
#include "common/testing/temporary_directory.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::kScanStart;
using ::testing::Not;

constexpr Nanoseconds kLongerThanAnyBackOff = 6s;
constexpr Nanoseconds kFrameInterval = 33ms;

/// A disk in memory on which each file has the room that the test gives it.
class ScanRecorderTest : public ::testing::Test {
 protected:
  static RigDescription MakeRig() {
    RigDescription rig;
    rig.rig = testing::MakeRig();
    return rig;
  }
  Result<std::unique_ptr<RecordingWriter>> CreateFile(const std::filesystem::path& path) {
    ++tries_;
    if (!disk_works_) return Err(IoError("read-only file system"));
    if (path.parent_path() == folder_.path()) std::ofstream(path).put('x');
    const auto disk = std::make_shared<MemorySink::Disk>();
    disk->capacity = room_;
    auto writer = MakeRecordingWriter(std::make_unique<MemorySink>(disk), kSmallChunks);
    if (writer) disks_[path.string()] = disk;
    return writer;
  }
  void Depth() {
    auto frame = std::make_shared<EncodedDepthFrame>(
        testing::MakeDepth(number_, kScanStart + static_cast<int>(number_) * kFrameInterval));
    ++number_;
    clock_.Advance(kFrameInterval);
    recorder_.Write(ReceivedDepth{nullptr, std::move(frame), clock_.Now()});
  }
  void Depths(int count) {
    for (int i = 0; i < count; ++i) Depth();
  }
  std::unique_ptr<RecordingReader> Read(const std::string& path) const {
    return testing::ReaderOf(disks_.at(path)->bytes).value();
  }
  /// The numbers of the frames that can be read from all files together.
  std::multiset<std::uint64_t> NumbersRead() const {
    std::multiset<std::uint64_t> numbers;
    for (const std::filesystem::path& file : recorder_.files()) {
      const auto reader = Read(file.string());
      for (const auto& depth : testing::ReadAll(*reader).All<RecordedDepth>())
        numbers.insert(depth.frame.header.frame_number);
    }
    return numbers;
  }
  /// A clock whose steps are said to be older than time itself.
  static SessionClock WrongClock() {
    SessionClock clock;
    clock.time = CaptureTimeFromNanoseconds(1);
    clock.rig.step_sum_s = 2.0;
    return clock;
  }
  RecorderCounts counts() const { return recorder_.counts(Sensor::kDepth); }

  static constexpr RecordingOptions kSmallChunks{.flush_interval = 60ms};
  const Status nearly_full_ = ResourceExhausted("the rest is for the results");
  FakeClock clock_{kScanStart};
  const RigDescription rig_ = MakeRig();
  std::size_t room_ = std::numeric_limits<std::size_t>::max();
  bool disk_works_ = true;
  int tries_ = 0;
  std::uint64_t number_ = 0;
  std::map<std::string, std::shared_ptr<MemorySink::Disk>> disks_;
  const testing::TemporaryDirectory folder_;
  // Files of this name are not on the real disk, so no name is ever taken there.
  ScanRecorder recorder_{"not-there/scan.mcap", GroundOptions(), rig_, clock_,
                         [this](const std::filesystem::path& path) { return CreateFile(path); }};
};

TEST_F(ScanRecorderTest, F43AfterAFullDiskASecondFileIsBegunAndBothHaveAllButTheCountedLoss) {
  room_ = 12'000;
  while (recorder_.status().ok()) Depth();
  EXPECT_EQ(recorder_.status().code(), StatusCode::kResourceExhausted);
  EXPECT_FALSE(recorder_.is_recording());
  Depths(3);  // Nobody tries again for each frame.
  EXPECT_EQ(tries_, 1);
  room_ = std::numeric_limits<std::size_t>::max();
  clock_.Advance(kLongerThanAnyBackOff);
  const std::uint64_t first_again = number_;
  Depths(5);
  EXPECT_EQ(recorder_.Close().code(), StatusCode::kResourceExhausted) << "it is not complete";

  EXPECT_THAT(recorder_.files(), ElementsAre("not-there/scan.mcap", "not-there/scan-2.mcap"));
  const std::multiset<std::uint64_t> read = NumbersRead();
  EXPECT_EQ(counts().offered, number_);
  EXPECT_EQ(counts().recorded, read.size());
  EXPECT_EQ(counts().lost, number_ - read.size());
  EXPECT_GT(read.count(0), 0U) << "what was good before is kept";
  for (std::uint64_t i = 0; i < number_; ++i) EXPECT_LE(read.count(i), 1U);
  for (std::uint64_t i = first_again; i < number_; ++i) EXPECT_EQ(read.count(i), 1U) << i;
}

TEST_F(ScanRecorderTest, EachFileHasTheRigTheOptionsAndTheClock) {
  SessionClock clock;
  clock.time = kScanStart;
  clock.rig.synchronised = true;
  clock.rig.steps = 1;
  clock.rig.step_sum_s = 2.0;
  recorder_.Tend();
  recorder_.Write(clock);
  Depths(2);
  recorder_.EndFile(nearly_full_);
  Depths(2);
  EXPECT_EQ(recorder_.Close().message(), nearly_full_.message());
  EXPECT_TRUE(recorder_.disk_error().ok()) << "its end was in order";
  ASSERT_EQ(recorder_.files().size(), 2U);
  for (const std::filesystem::path& file : recorder_.files()) {
    const auto reader = Read(file.string());
    EXPECT_TRUE(reader->info().complete) << file;
    const Result<Rig> rig = reader->ReadRig();
    ASSERT_TRUE(rig.has_value()) << file << rig.error().message();
    EXPECT_EQ(rig->serial, rig_.rig.serial) << file;
    EXPECT_EQ(reader->info().metadata.at("configuration").at("program"), "isotherm-ground");
    EXPECT_EQ(reader->info().metadata.at("clock").at("steps"), "1");
    const auto steps = testing::ReadAll(*reader).All<ClockStep>();
    ASSERT_EQ(steps.size(), 1U) << file;
    EXPECT_EQ(steps[0].wall_minus_time, 2s);
  }
}

TEST_F(ScanRecorderTest, ACameraThatComesLateIsInTheFileAndInThoseThatFollow) {
  Depths(2);
  RigDescription rig = rig_;
  rig.rig.thermal_scale = {0.02, 0.0};
  rig.thermal.model = "optris-sdk, Xi 400";
  rig.thermal.serial = "T1";
  recorder_.Write(rig);
  Depths(2);
  recorder_.EndFile(nearly_full_);
  Depths(2);
  static_cast<void>(recorder_.Close());
  ASSERT_EQ(recorder_.files().size(), 2U);
  for (const std::filesystem::path& file : recorder_.files()) {
    const auto reader = Read(file.string());
    const Result<Rig> read = reader->ReadRig();
    ASSERT_TRUE(read.has_value()) << file << read.error().message();
    EXPECT_EQ(read->thermal_scale, rig.rig.thermal_scale) << file;
    EXPECT_EQ(reader->info().metadata.at("cameras").at("thermal_serial"), "T1") << file;
  }
}

TEST_F(ScanRecorderTest, F43ADiskThatStaysBrokenIsTriedWithABackOffAndLeavesNoFile) {
  disk_works_ = false;
  const SteadyTime begin = clock_.SteadyNow();
  while (clock_.SteadyNow() - begin < 60s) Depth();
  // Half a second, 1, 2, 4, 5, 5, ...
  EXPECT_GE(tries_, 13);
  EXPECT_LE(tries_, 16);
  EXPECT_EQ(counts().lost, number_);
  EXPECT_THAT(recorder_.files(), IsEmpty());
  disk_works_ = true;
  clock_.Advance(kLongerThanAnyBackOff);
  Depth();
  EXPECT_TRUE(recorder_.is_recording());
  EXPECT_EQ(counts().recorded, 1U);
}

TEST_F(ScanRecorderTest, F43OneFailureIsOneProblemUntilTheDiskHasProvenItself) {
  room_ = 12'000;
  while (recorder_.status().ok()) Depth();
  room_ = std::numeric_limits<std::size_t>::max();
  clock_.Advance(kLongerThanAnyBackOff);
  ::testing::internal::CaptureStderr();
  Depth();
  EXPECT_TRUE(recorder_.is_recording());
  EXPECT_THAT(::testing::internal::GetCapturedStderr(), Not(HasSubstr("works again")))
      << "it may fail again at once";
  clock_.Advance(3s);
  ::testing::internal::CaptureStderr();
  Depth();
  EXPECT_THAT(::testing::internal::GetCapturedStderr(), HasSubstr("the disk works again"));
  EXPECT_FALSE(recorder_.status().ok()) << "the recording is not complete all the same";
}

TEST_F(ScanRecorderTest, AFrameThatIsWrongIsNotTheDisksFault) {
  Depth();
  auto wrong = std::make_shared<EncodedDepthFrame>(
      testing::MakeDepth(99, CaptureTimeFromNanoseconds(-1)));  // Before the epoch.
  recorder_.Write(ReceivedDepth{nullptr, std::move(wrong), clock_.Now()});
  Depth();
  EXPECT_EQ(counts().unwritable, 1U);
  EXPECT_EQ(counts().lost, 0U);
  EXPECT_TRUE(recorder_.disk_error().ok());
  EXPECT_EQ(recorder_.Close().code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(recorder_.files().size(), 1U);
  EXPECT_THAT(NumbersRead(), ElementsAre(0, 1));
}

TEST_F(ScanRecorderTest, AClockThatIsWrongAtAFilesBeginningIsNotTheDisksFault) {
  Depth();
  recorder_.Write(WrongClock());
  recorder_.EndFile(nearly_full_);
  Depths(2);
  EXPECT_TRUE(recorder_.is_recording());
  EXPECT_EQ(tries_, 2);
  EXPECT_EQ(counts().lost, 0U);
  EXPECT_TRUE(recorder_.disk_error().ok()) << recorder_.disk_error().message();
  static_cast<void>(recorder_.Close());
  EXPECT_THAT(NumbersRead(), ElementsAre(0, 1, 2));
}

TEST_F(ScanRecorderTest, F43ABeginningThatFailsOnTheDiskLeavesNoFile) {
  ScanRecorder recorder(folder_.path() / "scan.mcap", GroundOptions(), rig_, clock_,
                        [this](const std::filesystem::path& path) { return CreateFile(path); });
  recorder.Write(WrongClock());
  room_ = 500;  // The file can be created, and no more.
  recorder.Tend();
  EXPECT_EQ(tries_, 1);
  EXPECT_FALSE(recorder.is_recording());
  EXPECT_EQ(recorder.disk_error().code(), StatusCode::kResourceExhausted);
  EXPECT_THAT(recorder.files(), IsEmpty());
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(ScanRecorderTest, TheNewestFailureIsTold) {
  room_ = 12'000;
  while (recorder_.status().ok()) Depth();
  const std::string first = recorder_.status().message();
  disk_works_ = false;
  clock_.Advance(kLongerThanAnyBackOff);
  Depth();
  EXPECT_THAT(recorder_.status().message(), AllOf(HasSubstr("read-only"), Not(HasSubstr(first))));
  recorder_.EndFile(nearly_full_);
  EXPECT_EQ(recorder_.status().message(), nearly_full_.message());
  EXPECT_THAT(recorder_.disk_error().message(), HasSubstr("read-only"));
  clock_.Advance(kLongerThanAnyBackOff);
  Depth();
  EXPECT_THAT(recorder_.status().message(), HasSubstr("read-only"));
}

}  // namespace
}  // namespace isotherm
