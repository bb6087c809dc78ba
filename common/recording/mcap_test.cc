#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "common/recording/testing/mcap_notes.h"
#include "common/testing/test_seed.h"

namespace isotherm::mcap {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

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
  Bytes bytes = Beginning();
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
  ChunkHeader header = HeaderOf(records);
  header.start = header.end = 5;
  Append(header, records, bytes);
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
  Bytes bytes = Beginning();
  const Bytes records(10, 1);
  ChunkHeader header = HeaderOf(records);
  header.uncompressed_size = 50;
  header.compression = "lz4";
  Append(header, records, bytes);
  const Status status = OpenStatus(bytes);
  EXPECT_EQ(status.code(), StatusCode::kFailedPrecondition);
  EXPECT_THAT(status.message(), HasSubstr("lz4"));
}

TEST_F(McapTest, ChunkThatClaimsTooMuchIsRefusedBeforeAllocating) {
  Bytes bytes = Beginning();
  const Bytes records(10, 1);
  ChunkHeader header = HeaderOf(records);
  header.uncompressed_size = 1ULL << 60;
  header.compression = "zstd";
  Append(header, records, bytes);
  const auto contents = Read(bytes);
  ASSERT_TRUE(contents);
  EXPECT_TRUE(contents->notes.empty());
  EXPECT_GT(contents->index.bytes_ignored, 0U);
}

TEST_F(McapTest, F65AChunkOfTooManyMessagesIsRefused) {
  Bytes records;
  for (std::size_t i = 0; i <= kMaxChunkMessages; ++i) Append(Message{}, records);
  Bytes bytes = Beginning();
  Append(HeaderOf(records), records, bytes);
  const auto contents = Read(bytes);
  ASSERT_TRUE(contents);
  EXPECT_TRUE(contents->notes.empty());
  EXPECT_GT(contents->index.bytes_ignored, records.size());
}

TEST_F(McapTest, F65DefinitionsAndMetadataBeyondTheirLimitsAreLeftOut) {
  constexpr std::size_t kEachBytes = 900'000;
  const std::string text(kEachBytes, 'x');
  Bytes bytes = Beginning();
  for (SchemaId id = 1; id <= 20; ++id)
    Append(Schema{.id = id, .name = "s", .encoding = "", .data = text}, bytes);
  for (int i = 0; i < 6; ++i) Append(Metadata{.name = "m", .values = {{"k", text}}}, bytes);
  const auto contents = Read(bytes);
  ASSERT_TRUE(contents);
  EXPECT_EQ(contents->index.definitions.schemas.size(), kMaxDefinitionsBytes / kEachBytes);
  EXPECT_EQ(contents->index.metadata.size(), kMaxMetadataBytes / kEachBytes);
}

TEST_F(McapTest, F65MetadataThatASummaryListsOftenIsReadOnce) {
  Bytes bytes = Beginning();
  const std::uint64_t offset = bytes.size();
  Append(Metadata{.name = "m", .values = {{"k", std::string(1'000'000, 'x')}}}, bytes);
  const std::uint64_t length = bytes.size() - offset;
  Append(DataEnd{}, bytes);
  const std::uint64_t summary = bytes.size();
  Statistics statistics;
  statistics.metadata_count = 10;
  Append(statistics, bytes);
  for (int i = 0; i < 10; ++i)
    Append(MetadataIndex{.offset = offset, .length = length, .name = "m"}, bytes);
  Append(Footer{.summary_start = summary}, bytes);
  bytes.insert(bytes.end(), kMagic.begin(), kMagic.end());
  const auto contents = Read(bytes);
  ASSERT_TRUE(contents);
  EXPECT_EQ(contents->index.metadata.size(), 1U);
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
