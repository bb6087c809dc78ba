// These tests show what is left of recordings when disks fill up, power fails or bits rot.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "common/recording/mcap_file_index.h"
#include "common/recording/mcap_records.h"
#include "common/recording/testing/recording_data.h"
#include "common/testing/test_seed.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using testing::kScanStart;
using testing::MakeDepth;
using testing::MakeScan;
using testing::ReadAll;
using testing::ReadBack;
using testing::ReaderOf;
using testing::TimeOf;
using testing::WriterTo;
using testing::WriteScan;

/// Twelve frames in three chunks.
const RecordingOptions kSmallChunks{.flush_interval = 60ms};
testing::Scan SmallScan() { return MakeScan(170, 2, 2); }

std::vector<std::uint8_t> SmallFile() {
  const auto disk = std::make_shared<MemorySink::Disk>();
  auto writer = WriterTo(disk, kSmallChunks);
  EXPECT_EQ(WriteScan(SmallScan(), *writer), 0);
  EXPECT_TRUE(writer->Close().ok());
  return disk->bytes;
}

std::vector<std::uint8_t> First(const std::vector<std::uint8_t>& bytes, std::size_t size) {
  return {bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)};
}

TEST(RecordingFaultTest, FullDiskIsReportedAndTheCountersAreExact) {
  const auto scan = SmallScan();
  const std::size_t offered = scan.depth.size() + scan.thermal.size();
  const std::size_t whole = SmallFile().size();
  int failures = 0;
  for (std::size_t capacity = 0; capacity <= whole; capacity += 13) {
    const auto disk = std::make_shared<MemorySink::Disk>();
    disk->capacity = capacity;
    auto writer = WriterTo(disk, kSmallChunks);
    if (!writer) continue;  // Not even the header fitted.
    const int failed_calls = WriteScan(scan, *writer);
    const Status closed = writer->Close();
    EXPECT_EQ(closed.code(), StatusCode::kResourceExhausted) << capacity;
    EXPECT_EQ(writer->Close().code(), closed.code());
    EXPECT_EQ(disk->refused_writes, 1) << "nothing is written after an error";
    failures += failed_calls > 0 ? 1 : 0;

    const RecordingStats stats = writer->stats();
    ASSERT_EQ(stats.depth_frames + stats.thermal_frames + stats.failed, offered) << capacity;
    const auto reader = ReaderOf(disk->bytes);
    ASSERT_TRUE(reader) << reader.error().message();
    const ReadBack read = ReadAll(**reader);
    EXPECT_TRUE(read.errors.empty());
    ASSERT_EQ(read.All<RecordedDepth>().size(), stats.depth_frames) << capacity;
    ASSERT_EQ(read.All<RecordedThermal>().size(), stats.thermal_frames) << capacity;
  }
  EXPECT_GT(failures, 10);
}

/// A disk in memory whose sync fails from some time on.
class UnsyncedSink final : public ByteSink {
 public:
  struct Disk {
    bool fails = false;
    int writes_after_failure = 0;
    int syncs_after_failure = 0;
  };
  explicit UnsyncedSink(Disk& disk) : disk_(disk) {}
  Status Write(std::span<const std::uint8_t> /*bytes*/) override {
    if (disk_.fails) ++disk_.writes_after_failure;
    return OkStatus();
  }
  Status Sync() override {
    if (disk_.fails) ++disk_.syncs_after_failure;
    return disk_.fails ? IoError("input/output error") : OkStatus();
  }
  Status Close() override { return OkStatus(); }

 private:
  Disk& disk_;
};

TEST(RecordingFaultTest, F43WhatWasNotSyncedIsNotCountedAsRecordedAndSyncIsNotTriedAgain) {
  UnsyncedSink::Disk disk;
  auto writer = MakeRecordingWriter(std::make_unique<UnsyncedSink>(disk), kSmallChunks);
  ASSERT_TRUE(writer.has_value());
  ASSERT_TRUE((*writer)->Write(MakeDepth(0, kScanStart), std::nullopt).ok());
  ASSERT_TRUE((*writer)->Flush().ok());
  ASSERT_TRUE((*writer)->Write(MakeDepth(1, kScanStart), std::nullopt).ok());
  disk.fails = true;
  EXPECT_EQ((*writer)->Flush().code(), StatusCode::kIoError);
  EXPECT_EQ((*writer)->stats().depth_frames, 1U);
  EXPECT_EQ((*writer)->stats().failed, 1U);
  EXPECT_EQ((*writer)->stats().unsynced, 1U);
  const int writes = disk.writes_after_failure;
  EXPECT_FALSE((*writer)->Write(MakeDepth(2, kScanStart), std::nullopt).ok());
  EXPECT_FALSE((*writer)->Close().ok());
  EXPECT_EQ((*writer)->stats().failed, 2U);
  EXPECT_EQ((*writer)->stats().unsynced, 1U);
  EXPECT_EQ(disk.syncs_after_failure, 1) << "the kernel has forgotten the error by then";
  EXPECT_EQ(disk.writes_after_failure, writes);
}

TEST(RecordingFaultTest, FullDiskFailsEveryFurtherCall) {
  const auto disk = std::make_shared<MemorySink::Disk>();
  auto writer = WriterTo(disk, kSmallChunks);
  ASSERT_TRUE(writer->Write(MakeDepth(0, kScanStart), std::nullopt).ok());
  disk->capacity = disk->bytes.size() + 10;
  EXPECT_FALSE(writer->Flush().ok());
  EXPECT_FALSE(writer->Write(MakeDepth(1, kScanStart), std::nullopt).ok());
  EXPECT_FALSE(writer->WriteLog(kScanStart, "info", "text").ok());
  EXPECT_FALSE(writer->WriteMetadata("name", {}).ok());
  EXPECT_EQ(writer->stats().failed, 2U);
}

TEST(RecordingFaultTest, F44PowerCutCostsAtMostTheFlushInterval) {
  const RecordingOptions options{.flush_interval = 500ms};
  const auto disk = std::make_shared<MemorySink::Disk>();
  auto writer = WriterTo(disk, options);
  for (int i = 0; i < 90; ++i) {
    const CaptureTime now = kScanStart + Nanoseconds(33'333'333LL * i);
    ASSERT_TRUE(
        writer->Write(MakeDepth(static_cast<std::uint64_t>(i), now, 2, 2), std::nullopt).ok());
    const auto reader =
        ReaderOf(First(disk->bytes, disk->synced == 0 ? disk->bytes.size() : disk->synced));
    ASSERT_TRUE(reader) << reader.error().message();
    const ReadBack survived = ReadAll(**reader);
    const CaptureTime newest = survived.items.empty() ? kScanStart : TimeOf(survived.items.back());
    ASSERT_LE(now - newest, options.flush_interval + 34ms);
  }
}

TEST(RecordingFaultTest, F44EveryTruncationIsReadWithoutErrors) {
  const std::vector<std::uint8_t> whole = SmallFile();
  std::size_t before = 0;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const auto reader = ReaderOf(First(whole, size));
    if (!reader) {
      ASSERT_EQ(before, 0U);
      continue;
    }
    const ReadBack read = ReadAll(**reader);
    ASSERT_TRUE(read.errors.empty()) << read.errors[0].message();
    ASSERT_GE(read.items.size(), before) << "more bytes never give less";
    before = read.items.size();
    ASSERT_FALSE((*reader)->info().complete);
  }
  EXPECT_EQ(before, SmallScan().depth.size() + SmallScan().thermal.size());
}

/// True if the frame is bit for bit the one of its number in `frames`.
template <typename Recorded, typename Frame>
bool IsOneOf(const Recorded& read, const std::vector<Frame>& frames) {
  const std::uint64_t number = read.frame.header.frame_number;
  return number < frames.size() &&
         read.frame.header.capture_time == frames[number].header.capture_time &&
         read.frame.image.payload == frames[number].image.payload;
}

TEST(RecordingFaultTest, F45WhatIsReadFromDamagedRecordingsIsWhatWasWritten) {
  std::mt19937 random(testing::Seed());
  const std::vector<std::uint8_t> whole = SmallFile();
  const testing::Scan scan = SmallScan();
  const MemorySource source(whole);
  const auto index = mcap::ReadFileIndex(source);
  ASSERT_TRUE(index);
  std::size_t frames_read = 0, whole_chunks = 0;
  for (int i = 0; i < 1000; ++i) {
    std::vector<std::uint8_t> damaged = whole;
    for (auto flips = random() % 6 + 1; flips > 0; --flips) {
      damaged[8 + random() % (damaged.size() - 8)] = static_cast<std::uint8_t>(random());
    }
    auto reader = ReaderOf(damaged);
    std::size_t good_chunks = 0;
    for (const mcap::Segment& chunk : index->segments) {
      const auto begin = static_cast<std::ptrdiff_t>(chunk.offset);
      good_chunks += std::equal(whole.begin() + begin,
                                whole.begin() + begin + static_cast<std::ptrdiff_t>(chunk.length),
                                damaged.begin() + begin)
                         ? 1
                         : 0;
    }
    if (!reader) {
      // Only what says that it is of another version is refused as long as a chunk is good.
      ASSERT_TRUE(good_chunks == 0 || reader.error().code() == StatusCode::kFailedPrecondition)
          << reader.error().message();
      continue;
    }
    whole_chunks += good_chunks;
    const ReadBack read = ReadAll(**reader);
    for (const RecordedDepth& depth : read.All<RecordedDepth>())
      ASSERT_TRUE(IsOneOf(depth, scan.depth)) << i;
    for (const RecordedThermal& thermal : read.All<RecordedThermal>())
      ASSERT_TRUE(IsOneOf(thermal, scan.thermal)) << i;
    const std::size_t frames =
        read.All<RecordedDepth>().size() + read.All<RecordedThermal>().size();
    ASSERT_GE(frames, 3 * good_chunks) << i << ": each chunk has three frames or more";
    frames_read += frames;
  }
  EXPECT_GT(whole_chunks, 500U) << "the damage leaves something";
  EXPECT_GT(frames_read, 3 * whole_chunks - 1);
}

TEST(RecordingFaultTest, F45RigIsFoundWhenItsFirstChunkIsDamaged) {
  const auto disk = std::make_shared<MemorySink::Disk>();
  {
    auto writer = WriterTo(disk, {.flush_interval = 500ms});
    ASSERT_TRUE(writer->Write(testing::MakeRig()).ok());
    for (int i = 0; i < 25; ++i) {
      ASSERT_TRUE(
          writer->Write(MakeDepth(static_cast<std::uint64_t>(i), kScanStart + i * 1s), std::nullopt)
              .ok());
    }
  }
  const MemorySource source(disk->bytes);
  const auto index = mcap::ReadFileIndex(source);
  ASSERT_TRUE(index);
  const auto intact = ReaderOf(disk->bytes);
  ASSERT_TRUE(intact);
  EXPECT_EQ((*intact)->info().messages_by_topic.at("/rig"), 3U) << "at 0, 10 and 20 s";
  std::vector<std::uint8_t> damaged = disk->bytes;
  const mcap::Segment first = index->segments[0];
  for (std::uint64_t i = first.length / 2; i < first.length / 2 + 3; ++i)
    damaged[static_cast<std::size_t>(first.offset + i)] ^= 0x55;
  const auto reader = ReaderOf(damaged);
  ASSERT_TRUE(reader);
  const Result<Rig> rig = (*reader)->ReadRig();
  ASSERT_TRUE(rig) << rig.error().message();
  EXPECT_EQ(rig->depth->fx, testing::MakeRig().depth->fx);
}

/// A file whose recording version says `version`.
std::vector<std::uint8_t> FileOfVersion(const std::string& version) {
  mcap::Bytes bytes(mcap::kMagic.begin(), mcap::kMagic.end());
  mcap::Append(mcap::Header{.profile = "", .library = ""}, bytes);
  mcap::Append(
      mcap::Metadata{.name = std::string(kRecordingMetadataName), .values = {{"version", version}}},
      bytes);
  return bytes;
}

TEST(RecordingFaultTest, F47NewerMinorVersionIsReadAnotherMajorRefused) {
  EXPECT_TRUE(ReaderOf(FileOfVersion("1.7")));
  for (const char* const version : {"2.0", "10.0", "0.9"}) {
    const auto reader = ReaderOf(FileOfVersion(version));
    ASSERT_FALSE(reader) << version;
    EXPECT_EQ(reader.error().code(), StatusCode::kFailedPrecondition);
    EXPECT_THAT(reader.error().message(), HasSubstr(version));
  }
}

TEST(RecordingFaultTest, F47UnknownTopicsAreSkipped) {
  const auto disk = std::make_shared<MemorySink::Disk>();
  {
    auto writer = WriterTo(disk);
    ASSERT_TRUE(writer->WriteMessage("/future", "isotherm.Future", "", kScanStart, "bytes").ok());
    ASSERT_TRUE(writer->Write(MakeDepth(0, kScanStart), std::nullopt).ok());
    EXPECT_EQ(writer->WriteMessage("/depth", "isotherm.Future", "", kScanStart, "bytes").code(),
              StatusCode::kInvalidArgument);
  }
  const auto reader = ReaderOf(disk->bytes);
  ASSERT_TRUE(reader);
  EXPECT_EQ(ReadAll(**reader).items.size(), 1U);
  EXPECT_EQ((*reader)->info().messages_by_topic.at("/future"), 1U);
}

TEST(RecordingFaultTest, DamagedMessageIsReportedAndTheNextIsRead) {
  const auto disk = std::make_shared<MemorySink::Disk>();
  {
    auto writer = WriterTo(disk);
    ASSERT_TRUE(
        writer->WriteMessage("/depth", "foxglove.RawImage", "", kScanStart, "\xFF\xFF").ok());
    ASSERT_TRUE(writer->Write(testing::MakeThermal(0, kScanStart + 1ms), std::nullopt).ok());
  }
  const auto reader = ReaderOf(disk->bytes);
  ASSERT_TRUE(reader);
  const ReadBack read = ReadAll(**reader);
  ASSERT_EQ(read.errors.size(), 1U);
  EXPECT_EQ(read.errors[0].code(), StatusCode::kDataLoss);
  EXPECT_THAT(read.errors[0].message(), HasSubstr("/depth"));
  EXPECT_EQ(read.items.size(), 1U);
}

TEST(RecordingFaultTest, FrameBeforeTheEpochOrOfWrongSizeIsRefusedAndCounted) {
  const auto disk = std::make_shared<MemorySink::Disk>();
  auto writer = WriterTo(disk, {.image_storage = ImageStorage::kViewable});
  EXPECT_EQ(writer->Write(MakeDepth(0, CaptureTimeFromNanoseconds(-1)), std::nullopt).code(),
            StatusCode::kInvalidArgument);
  EncodedDepthFrame wrong = MakeDepth(1, kScanStart);
  wrong.image.payload.pop_back();
  EXPECT_EQ(writer->Write(wrong, std::nullopt).code(), StatusCode::kDataLoss);
  EXPECT_TRUE(writer->Write(MakeDepth(2, kScanStart), std::nullopt).ok());
  EXPECT_EQ(writer->stats().failed, 2U);
  EXPECT_EQ(writer->stats().depth_frames, 1U);
}

TEST(RecordingFaultTest, NothingCanBeWrittenAfterClose) {
  const auto disk = std::make_shared<MemorySink::Disk>();
  auto writer = WriterTo(disk);
  ASSERT_TRUE(writer->Close().ok());
  const std::size_t size = disk->bytes.size();
  EXPECT_EQ(writer->Write(MakeDepth(0, kScanStart), std::nullopt).code(),
            StatusCode::kFailedPrecondition);
  EXPECT_EQ(writer->Flush().code(), StatusCode::kFailedPrecondition);
  EXPECT_TRUE(writer->Close().ok());
  EXPECT_EQ(disk->bytes.size(), size);
  EXPECT_EQ(writer->stats().failed, 1U);
}

}  // namespace
}  // namespace isotherm
