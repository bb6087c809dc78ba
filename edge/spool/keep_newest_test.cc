// A recording of which the newest is kept, with real files.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <random>
#include <set>
#include <vector>

#include "common/testing/temporary_directory.h"
#include "common/testing/test_seed.h"
#include "edge/options/edge_options.pb.h"
#include "edge/spool/interrupted_scan.h"
#include "edge/spool/kept_part.h"
#include "edge/spool/older_recordings.h"
#include "edge/spool/recorded_frame_reader.h"
#include "edge/spool/recording_files.h"
#include "edge/spool/spool.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr CaptureTime kStart{1'700'000'000s};
constexpr Nanoseconds kPeriod = 25ms;
constexpr std::size_t kFrameBytes = 5000;  // 0.2 MB/s.
constexpr double kKept_bytes = 1e6;
const std::vector<FrameRange> kAll = {{0, 1'000'000}};

std::uint64_t Count(const std::vector<FrameRange>& ranges) {
  std::uint64_t frames = 0;
  for (const FrameRange& range : ranges) frames += SizeOf(range);
  return frames;
}

/// Records depth frames that no codec makes smaller.
class KeepNewestTest : public ::testing::Test {
 protected:
  KeepNewestTest() {
    options_.set_record(folder_.path().string() + "/");
    options_.set_when_full(KEEP_NEWEST);
    options_.set_quota_gb(1e-9 * kKept_bytes);
  }

  void Start(const std::filesystem::path& path, const InterruptedScan* before = nullptr) {
    const auto files = std::make_shared<RecordingFiles>(
        RecordingDescription{path,
                             100ms,
                             std::nullopt,
                             {{std::string(kScanMetadata), ToMetadata({"rig7", 5, kStart, {}})}},
                             before != nullptr ? before->parts : 0,
                             /*sync=*/false});
    const auto next_file = [this, files]() -> Result<RecordingFile> {
      if (!disk_works_) return Err(IoError("no disk"));
      return files->Next();
    };
    SpoolParts parts{next_file, [this] { return Result<std::uint64_t>(free_bytes_); }, options_,
                     clock_, counters_};
    parts.before = before;
    parts.recordings_size = [this] { return RecordingsSize(options_.record()); };
    parts.delete_oldest = [this, path]() -> std::optional<DeletedFile> {
      if (!deletes_) return std::nullopt;
      return DeleteOldestFile(options_.record(), path);
    };
    spool_ = std::make_unique<Spool>(std::move(parts));
    spool_->Tend(false);
  }
  void RecordFor(Nanoseconds time) {
    for (Nanoseconds passed{0}; passed < time; passed += kPeriod) {
      EncodedDepthFrame frame;
      frame.header = {.session = 5,
                      .frame_number = next_,
                      .capture_time = kStart + kPeriod * static_cast<std::int64_t>(next_)};
      frame.depth_scale = 1000.0;
      frame.image = {.encoding = Encoding::kRaw16,
                     .width = kFrameBytes / 2,
                     .height = 1,
                     .payload = std::vector<std::uint8_t>(kFrameBytes)};
      for (std::uint8_t& byte : frame.image.payload) byte = static_cast<std::uint8_t>(random_());
      ++next_;
      spool_->Add({frame, {}});
      spool_->Tend(false);
      clock_.Advance(kPeriod);
      most_bytes_ = std::max(most_bytes_, RecordingsSize(options_.record()));
    }
  }
  /// Returns the scan that a process would find that is started now.
  std::optional<InterruptedScan> Interrupted() const {
    const CaptureTime now(std::chrono::system_clock::now().time_since_epoch());
    return FindInterruptedScan(options_.record(), "rig7", now + 1s, 600s);
  }
  /// Returns the frames that can be read back of those that are said to be recorded.
  std::set<std::uint64_t> Readable() {
    std::set<std::uint64_t> numbers;
    const std::vector<FrameRange> known = spool_->recorded_frames().Of(Sensor::kDepth, kAll);
    RecordedFrameReader reader;
    for (const FrameRange& range : known) {
      for (std::uint64_t number = range.first; number <= range.last; ++number) {
        const auto place = spool_->recorded_frames().PlaceOf(Sensor::kDepth, number);
        if (!place || numbers.contains(number) || !reader.GoTo(*place).ok()) continue;
        for (auto frame = reader.Next(); frame && *frame; frame = reader.Next())
          numbers.insert(std::get<EncodedDepthFrame>(**frame).header.frame_number);
      }
    }
    return numbers;
  }

  const testing::TemporaryDirectory folder_;
  const std::filesystem::path path_ = folder_.path() / "edge-20260101-000000-00000001.mcap";
  SpoolOptions options_;
  FakeClock clock_;
  FrameCounters counters_;
  std::mt19937 random_{testing::Seed()};
  std::uint64_t free_bytes_ = 1'000'000'000'000;
  bool deletes_ = true;
  bool disk_works_ = true;
  std::uint64_t next_ = 0;
  std::uint64_t most_bytes_ = 0;
  std::unique_ptr<Spool> spool_;
};

TEST_F(KeepNewestTest, F41TheNewestIsKeptAndTheRestIsKnownToBeDeleted) {
  Start(path_);
  RecordFor(60s);  // 12 MB.
  // The size is looked at once a second, and a chunk is written at once.
  EXPECT_LT(static_cast<double>(most_bytes_), 1.4 * kKept_bytes);
  EXPECT_EQ(spool_->status().problem, "");
  EXPECT_EQ(spool_->status().brief, "");
  // A part more is deleted than has to be; a tenth are the file's own records.
  EXPECT_NEAR(spool_->status().keeps_s, 0.875 * kKept_bytes / 0.22e6, 0.5);
  EXPECT_TRUE(spool_->Close().ok());
  EXPECT_EQ(counters_.Get(Sensor::kDepth).recorded, next_);

  const std::vector<FrameRange> kept = spool_->recorded_frames().Of(Sensor::kDepth, kAll);
  ASSERT_EQ(kept.size(), 1U);
  EXPECT_EQ(kept[0].last, next_ - 1);
  EXPECT_GT(static_cast<double>(Count(kept) * kFrameBytes), 0.7 * kKept_bytes);
  const std::set<std::uint64_t> readable = Readable();
  EXPECT_EQ(readable.size(), Count(kept));
  EXPECT_EQ(*readable.begin(), kept[0].first);
  EXPECT_THAT(spool_->recorded_frames().DeletedOf(Sensor::kDepth, kAll),
              ::testing::ElementsAre(FrameRange{0, kept[0].first - 1}));
}

TEST_F(KeepNewestTest, OlderRecordingsGoFirstFetchedOrNot) {
  const std::filesystem::path older = folder_.path() / "edge-20250101-000000-00000002.mcap";
  std::ofstream(older) << std::string(500'000, 'x');
  Start(path_);
  RecordFor(4s);
  EXPECT_FALSE(std::filesystem::exists(older));
  EXPECT_THAT(spool_->recorded_frames().DeletedOf(Sensor::kDepth, kAll), IsEmpty());
}

TEST_F(KeepNewestTest, F41WhereOthersFillTheDiskLessIsKept) {
  Start(path_);
  RecordFor(10s);
  const double kept_s = spool_->status().keeps_s;
  free_bytes_ = 1000;
  RecordFor(20s);
  EXPECT_EQ(spool_->status().problem, "") << "it goes on in what it makes free";
  EXPECT_EQ(counters_.Get(Sensor::kDepth).recorded, next_);
  EXPECT_LT(spool_->status().keeps_s, 0.5 * kept_s);
  EXPECT_LT(static_cast<double>(RecordingsSize(options_.record())), 0.5 * kKept_bytes);
  // What cannot be deleted.
  deletes_ = false;
  RecordFor(3s);
  EXPECT_THAT(spool_->status().problem,
              HasSubstr("none of the rig's recordings can be deleted: make room"));
}

TEST_F(KeepNewestTest, F43ADiskThatWorksAgainIsKnownToThoughEachFileIsShort) {
  Start(path_);
  RecordFor(2s);
  disk_works_ = false;
  RecordFor(2s);
  EXPECT_NE(spool_->status().problem, "");
  disk_works_ = true;
  RecordFor(20s);
  EXPECT_EQ(spool_->status().problem, "");
}

TEST_F(KeepNewestTest, F37AScanThatIsGoneOnWithKnowsWhatIsDeleted) {
  Start(path_);
  RecordFor(30s);
  const std::vector<FrameRange> kept = spool_->recorded_frames().Of(Sensor::kDepth, kAll);
  // As a process that is killed leaves it: the last file without its end.
  const std::filesystem::path newest = spool_->status().path;
  std::filesystem::copy_file(newest, folder_.path() / "copy");
  spool_.reset();
  std::filesystem::rename(folder_.path() / "copy", newest);
  const std::optional<InterruptedScan> before = Interrupted();
  ASSERT_TRUE(before);
  EXPECT_EQ(before->path, path_);
  const RecordedStream& depth = before->Of(Sensor::kDepth);
  EXPECT_EQ(depth.deleted, kept[0].first);
  EXPECT_EQ(before->Of(Sensor::kThermal).frames, 0U);
  EXPECT_EQ(depth.frames, depth.next) << "all were recorded";

  const std::uint64_t recorded = next_ = depth.next;
  counters_.Set(Sensor::kDepth, FrameFate::kCaptured, recorded);
  Start(path_, &*before);
  // At once it makes room.
  EXPECT_GE(Count(spool_->recorded_frames().DeletedOf(Sensor::kDepth, kAll)), depth.deleted);
  EXPECT_LT(Count(spool_->recorded_frames().DeletedOf(Sensor::kDepth, kAll)), recorded);
  RecordFor(30s);
  EXPECT_TRUE(spool_->Close().ok());
  EXPECT_EQ(counters_.Get(Sensor::kDepth).recorded, next_);
  EXPECT_LT(static_cast<double>(most_bytes_), 1.4 * kKept_bytes);
  const std::vector<FrameRange> last = spool_->recorded_frames().Of(Sensor::kDepth, kAll);
  ASSERT_EQ(last.size(), 1U);
  EXPECT_GT(last[0].first, recorded) << "files of the process before are deleted, too";
  EXPECT_EQ(Readable().size(), Count(last));
}

TEST_F(KeepNewestTest, F37AKillBetweenTwoFilesDoesNotEndTheScanAndItsEndDoes) {
  Start(path_);
  RecordFor(10s);
  const std::filesystem::path newest = spool_->status().path;
  EXPECT_TRUE(spool_->Close().ok());
  spool_.reset();
  EXPECT_FALSE(Interrupted());
  // Its first bytes had not reached the disk.
  std::filesystem::remove(newest);
  const std::optional<InterruptedScan> before = Interrupted();
  ASSERT_TRUE(before);
  EXPECT_LT(before->Of(Sensor::kDepth).next, next_);
}

TEST_F(KeepNewestTest, TakesAQuotaAndAFolder) {
  EXPECT_TRUE(Validate(options_).ok()) << Validate(options_).message();
  options_.set_quota_gb(0.0);
  EXPECT_THAT(Validate(options_).message(), HasSubstr("quota_gb"));
  options_.set_quota_gb(0.1);
  options_.set_record("scan.mcap");
  EXPECT_THAT(Validate(options_).message(),
              HasSubstr("\"scan.mcap\" is no folder; with when_full=KEEP_NEWEST name one"));
}

TEST(KeptPartTest, WhatAFileSaysOfThoseBeforeItIsBelievedIfItCanBe) {
  RecordingInfo info;
  EXPECT_FALSE(ReadRecordedBefore(info));
  auto& values = info.metadata[std::string(kBeforeMetadata)];
  const auto good = values = ToMetadata(RecordedBefore{StreamBefore{5, 7}, StreamBefore{3, 9}});
  const std::optional<RecordedBefore> before = ReadRecordedBefore(info);
  ASSERT_TRUE(before);
  EXPECT_EQ((*before)[1].frames, 3U);
  EXPECT_EQ((*before)[1].next, 9U);
  for (const std::string bad : {"", "-1", "4x", "10", "99999999999999999999"}) {
    values = good;
    values["thermal_frames"] = bad;
    EXPECT_FALSE(ReadRecordedBefore(info)) << bad;
  }
  values = ToMetadata(RecordedBefore{StreamBefore{5, std::uint64_t{1} << 40U}, StreamBefore()});
  EXPECT_FALSE(ReadRecordedBefore(info)) << "a camera of a thousand years";
}

}  // namespace
}  // namespace isotherm
