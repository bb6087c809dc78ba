#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "common/recording/mcap_file_index.h"
#include "common/recording/mcap_message_stream.h"
#include "common/recording/mcap_writer.h"
#include "common/recording/testing/memory_stream.h"
#include "common/testing/test_seed.h"

namespace isotherm::mcap {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Holds what a message is recognised by.
struct Note {
  std::uint64_t log_time = 0;
  std::uint32_t number = 0;
  bool operator==(const Note&) const = default;
};

Bytes ToBytes(std::uint32_t number) {
  Bytes bytes(20, static_cast<std::uint8_t>(number));
  std::memcpy(bytes.data(), &number, sizeof(number));
  return bytes;
}

/// How many of the times 10, 50, 200, 210, 400, 401, 402, 600 lie before each chunk.
constexpr std::array<std::size_t, 5> kNotesBefore = {0, 2, 4, 7, 8};

class McapTest : public ::testing::Test {
 protected:
  std::unique_ptr<Writer> MakeWriter(std::uint64_t chunk_duration_ns = 100) {
    auto writer = Writer::Create(
        std::make_unique<MemorySink>(disk_),
        {.library = "test", .chunk_bytes = 1 << 20, .chunk_duration_ns = chunk_duration_ns});
    EXPECT_TRUE(writer);
    const SchemaId schema = (*writer)->AddSchema("Note", "protobuf", "not really");
    channel_ = (*writer)->AddChannel(schema, "/note", "protobuf");
    return std::move(*writer);
  }

  /// One message per time; those that share a chunk are at most 100 ns apart.
  void WriteFile(const std::vector<std::uint64_t>& times, bool close = true) {
    auto writer = MakeWriter();
    for (std::uint32_t i = 0; i < times.size(); ++i) {
      ASSERT_TRUE(writer->WriteMessage(channel_, times[i], times[i], ToBytes(i)).ok());
    }
    ASSERT_TRUE(writer->WriteMetadata({.name = "extra", .values = {{"a", "b"}}}).ok());
    ASSERT_TRUE(writer->Flush().ok());
    if (!close) unfinished_ = disk_->bytes;
    ASSERT_TRUE(writer->Close().ok());
  }

  struct Contents {
    FileIndex index;
    std::vector<Note> notes;
    std::vector<Status> errors;
  };

  /// nullopt if the file cannot be opened.
  static std::optional<Contents> Read(const Bytes& bytes, std::size_t cache_bytes = 1 << 20) {
    const MemorySource source(bytes);
    Result<FileIndex> index = ReadFileIndex(source);
    if (!index) return std::nullopt;
    Contents contents{.index = std::move(*index), .notes = {}, .errors = {}};
    MessageStream stream(source, contents.index, cache_bytes);
    while (true) {
      auto message = stream.Next();
      if (!message) {
        contents.errors.push_back(message.error());
        continue;
      }
      if (!*message) return contents;
      std::uint32_t number = 0;
      if ((*message)->data.size() >= sizeof(number)) {
        std::memcpy(&number, (*message)->data.data(), sizeof(number));
      }
      contents.notes.push_back({(*message)->log_time, number});
    }
  }

  std::shared_ptr<MemorySink::Disk> disk_ = std::make_shared<MemorySink::Disk>();
  Bytes unfinished_;
  ChannelId channel_ = 0;
};

TEST_F(McapTest, RecordsLieInTheFileAsTheSpecificationSays) {
  Bytes bytes;
  Append(Header{.profile = "p", .library = "li"}, bytes);
  EXPECT_THAT(bytes, ElementsAre(1, 11, 0, 0, 0, 0, 0, 0, 0,  // opcode, length
                                 1, 0, 0, 0, 'p', 2, 0, 0, 0, 'l', 'i'));
  bytes.clear();
  Append(MessageIndex{.channel_id = 0x0203, .entries = {{4, 5}}}, bytes);
  EXPECT_THAT(bytes, ElementsAre(7, 22, 0, 0, 0, 0, 0, 0, 0, 3, 2, 16, 0, 0, 0,  //
                                 4, 0, 0, 0, 0, 0, 0, 0, 5, 0, 0, 0, 0, 0, 0, 0));
}

TEST_F(McapTest, FileStartsAndEndsWithTheMagic) {
  WriteFile({1, 2, 3});
  const Bytes& bytes = disk_->bytes;
  ASSERT_GT(bytes.size(), 2 * kMagic.size());
  EXPECT_TRUE(std::equal(kMagic.begin(), kMagic.end(), bytes.begin()));
  EXPECT_TRUE(std::equal(kMagic.begin(), kMagic.end(), bytes.end() - kMagic.size()));
}

TEST_F(McapTest, RebuiltIndexEqualsTheSummary) {
  WriteFile({10, 50, 200, 210, 400, 401, 402}, /*close=*/false);
  const auto closed = Read(disk_->bytes);
  const auto scanned = Read(unfinished_);
  ASSERT_TRUE(closed && scanned);
  EXPECT_TRUE(closed->index.complete);
  EXPECT_FALSE(scanned->index.complete);
  EXPECT_EQ(closed->notes, scanned->notes);
  EXPECT_EQ(closed->index.message_counts, scanned->index.message_counts);
  EXPECT_EQ(closed->index.segments.size(), 3U);
  EXPECT_EQ(scanned->index.segments.size(), 3U);
  EXPECT_EQ(scanned->index.bytes_ignored, 0U);
  EXPECT_EQ(scanned->index.metadata.at(0).values.at("a"), "b");
  EXPECT_EQ(scanned->index.definitions.channels.at(1).topic, "/note");
}

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

TEST_F(McapTest, OrderIsThatOfTimeHoweverChunksOverlapAndSmallTheCache) {
  std::mt19937 random(testing::Seed());
  std::vector<std::uint64_t> times(300);
  for (std::uint64_t& time : times) time = random() % 2000;
  WriteFile(times);
  std::vector<Note> expected;
  for (std::uint32_t i = 0; i < times.size(); ++i) expected.push_back({times[i], i});
  std::stable_sort(expected.begin(), expected.end(),
                   [](const Note& a, const Note& b) { return a.log_time < b.log_time; });
  for (const std::size_t cache_bytes : {std::size_t{1}, std::size_t{5000}, std::size_t{1} << 20}) {
    const auto contents = Read(disk_->bytes, cache_bytes);
    ASSERT_TRUE(contents);
    EXPECT_EQ(contents->notes, expected) << cache_bytes;
  }
}

TEST_F(McapTest, SeekGoesToTheFirstMessageAtOrAfterATime) {
  WriteFile({10, 50, 200, 210, 400, 401});
  const MemorySource source(disk_->bytes);
  const auto index = ReadFileIndex(source);
  ASSERT_TRUE(index);
  MessageStream stream(source, *index);
  for (const auto& [time, first] : {std::pair<std::uint64_t, std::uint64_t>{0, 10},
                                    {10, 10},
                                    {11, 50},
                                    {205, 210},
                                    {401, 401}}) {
    stream.Seek(time);
    const auto message = stream.Next();
    ASSERT_TRUE(message && *message);
    EXPECT_EQ((*message)->log_time, first);
  }
  stream.Seek(402);
  const auto end = stream.Next();
  ASSERT_TRUE(end);
  EXPECT_FALSE(*end);
}

TEST_F(McapTest, MessagesOutsideChunksAreRead) {
  Bytes bytes(kMagic.begin(), kMagic.end());
  Append(Header{}, bytes);
  Append(Schema{.id = 1, .name = "Note", .encoding = "protobuf", .data = ""}, bytes);
  Append(Channel{.id = 7, .schema_id = 1, .topic = "/note", .message_encoding = "", .metadata = {}},
         bytes);
  for (std::uint32_t i = 0; i < 5; ++i) {
    const Bytes data = ToBytes(i);
    Append(
        Message{
            .channel_id = 7, .sequence = i, .log_time = 50 - i, .publish_time = 0, .data = data},
        bytes);
  }
  const auto contents = Read(bytes);
  ASSERT_TRUE(contents);
  EXPECT_EQ(contents->notes, (std::vector<Note>{{46, 4}, {47, 3}, {48, 2}, {49, 1}, {50, 0}}));
  EXPECT_EQ(contents->index.message_counts.at(7), 5U);
}

void AppendUnknownRecord(Bytes& bytes) {
  bytes.insert(bytes.end(), {0x7E, 3, 0, 0, 0, 0, 0, 0, 0, 'n', 'e', 'w'});
}

TEST_F(McapTest, F47UnknownRecordsAndProfilesAreIgnored) {
  Bytes records;
  Append(Channel{.id = 1, .schema_id = 0, .topic = "/n", .message_encoding = "", .metadata = {}},
         records);
  AppendUnknownRecord(records);
  const Bytes data = ToBytes(9);
  Append(Message{.channel_id = 1, .sequence = 0, .log_time = 5, .publish_time = 5, .data = data},
         records);
  Bytes bytes(kMagic.begin(), kMagic.end());
  Append(Header{.profile = "x-of-the-future", .library = ""}, bytes);
  AppendUnknownRecord(bytes);
  Append(ChunkHeader{.start = 5,
                     .end = 5,
                     .uncompressed_size = records.size(),
                     .uncompressed_crc = 0,
                     .compression = "",
                     .compressed_size = records.size()},
         records, bytes);
  AppendUnknownRecord(bytes);
  const auto contents = Read(bytes);
  ASSERT_TRUE(contents);
  EXPECT_EQ(contents->notes, (std::vector<Note>{{5, 9}}));
  EXPECT_EQ(contents->index.header.profile, "x-of-the-future");
  EXPECT_EQ(contents->index.bytes_ignored, 0U);
}

Status OpenStatus(Bytes bytes) {
  const MemorySource source(std::move(bytes));
  const auto index = ReadFileIndex(source);
  return index ? OkStatus() : index.error();
}

TEST_F(McapTest, F47AnotherMajorVersionIsRefusedInWords) {
  WriteFile({1});
  Bytes newer = disk_->bytes;
  newer[5] = '1';
  const Status status = OpenStatus(newer);
  EXPECT_EQ(status.code(), StatusCode::kFailedPrecondition);
  EXPECT_THAT(status.message(), HasSubstr("version '1'"));
}

TEST_F(McapTest, OtherFilesAreRefusedInWords) {
  EXPECT_THAT(OpenStatus({}).message(), HasSubstr("not an MCAP file"));
  EXPECT_THAT(OpenStatus(Bytes(100, 'x')).message(), HasSubstr("not an MCAP file"));
  Bytes only_magic(kMagic.begin(), kMagic.end());
  EXPECT_EQ(OpenStatus(only_magic).code(), StatusCode::kDataLoss);
}

TEST_F(McapTest, UnsupportedCompressionIsRefusedWhenTheFileIsOpened) {
  Bytes bytes(kMagic.begin(), kMagic.end());
  Append(Header{}, bytes);
  const Bytes records(10, 1);
  Append(ChunkHeader{.start = 0,
                     .end = 0,
                     .uncompressed_size = 50,
                     .uncompressed_crc = 0,
                     .compression = "lz4",
                     .compressed_size = records.size()},
         records, bytes);
  const Status status = OpenStatus(bytes);
  EXPECT_EQ(status.code(), StatusCode::kFailedPrecondition);
  EXPECT_THAT(status.message(), HasSubstr("lz4"));
}

TEST_F(McapTest, ChunkThatClaimsTooMuchIsRefusedBeforeAllocating) {
  Bytes bytes(kMagic.begin(), kMagic.end());
  Append(Header{}, bytes);
  const Bytes records(10, 1);
  Append(ChunkHeader{.start = 0,
                     .end = 0,
                     .uncompressed_size = 1ULL << 60,
                     .uncompressed_crc = 0,
                     .compression = "zstd",
                     .compressed_size = records.size()},
         records, bytes);
  const auto contents = Read(bytes);
  ASSERT_TRUE(contents);
  EXPECT_TRUE(contents->notes.empty());
  EXPECT_GT(contents->index.bytes_ignored, 0U);
}

TEST_F(McapTest, TooLargeMessageIsRefusedAndTheFileGoesOn) {
  auto writer = MakeWriter();
  const Bytes large(Writer::kMaxMessageBytes + 1);
  EXPECT_EQ(writer->WriteMessage(channel_, 1, 1, large).code(), StatusCode::kInvalidArgument);
  EXPECT_TRUE(writer->WriteMessage(channel_, 2, 2, ToBytes(2)).ok());
  EXPECT_TRUE(writer->Close().ok());
  EXPECT_EQ(Read(disk_->bytes)->notes.size(), 1U);
}

}  // namespace
}  // namespace isotherm::mcap
