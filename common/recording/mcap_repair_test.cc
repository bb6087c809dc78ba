#include "common/recording/mcap_repair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "common/recording/recording_parts.h"
#include "common/recording/testing/mcap_notes.h"
#include "common/testing/temporary_directory.h"

namespace isotherm::mcap {
namespace {

using ::testing::HasSubstr;

/// A file on the disk, as a writer left it.
class McapRepairTest : public McapTest {
 protected:
  void Put(const Bytes& bytes) const {
    std::ofstream file(path_, std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  }
  Bytes Get() const {
    std::ifstream file(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }

  const ::isotherm::testing::TemporaryDirectory folder_;
  const std::filesystem::path path_ = folder_.path() / "scan.mcap";
};

TEST_F(McapRepairTest, AFileThatWasNotClosedBecomesTheFileThatClosingWouldHaveMade) {
  WriteFile({10, 50, 200, 210, 400, 401, 402, 600}, /*close=*/false);
  Put(unfinished_);
  const auto cut = CompleteFile(path_);
  ASSERT_TRUE(cut) << cut.error().message();
  EXPECT_EQ(*cut, 0U);
  Bytes expected = disk_->bytes;
  // The checksum over all data is left out: the file would have to be read for it.
  const auto crc = expected.begin() + static_cast<long>(unfinished_.size() + kRecordPrefixBytes);
  std::fill(crc, crc + 4, 0);
  EXPECT_EQ(Get(), expected);
}

TEST_F(McapRepairTest, EveryTruncationIsCompletedUpToItsLastWholeChunk) {
  WriteFile({10, 50, 200, 210, 400, 401, 402, 600});
  const Bytes whole = disk_->bytes;
  int completed = 0;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const Bytes torn(whole.begin(), whole.begin() + static_cast<long>(size));
    const auto before = Read(torn);
    Put(torn);
    const auto cut = CompleteFile(path_);
    if (!before || before->index.segments.empty()) {
      ASSERT_FALSE(cut) << size;
      ASSERT_EQ(Get(), torn);
      continue;
    }
    ASSERT_TRUE(cut) << size << ": " << cut.error().message();
    const auto after = Read(Get());
    ASSERT_TRUE(after && after->index.complete) << size;
    ASSERT_EQ(after->index.bytes_ignored, 0U) << size;
    ASSERT_EQ(after->notes, before->notes) << size;
    ASSERT_EQ(after->index.message_counts, before->index.message_counts) << size;
    ASSERT_EQ(after->index.metadata.size(), before->index.metadata.size()) << size;
    ++completed;
  }
  EXPECT_GT(completed, 500);
}

TEST_F(McapRepairTest, MetadataBehindTheLastChunkIsKept) {
  auto writer = MakeWriter();
  ASSERT_TRUE(writer->WriteMessage(channel_, 10, 10, ToBytes(1)).ok());
  ASSERT_TRUE(writer->Flush().ok());
  ASSERT_TRUE(writer->WriteMetadata({.name = "late", .values = {{"a", "b"}}}).ok());
  Bytes torn = disk_->bytes;
  torn.insert(torn.end(), 100, 0xAB);
  Put(torn);
  const auto cut = CompleteFile(path_);
  ASSERT_TRUE(cut) << cut.error().message();
  EXPECT_EQ(*cut, 100U);
  const auto after = Read(Get());
  ASSERT_TRUE(after && after->index.complete);
  ASSERT_EQ(after->index.metadata.size(), 1U);
  EXPECT_EQ(after->index.metadata[0].name, "late");
}

TEST_F(McapRepairTest, ACompleteFileAndOneThatThisDoesNotHelpStayAsTheyAre) {
  WriteFile({10, 50, 200, 210, 400, 401}, /*close=*/false);
  Put(disk_->bytes);
  EXPECT_EQ(CompleteFile(path_).value(), std::nullopt);
  EXPECT_EQ(Get(), disk_->bytes);

  const auto complete = Read(unfinished_);
  ASSERT_TRUE(complete);
  Bytes damaged = unfinished_;
  damaged[static_cast<std::size_t>(complete->index.segments[1].offset) + 6] ^= 0x40;  // Its length.
  Put(damaged);
  const auto refused = CompleteFile(path_);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message(), HasSubstr("merge-recordings"));
  EXPECT_EQ(Get(), damaged);
  EXPECT_FALSE(CompleteFile(folder_.path() / "not-there.mcap"));
}

TEST_F(McapRepairTest, AFileThatIsBeingWrittenIsLeftAlone) {
  auto sink = CreateFileSink(path_);
  ASSERT_TRUE(sink);
  WriteFile({10, 50}, /*close=*/false);
  ASSERT_TRUE((*sink)->Write(unfinished_).ok());
  EXPECT_TRUE(IsBeingWritten(path_));
  const auto refused = CompleteFile(path_);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message(), HasSubstr("still being written"));
  EXPECT_EQ(Get(), unfinished_);
  ASSERT_TRUE((*sink)->Close().ok());
  EXPECT_FALSE(IsBeingWritten(path_));
  EXPECT_TRUE(CompleteFile(path_));
}

}  // namespace
}  // namespace isotherm::mcap
