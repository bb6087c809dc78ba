// MCAP files that are cut off, damaged, or made to take much work.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

#include "common/recording/testing/mcap_notes.h"
#include "common/testing/test_seed.h"

namespace isotherm::mcap {
namespace {

using ::testing::HasSubstr;

/// How many of the times 10, 50, 200, 210, 400, 401, 402, 600 lie before each chunk.
constexpr std::array<std::size_t, 5> kNotesBefore = {0, 2, 4, 7, 8};

TEST_F(McapTest, F44EveryTruncationGivesAllWholeChunks) {
  WriteFile({10, 50, 200, 210, 400, 401, 402, 600});
  const Bytes whole = disk_->bytes;
  const auto complete = Read(whole);
  ASSERT_TRUE(complete);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const auto contents = Read(Bytes(whole.begin(), whole.begin() + static_cast<long>(size)));
    const std::size_t whole_chunks = static_cast<std::size_t>(std::count_if(
        complete->index.segments.begin(), complete->index.segments.end(),
        [size](const Segment& chunk) { return chunk.offset + chunk.length <= size; }));
    if (!contents) {
      ASSERT_LT(size, 40U) << "only a file without whole header cannot be opened";
      continue;
    }
    ASSERT_TRUE(contents->errors.empty()) << contents->errors[0].message();
    ASSERT_EQ(contents->index.segments.size(), whole_chunks) << size;
    ASSERT_EQ(contents->notes.size(), kNotesBefore[whole_chunks]) << size;
    ASSERT_TRUE(
        std::equal(contents->notes.begin(), contents->notes.end(), complete->notes.begin()));
    ASSERT_FALSE(contents->index.complete);
  }
}

TEST_F(McapTest, F44TornTailIsReadUpToTheLastGoodChunk) {
  WriteFile({10, 50, 200, 210, 400, 401, 402, 600}, /*close=*/false);
  const auto complete = Read(unfinished_);
  ASSERT_TRUE(complete);
  const Segment last = complete->index.segments.back();
  // The file system had reserved the blocks but not yet written them.
  Bytes torn = unfinished_;
  std::fill(torn.begin() + static_cast<long>(last.offset + last.length / 2), torn.end(), 0);
  torn.resize(torn.size() + 1000);
  const auto contents = Read(torn);
  ASSERT_TRUE(contents);
  EXPECT_EQ(contents->notes.size(), 7U);
  EXPECT_TRUE(contents->errors.empty());
  EXPECT_GT(contents->index.bytes_ignored, 1000U);
  EXPECT_LE(contents->index.bytes_ignored, torn.size() - last.offset);
}

TEST_F(McapTest, F45DamagedChunkIsReportedOnceAndSkipped) {
  WriteFile({10, 50, 200, 210, 400, 401});
  const auto complete = Read(disk_->bytes);
  Bytes damaged = disk_->bytes;
  const Segment chunk = complete->index.segments[1];
  damaged[static_cast<std::size_t>(chunk.offset + chunk.length - 5)] ^= 0x10;
  const auto contents = Read(damaged);
  ASSERT_TRUE(contents);
  EXPECT_EQ(contents->errors.size(), 1U);
  EXPECT_EQ(contents->errors.at(0).code(), StatusCode::kDataLoss);
  EXPECT_THAT(contents->errors[0].message(), HasSubstr(std::to_string(chunk.offset)));
  EXPECT_EQ(contents->notes, (std::vector<Note>{{10, 0}, {50, 1}, {400, 4}, {401, 5}}));
}

TEST_F(McapTest, DamagedSummaryIsReplacedByAScan) {
  WriteFile({10, 50, 200, 210});
  Bytes damaged = disk_->bytes;
  damaged[damaged.size() - kMagic.size() - kFooterRecordBytes - 20] ^= 0x01;
  const auto contents = Read(damaged);
  ASSERT_TRUE(contents);
  EXPECT_FALSE(contents->index.complete);
  EXPECT_EQ(contents->notes.size(), 4U);
}

TEST_F(McapTest, F45FlippedBitInALengthCostsAtMostThatChunk) {
  const std::vector<std::uint64_t> times = {10, 50, 200, 210, 400, 401, 402, 600};
  WriteFile(times, /*close=*/false);
  const auto complete = Read(unfinished_);
  ASSERT_TRUE(complete);
  ASSERT_EQ(complete->index.segments.size(), 4U);
  for (std::size_t chunk = 0; chunk < 4; ++chunk) {
    const Segment& segment = complete->index.segments[chunk];
    // The length of the chunk itself, and that of the message index behind it.
    for (const std::uint64_t record : {segment.offset, segment.offset + segment.length}) {
      const bool is_chunk = record == segment.offset;
      for (std::size_t bit = 0; bit < 64; ++bit) {
        Bytes damaged = unfinished_;
        damaged[static_cast<std::size_t>(record) + 1 + bit / 8] ^=
            static_cast<std::uint8_t>(1U << bit % 8);
        const auto contents = Read(damaged);
        ASSERT_TRUE(contents) << chunk << " bit " << bit;
        std::vector<Note> expected = complete->notes;
        if (is_chunk) {
          expected.erase(expected.begin() + static_cast<long>(kNotesBefore[chunk]),
                         expected.begin() + static_cast<long>(kNotesBefore[chunk + 1]));
        }
        ASSERT_EQ(contents->notes, expected) << "chunk " << chunk << " bit " << bit;
        ASSERT_TRUE(contents->errors.empty());
        ASSERT_EQ(contents->index.gaps.size(), 1U) << "chunk " << chunk << " bit " << bit;
        const Gap& gap = contents->index.gaps[0];
        ASSERT_EQ(gap.offset, record);
        ASSERT_EQ(contents->index.bytes_ignored, gap.length);
        // The message index behind the lost chunk says what was in it.
        if (is_chunk) {
          ASSERT_EQ(gap.length, segment.length);
          ASSERT_EQ(gap.message_counts.at(channel_), kNotesBefore[chunk + 1] - kNotesBefore[chunk]);
        }
      }
    }
  }
}

TEST_F(McapTest, F45BytesThatLookLikeAChunkDoNotHideTheChunksBehindThem) {
  WriteFile({10, 50, 200, 210, 400}, /*close=*/false);
  const auto complete = Read(unfinished_);
  ASSERT_TRUE(complete);
  const auto at = static_cast<long>(complete->index.segments.at(1).offset);
  const Bytes rest(unfinished_.begin() + at, unfinished_.end());
  Bytes damaged(unfinished_.begin(), unfinished_.begin() + at);
  damaged.push_back(0);  // No record begins so: the next one is looked for.
  // Its lengths fit each other and the end of the file; only its checksum does not.
  ChunkHeader header = HeaderOf(rest);
  header.uncompressed_crc = 1;
  Append(header, rest, damaged);
  const auto contents = Read(damaged);
  ASSERT_TRUE(contents);
  EXPECT_EQ(contents->notes, complete->notes);
  EXPECT_TRUE(contents->errors.empty());
}

TEST_F(McapTest, F45FlippedBitOutsideTheChunksCostsNoMessage) {
  WriteFile({10, 50, 200, 210, 400, 401, 402, 600}, /*close=*/false);
  const auto complete = Read(unfinished_);
  std::vector<bool> in_chunk(unfinished_.size(), false);
  for (const Segment& chunk : complete->index.segments)
    std::fill_n(in_chunk.begin() + static_cast<long>(chunk.offset), chunk.length, true);
  for (std::size_t i = kMagic.size(); i < unfinished_.size(); ++i) {
    for (int bit = 0; bit < 8 && !in_chunk[i]; ++bit) {
      Bytes damaged = unfinished_;
      damaged[i] ^= static_cast<std::uint8_t>(1U << bit);
      const auto contents = Read(damaged);
      ASSERT_TRUE(contents) << "byte " << i << " bit " << bit;
      std::vector<Note> notes = contents->notes;  // A damaged record may pass for a message.
      std::erase_if(notes, [&complete](const Note& note) {
        return std::find(complete->notes.begin(), complete->notes.end(), note) ==
               complete->notes.end();
      });
      ASSERT_EQ(notes, complete->notes) << "byte " << i << " bit " << bit;
    }
  }
}

TEST_F(McapTest, F45EveryChunkThatIsNotDamagedIsReadFromDamagedFiles) {
  std::mt19937 random(testing::Seed());
  WriteFile({10, 50, 200, 210, 400, 401, 402, 600});
  const Bytes& whole = disk_->bytes;
  const auto complete = Read(whole);
  ASSERT_TRUE(complete);
  int opened = 0, lost = 0;
  for (int i = 0; i < 5000; ++i) {
    Bytes damaged = whole;
    // The magic decides whether this is a recording at all.
    const std::size_t first = kMagic.size();
    for (auto flips = random() % 8 + 1; flips > 0; --flips) {
      damaged[first + random() % (damaged.size() - first)] = static_cast<std::uint8_t>(random());
    }
    // Without the checksum of the summary, damage in it reaches the code behind.
    const bool trusted_summary = i % 2 == 0;
    if (trusted_summary) std::fill_n(damaged.end() - 12, 4, std::uint8_t{0});
    if (i % 3 == 0) damaged.resize(first + random() % (damaged.size() - first));
    const auto contents = Read(damaged);
    std::size_t expected = 0;
    for (std::size_t chunk = 0; chunk < complete->index.segments.size(); ++chunk) {
      const Segment& segment = complete->index.segments[chunk];
      const auto begin = static_cast<long>(segment.offset);
      const auto end = static_cast<long>(segment.offset + segment.length);
      if (damaged.size() < static_cast<std::size_t>(end) ||
          !std::equal(whole.begin() + begin, whole.begin() + end, damaged.begin() + begin)) {
        ++lost;
        continue;
      }
      for (std::size_t n = kNotesBefore[chunk]; n < kNotesBefore[chunk + 1]; ++n) {
        ++expected;
        if (trusted_summary) continue;
        ASSERT_TRUE(contents) << i;
        ASSERT_EQ(std::count(contents->notes.begin(), contents->notes.end(), complete->notes[n]), 1)
            << i << " note " << n;
      }
    }
    if (!contents) continue;
    ++opened;
    // What a checksum covers is right or not there; up to eight damaged records pass for messages.
    const auto wrong = std::count_if(
        contents->notes.begin(), contents->notes.end(), [&complete](const Note& note) {
          return std::find(complete->notes.begin(), complete->notes.end(), note) ==
                 complete->notes.end();
        });
    ASSERT_LE(wrong, 8) << i;
  }
  EXPECT_GT(opened, 4000);
  EXPECT_GT(lost, 1000) << "the damage reached the chunks";
}

TEST_F(McapTest, F65ReadingIsGivenUpWhenItTakesFarMoreThanTheSizeJustifies) {
  // Two chunks whose messages alternate, and a cache for one: each message unpacks a chunk again.
  std::vector<std::uint64_t> times;
  for (std::uint64_t i = 0; i < 2000; ++i) times.push_back(i % 1000 * 2 + i / 1000);
  auto writer = MakeWriter(/*chunk_duration_ns=*/1'000'000);
  for (std::uint32_t i = 0; i < times.size(); ++i) {
    ASSERT_TRUE(writer->WriteMessage(channel_, times[i], times[i], Bytes(500'000 / 20)).ok());
    ASSERT_TRUE(i != 999 || writer->Flush().ok());
  }
  ASSERT_TRUE(writer->Close().ok());
  const auto contents = Read(disk_->bytes, /*cache_bytes=*/1);
  ASSERT_TRUE(contents);
  ASSERT_FALSE(contents->errors.empty());
  EXPECT_EQ(contents->errors.back().code(), StatusCode::kResourceExhausted);
  EXPECT_THAT(contents->errors.back().message(), HasSubstr("times its size"));
}

}  // namespace
}  // namespace isotherm::mcap
