#include "edge/recording_server/recording_shelf.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "common/recording/byte_stream.h"
#include "common/testing/temporary_directory.h"
#include "edge/spool/older_recordings.h"

namespace isotherm {
namespace {

/// CRC-32 of "123456789" as every description of it says.
constexpr std::uint32_t kKnownCrc = 0xCBF43926;

/// A folder as an edge leaves it, and other things in it.
class RecordingShelfTest : public ::testing::Test {
 protected:
  void Put(const std::string& name, const std::string& text) const {
    std::ofstream(folder_.path() / name) << text;
  }
  RecordingPiece Ask(RecordingRequestKind kind, const std::string& name, std::uint64_t offset,
                     std::uint32_t length) {
    return shelf_.Answer({.asker = 5,
                          .number = 6,
                          .kind = kind,
                          .recording = name,
                          .offset = offset,
                          .length = length});
  }
  RecordingPiece Read(const std::string& name, std::uint64_t offset, std::uint32_t length) {
    return Ask(RecordingRequestKind::kRead, name, offset, length);
  }

  const testing::TemporaryDirectory folder_;
  const std::string name_ = "edge-20231114-221320-0123abcd.mcap";
  RecordingShelf shelf_{folder_.path()};
};

TEST_F(RecordingShelfTest, ListsWhatTheEdgeHasWrittenAndNothingElse) {
  Put(name_, "123456789");
  Put("edge-20231114-221320-0123abcd-2.mcap", "12");
  Put("notes.mcap", "x");
  Put("edge-20231114-221320-0123abcd.txt", "x");
  std::filesystem::create_symlink("/etc/passwd",
                                  folder_.path() / "edge-20231114-221321-0123abcd.mcap");
  std::filesystem::last_write_time(
      folder_.path() / name_,
      std::filesystem::file_time_type::clock::now() + std::chrono::hours(1));
  const RecordingPiece first = Ask(RecordingRequestKind::kList, "", 0, 0);
  EXPECT_EQ(first.outcome, RecordingOutcome::kDone);
  EXPECT_EQ(first.recording, name_) << "it was written last";
  EXPECT_EQ(first.size, 9U);
  EXPECT_EQ(first.asker, 5U);
  EXPECT_EQ(first.number, 6U);
  EXPECT_EQ(Ask(RecordingRequestKind::kList, "", 1, 0).size, 2U);
  EXPECT_EQ(Ask(RecordingRequestKind::kList, "", 2, 0).outcome, RecordingOutcome::kNotThere);
}

TEST_F(RecordingShelfTest, GivesBytesWithTheirChecksumAndTheChecksumAlone) {
  Put(name_, "0123456789");
  const RecordingPiece piece = Read(name_, 1, 9);
  EXPECT_EQ(piece.outcome, RecordingOutcome::kDone);
  EXPECT_EQ(std::string(piece.bytes.begin(), piece.bytes.end()), "123456789");
  EXPECT_EQ(piece.crc, kKnownCrc);
  EXPECT_EQ(piece.size, 10U);
  const RecordingPiece checksum = Ask(RecordingRequestKind::kChecksum, name_, 1, 9);
  EXPECT_EQ(checksum.crc, kKnownCrc);
  EXPECT_TRUE(checksum.bytes.empty());
  for (const auto& [offset, length] : {std::pair(2, 9), std::pair(11, 0)})
    EXPECT_EQ(Read(name_, offset, length).outcome, RecordingOutcome::kUnreadable);
}

TEST_F(RecordingShelfTest, NothingOutsideIsGivenWhateverIsAskedFor) {
  const testing::TemporaryDirectory other;
  std::ofstream(other.path() / name_) << "secret";
  Put(name_, "123456789");
  const std::string outside = other.path() / name_;
  for (const std::string& name :
       {outside, "../" + other.path().filename().string() + "/" + name_, std::string("/etc/passwd"),
        std::string(".."), std::string(), "./" + name_}) {
    EXPECT_EQ(Read(name, 0, 1).outcome, RecordingOutcome::kNotThere) << name;
  }
}

TEST_F(RecordingShelfTest, ARecordingThatGrowsIsListedOnly) {
  const auto sink = CreateFileSink(folder_.path() / name_);
  ASSERT_TRUE(sink);
  EXPECT_EQ(Ask(RecordingRequestKind::kList, "", 0, 0).outcome, RecordingOutcome::kBeingWritten);
  EXPECT_EQ(Read(name_, 0, 0).outcome, RecordingOutcome::kBeingWritten);
  ASSERT_TRUE((*sink)->Close().ok());
  EXPECT_EQ(Read(name_, 0, 0).outcome, RecordingOutcome::kDone);
}

TEST_F(RecordingShelfTest, ARecordingWithANameOfItsOwnIsThereWithItsParts) {
  Put("door.mcap", "1");
  Put("door-2.mcap", "22");
  Put("door-x.mcap", "x");
  Put("other.mcap", "x");
  RecordingShelf shelf(folder_.path() / "door.mcap");
  std::uint64_t bytes = 0;
  RecordingPiece piece;
  std::uint64_t entries = 0;
  while (true) {
    piece = shelf.Answer({.offset = entries});
    if (piece.outcome != RecordingOutcome::kDone) break;
    bytes += piece.size;
    ++entries;
  }
  EXPECT_EQ(entries, 2U);
  EXPECT_EQ(bytes, 3U);
}

TEST_F(RecordingShelfTest, WhoHasTheWholeRecordingIsBelieved) {
  Put(name_, "123456789");
  const auto kept = [this](const std::string& name, std::uint64_t size) {
    return Ask(RecordingRequestKind::kKept, name, size, 0).outcome;
  };
  EXPECT_EQ(kept(name_, 8), RecordingOutcome::kUnreadable) << "it has nine bytes";
  EXPECT_FALSE(IsFetched(folder_.path() / name_));
  EXPECT_EQ(kept("../" + name_, 9), RecordingOutcome::kNotThere);
  EXPECT_EQ(kept(name_, 9), RecordingOutcome::kDone);
  EXPECT_TRUE(IsFetched(folder_.path() / name_));
  EXPECT_EQ(kept(name_, 9), RecordingOutcome::kDone);
  EXPECT_EQ(Ask(RecordingRequestKind::kList, "", 1, 0).outcome, RecordingOutcome::kNotThere)
      << "the note is no recording";
}

}  // namespace
}  // namespace isotherm
