#include "edge/spool/interrupted_scan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "common/recording/recording.h"
#include "common/recording/recording_parts.h"
#include "common/testing/temporary_directory.h"
#include "edge/spool/recorded_frame_reader.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using ::testing::AllOf;
using ::testing::Ge;
using ::testing::Le;

constexpr CaptureTime kScanStart{1'700'000'000s};
constexpr std::uint64_t kSession = 1'699'999'999'123'456'789;
constexpr Nanoseconds kDepthPeriod = 33ms;
constexpr Nanoseconds kThermalPeriod = 25ms;

EncodedImage SmallImage() {
  return {.encoding = Encoding::kRaw16, .width = 2, .height = 1, .payload = {1, 2, 3, 4}};
}

/// Holds what a file has of each stream, by Sensor.
using Numbers = std::array<std::set<std::uint64_t>, 2>;

/// A folder with recordings of which the processes were killed, or not.
class InterruptedScanTest : public ::testing::Test {
 protected:
  /// Holds what is written into a file.
  struct Content {
    std::string edge_id = "rig7";
    std::uint64_t session = kSession;
    Nanoseconds begin{0};         ///< After kScanStart.
    Nanoseconds depth_begins{0};  ///< No frames of this camera before that.
    Nanoseconds depth_ends{};     ///< No frames of this camera after that; 0: to the end.
    std::array<std::uint64_t, 2> first_numbers{};
    std::uint64_t left_out = 0;  ///< Every depth number that is divisible by it; 0: none.
  };

  RecordingFile Begin(const std::filesystem::path& path, const Content& content) {
    RecordingFiles files({path,
                          500ms,
                          std::nullopt,
                          {{std::string(kScanMetadata),
                            ToMetadata({content.edge_id, content.session,
                                        kScanStart + content.begin, content.first_numbers})}}});
    return files.Next().value();
  }

  /// Writes `length` of frames. Returns what the file has.
  static Numbers Write(RecordingWriter& writer, const Content& content, Nanoseconds length) {
    Numbers numbers;
    auto [depth, thermal] = content.first_numbers;
    for (Nanoseconds time{0}; time < length; time += 1ms) {
      const CaptureTime now = kScanStart + content.begin + time;
      const bool has_depth = time >= content.depth_begins &&
                             (content.depth_ends == Nanoseconds(0) || time < content.depth_ends);
      if (time % kDepthPeriod == 0ns && has_depth) {
        const std::uint64_t number = depth++;
        if (content.left_out == 0 || number % content.left_out != 0) {
          EncodedDepthFrame frame;
          frame.header = {.session = content.session, .frame_number = number, .capture_time = now};
          frame.depth_scale = 1000.0;
          frame.image = SmallImage();
          EXPECT_TRUE(writer.Write(frame, std::nullopt).ok());
          numbers[0].insert(number);
        }
      }
      if (time % kThermalPeriod == 0ns) {
        EncodedThermalFrame frame;
        frame.header = {.session = content.session, .frame_number = thermal, .capture_time = now};
        frame.image = SmallImage();
        EXPECT_TRUE(writer.Write(frame, std::nullopt).ok());
        numbers[1].insert(thermal++);
      }
    }
    return numbers;
  }

  /// Leaves a file as a process that is killed leaves it: with all that was flushed, and no lock.
  Numbers Kill(const std::string& name, const Content& content, Nanoseconds length) {
    const std::filesystem::path elsewhere = elsewhere_.path() / name;
    Numbers numbers;
    {
      const RecordingFile file = Begin(elsewhere, content);
      numbers = Write(*file.writer, content, length);
      EXPECT_TRUE(file.writer->Flush().ok());
      std::filesystem::copy_file(file.path, folder_.path() / name);
    }
    SetWritten(name, content.begin + length);
    std::filesystem::remove(elsewhere);
    return numbers;
  }
  void SetWritten(const std::string& name, Nanoseconds after_start) const {
    const std::chrono::sys_time<Nanoseconds> time((kScanStart + after_start).time_since_epoch());
    std::filesystem::last_write_time(folder_.path() / name,
                                     std::chrono::file_clock::from_sys(time));
  }
  void Complete(const std::string& name, const Content& content, Nanoseconds length) {
    const RecordingFile file = Begin(folder_.path() / name, content);
    Write(*file.writer, content, length);
    EXPECT_TRUE(file.writer->Close().ok());
    SetWritten(name, content.begin + length);
  }
  std::optional<InterruptedScan> Find(Nanoseconds after_start) const {
    return FindInterruptedScan(folder_.path() / "scan.mcap", "rig7", kScanStart + after_start, 60s);
  }

  /// Each frame lies behind the beginning of its run, in its file, and no run has frames that come
  /// before it.
  static void ExpectThatRunsLeadTo(const Numbers& numbers, const InterruptedScan& scan,
                                   const std::filesystem::path& file) {
    for (const Sensor sensor : {Sensor::kDepth, Sensor::kThermal}) {
      const Nanoseconds period = sensor == Sensor::kDepth ? kDepthPeriod : kThermalPeriod;
      for (const std::uint64_t number : numbers[static_cast<std::size_t>(sensor)]) {
        const auto run = std::ranges::find_if(scan.runs, [&](const RecordedRun& candidate) {
          return candidate.sensor == sensor && candidate.frames.first <= number &&
                 number <= candidate.frames.last;
        });
        ASSERT_NE(run, scan.runs.end()) << number;
        EXPECT_EQ(run->file, file);
        EXPECT_LE((number - run->frames.first) * period, 10s + 2 * period) << "far to read";
      }
    }
  }

  const testing::TemporaryDirectory folder_;
  const testing::TemporaryDirectory elsewhere_;
};

TEST_F(InterruptedScanTest, KnowsWhatAKilledProcessHasRecorded) {
  const Numbers numbers = Kill("scan.mcap", {.left_out = 10}, 35s);
  const std::optional<InterruptedScan> scan = Find(37s);
  ASSERT_TRUE(scan);
  EXPECT_EQ(scan->last.session, kSession);
  EXPECT_EQ(scan->path, folder_.path() / "scan.mcap");
  EXPECT_EQ(scan->parts, 1);
  for (const Sensor sensor : {Sensor::kDepth, Sensor::kThermal}) {
    const auto& of = numbers[static_cast<std::size_t>(sensor)];
    EXPECT_EQ(scan->Of(sensor).frames, of.size());
    EXPECT_EQ(scan->Of(sensor).next, *of.rbegin() + 1);
  }
  EXPECT_NEAR(scan->Of(Sensor::kDepth).rate_hz, 1.0 / ToSeconds(kDepthPeriod), 0.5);
  EXPECT_NEAR(scan->Of(Sensor::kThermal).rate_hz, 1.0 / ToSeconds(kThermalPeriod), 0.5);
  EXPECT_EQ(scan->newest, kScanStart + 34'975ms);
  ExpectThatRunsLeadTo(numbers, *scan, folder_.path() / "scan.mcap");
}

TEST_F(InterruptedScanTest, NumbersGoOnAboveAllThatMayHaveBeenPublishedAndNoFasterThanTheCamera) {
  Kill("scan.mcap", {}, 20s);
  const std::optional<InterruptedScan> scan = Find(30s);
  ASSERT_TRUE(scan);
  const std::uint64_t captured_by_now = 40 * 30;
  const std::uint64_t number = scan->NextNumber(Sensor::kThermal, kScanStart + 30s);
  EXPECT_THAT(number, AllOf(Ge(captured_by_now), Le(captured_by_now + 20)));
  InterruptedScan still = *scan;
  still.streams = {};
  EXPECT_GE(still.NextNumber(Sensor::kDepth, kScanStart + 30s), 30 * 10)
      << "a rate that nobody knows";
}

TEST_F(InterruptedScanTest, AScanWhoseRecordingIsClosedIsOver) {
  Kill("scan.mcap", {}, 5s);
  ASSERT_TRUE(Find(8s));
  Complete("scan-2.mcap", {.begin = 6s, .first_numbers = {500, 500}}, 1s);
  EXPECT_FALSE(Find(8s)) << "it went on, and ended";
}

TEST_F(InterruptedScanTest, AScanThatAProcessStillRecordsGoesOnThere) {
  RecordingFile file = Begin(folder_.path() / "scan.mcap", {});
  Write(*file.writer, {}, 5s);
  ASSERT_TRUE(file.writer->Flush().ok());
  EXPECT_FALSE(Find(6s));
}

TEST_F(InterruptedScanTest, AnotherRigsScanAndOneThatIsTooOldAreNotGoneOnWith) {
  Kill("scan.mcap", {}, 5s);
  EXPECT_TRUE(Find(60s));
  EXPECT_FALSE(Find(66s)) << "too old";
  EXPECT_FALSE(Find(1s)) << "the clock was set back: nobody knows how old";
  const std::filesystem::path path = folder_.path() / "scan.mcap";
  EXPECT_FALSE(FindInterruptedScan(path, "rig8", kScanStart + 6s, 60s));
  EXPECT_FALSE(FindInterruptedScan(path, "rig7", kScanStart + 6s, 0s));
  EXPECT_FALSE(FindInterruptedScan("off", "rig7", kScanStart + 6s, 60s));
  EXPECT_FALSE(FindInterruptedScan("/dev/null", "rig7", kScanStart + 6s, 60s));
  EXPECT_FALSE(FindInterruptedScan(folder_.path() / "not" / "there/", "rig7", kScanStart, 60s));
}

TEST_F(InterruptedScanTest, AllFilesOfTheScanAreKnownAndNoneOfAnotherOne) {
  Kill("scan.mcap", {.session = kSession - 1}, 2s);
  const Numbers first = Kill("scan-2.mcap", {.begin = 3s}, 12s);
  // Two frames were sent and not recorded before the first process ended.
  const Numbers second = Kill("scan-4.mcap", {.begin = 16s, .first_numbers = {366, 482}}, 3s);
  const std::optional<InterruptedScan> scan = Find(20s);
  ASSERT_TRUE(scan);
  EXPECT_EQ(scan->path, folder_.path() / "scan.mcap");
  EXPECT_EQ(scan->parts, 4) << "the next file is the fifth";
  EXPECT_EQ(scan->Of(Sensor::kThermal).frames, 480U + 120U);
  EXPECT_EQ(scan->Of(Sensor::kThermal).next, 482U + 120U);
  ExpectThatRunsLeadTo(first, *scan, folder_.path() / "scan-2.mcap");
  ExpectThatRunsLeadTo(second, *scan, folder_.path() / "scan-4.mcap");
}

TEST_F(InterruptedScanTest, InAFolderItIsTheNewestRecordingOfTheRig) {
  const std::string name = "edge-20231114-221320-0123abcd.mcap";
  Kill(name, {}, 5s);
  Kill("edge-20231114-221321-0123abce.mcap", {.edge_id = "rig8"}, 5s);
  Kill("edge-notes.mcap", {}, 5s);
  std::ofstream(folder_.path() / "edge-20231114-221325-0123abcf.mcap") << "not a recording";
  const auto scan = FindInterruptedScan(folder_.path(), "rig7", kScanStart + 6s, 60s);
  ASSERT_TRUE(scan);
  EXPECT_EQ(scan->path, folder_.path() / name);
}

TEST_F(InterruptedScanTest, ACameraThatWasLostLongBeforeKeepsItsLastNumber) {
  const Numbers numbers = Kill("scan.mcap", {.depth_ends = 16s}, 45s);
  const std::optional<InterruptedScan> scan = Find(46s);
  ASSERT_TRUE(scan);
  EXPECT_EQ(scan->Of(Sensor::kDepth).next, *numbers[0].rbegin() + 1);
  EXPECT_EQ(scan->newest, kScanStart + 44'975ms);
  ExpectThatRunsLeadTo(numbers, *scan, folder_.path() / "scan.mcap");
}

TEST_F(InterruptedScanTest, TheHighestPartSaysWhetherTheScanHasEndedWhicheverWasWrittenLast) {
  Kill("scan.mcap", {}, 5s);
  Complete("scan-2.mcap", {.begin = 6s, .first_numbers = {500, 500}}, 1s);
  SetWritten("scan.mcap", 9s);
  EXPECT_FALSE(Find(10s)) << "its first part was touched";
  Kill("scan-3.mcap", {.begin = 8s, .first_numbers = {700, 700}}, 1s);
  ASSERT_TRUE(CompleteRecording(folder_.path() / "scan.mcap"));
  const std::optional<InterruptedScan> scan = Find(10s);
  ASSERT_TRUE(scan) << "its first part was completed";
  EXPECT_EQ(scan->parts, 3);
  SetWritten("scan-3.mcap", -1h);
  EXPECT_FALSE(Find(10s)) << "old, whatever happened to the others";
}

TEST_F(InterruptedScanTest, ACameraThatWasAwayForAWhileHasTheRateThatItIsSaidToHave) {
  const std::filesystem::path elsewhere = elsewhere_.path() / "scan.mcap";
  {
    RecordingFiles files(
        {elsewhere,
         500ms,
         std::nullopt,
         {{std::string(kScanMetadata), ToMetadata({"rig7", kSession, kScanStart, {}})},
          {"cameras", {{"thermal_mode", "382x288@80"}}}}});
    const RecordingFile file = files.Next().value();
    Write(*file.writer, {}, 5s);
    ASSERT_TRUE(file.writer->Flush().ok());
    std::filesystem::copy_file(elsewhere, folder_.path() / "scan.mcap");
  }
  SetWritten("scan.mcap", 5s);
  const std::optional<InterruptedScan> scan = Find(7s);
  ASSERT_TRUE(scan);
  EXPECT_EQ(scan->Of(Sensor::kThermal).rate_hz, 80.0);
  EXPECT_NEAR(scan->Of(Sensor::kDepth).rate_hz, 1.0 / ToSeconds(kDepthPeriod), 0.5);
}

TEST_F(InterruptedScanTest, NumbersThatCannotBeAreNotGoneOnWith) {
  Kill("scan.mcap", {.first_numbers = {0, std::uint64_t{1} << 40U}}, 5s);
  EXPECT_FALSE(Find(6s));
}

TEST_F(InterruptedScanTest, AProcessThatWasKilledBeforeItsFirstFrameEndsNoScan) {
  Kill("scan.mcap", {}, 5s);
  Kill("scan-2.mcap", {.begin = 6s, .first_numbers = {220, 260}}, 0s);
  const std::optional<InterruptedScan> scan = Find(7s);
  ASSERT_TRUE(scan);
  EXPECT_EQ(scan->parts, 2);
  EXPECT_EQ(scan->Of(Sensor::kThermal).next, 200U);
  const std::uint64_t sent_by_the_second = 260 + 30;
  EXPECT_GT(scan->NextNumber(Sensor::kThermal, kScanStart + 7s), sent_by_the_second);
}

TEST_F(InterruptedScanTest, ACameraThatCameLateIsKnownFromItsFirstFrameOn) {
  // Between the places that are looked up, and further from them than is looked.
  for (const Nanoseconds length : {Nanoseconds(29s), Nanoseconds(38s)}) {
    const Numbers numbers = Kill("scan.mcap", {.depth_begins = 24s}, length);
    const std::optional<InterruptedScan> scan = Find(length + 1s);
    ASSERT_TRUE(scan);
    EXPECT_EQ(scan->Of(Sensor::kDepth).frames, numbers[0].size());
    EXPECT_EQ(scan->Of(Sensor::kDepth).next, *numbers[0].rbegin() + 1);
    for (const std::uint64_t number : numbers[0]) {
      const bool is_known = std::ranges::any_of(scan->runs, [number](const RecordedRun& run) {
        return run.sensor == Sensor::kDepth && run.frames.first <= number &&
               number <= run.frames.last;
      });
      EXPECT_TRUE(is_known) << number;
    }
    std::filesystem::remove(folder_.path() / "scan.mcap");
  }
}

TEST_F(InterruptedScanTest, AFileThatBreaksOffGivesWhatIsWhole) {
  const Numbers numbers = Kill("scan.mcap", {}, 5s);
  const std::filesystem::path path = folder_.path() / "scan.mcap";
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 3000);
  const std::optional<InterruptedScan> scan = Find(6s);
  ASSERT_TRUE(scan);
  RecordedFrameReader reader;
  ASSERT_TRUE(reader.GoTo({path, kScanStart}).ok());
  Numbers readable;
  for (auto frame = reader.Next(); frame && *frame; frame = reader.Next()) {
    if (const auto* depth = std::get_if<EncodedDepthFrame>(&**frame))
      readable[0].insert(depth->header.frame_number);
    if (const auto* thermal = std::get_if<EncodedThermalFrame>(&**frame))
      readable[1].insert(thermal->header.frame_number);
  }
  ASSERT_LT(readable[1].size(), numbers[1].size());
  EXPECT_EQ(scan->Of(Sensor::kThermal).next, *readable[1].rbegin() + 1);
  EXPECT_EQ(scan->Of(Sensor::kDepth).next, *readable[0].rbegin() + 1);
  EXPECT_EQ(scan->Of(Sensor::kThermal).frames, readable[1].size());
}

}  // namespace
}  // namespace isotherm
