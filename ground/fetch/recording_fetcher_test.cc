#include "ground/fetch/recording_fetcher.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>
#include <fstream>
#include <iterator>
#include <map>
#include <random>

#include "common/recording/mcap_records.h"
#include "common/testing/temporary_directory.h"
#include "common/testing/test_seed.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

constexpr const char* kName = "edge-20231114-221320-0123abcd.mcap";

/// A rig with recordings in memory, behind a link in virtual time that loses, doubles, reorders and
/// damages.
class FakeRig final : public RecordingWay {
 public:
  explicit FakeRig(FakeClock& clock) : clock_(clock), random_(testing::Seed()) {}

  Status Ask(const RecordingRequest& request) override {
    if (!IsLost()) answers_.push_back(AnswerTo(request));
    if (Draw() < doubled && !answers_.empty()) answers_.push_back(answers_.back());
    return OkStatus();
  }
  std::vector<RecordingPiece> Await(Nanoseconds timeout) override {
    clock_.Advance(timeout);
    std::vector<RecordingPiece> arrived;
    std::ranges::shuffle(answers_, random_);
    for (; !answers_.empty() && answers_left > 0; answers_.pop_front()) {
      if (IsLost()) continue;
      --answers_left;
      arrived.push_back(std::move(answers_.front()));
      if (Draw() < damaged && !arrived.back().bytes.empty()) arrived.back().bytes[0] ^= 1U;
    }
    return arrived;
  }

  std::vector<std::pair<std::string, std::vector<std::uint8_t>>> recordings;
  std::map<std::string, std::uint64_t> kept;  ///< Holds the sizes that the rig was told of.
  double loss = 0.0, doubled = 0.0, damaged = 0.0;
  std::uint64_t answers_left = UINT64_MAX;  ///< Then it is silent.
  int busy_for = 0;                         ///< Requests.
  bool is_being_written = false;
  std::uint64_t bytes_read = 0;

 private:
  double Draw() { return std::uniform_real_distribution(0.0, 1.0)(random_); }
  bool IsLost() { return Draw() < loss; }
  RecordingPiece AnswerTo(const RecordingRequest& request) {
    RecordingPiece piece{.asker = request.asker,
                         .number = request.number,
                         .recording = request.recording,
                         .offset = request.offset};
    if (request.kind == RecordingRequestKind::kList) {
      if (request.offset >= recordings.size()) {
        piece.outcome = RecordingOutcome::kNotThere;
        return piece;
      }
      piece.recording = recordings[static_cast<std::size_t>(request.offset)].first;
      piece.size = recordings[static_cast<std::size_t>(request.offset)].second.size();
      if (is_being_written) piece.outcome = RecordingOutcome::kBeingWritten;
      return piece;
    }
    if (busy_for > 0) {
      --busy_for;
      piece.outcome = RecordingOutcome::kBusy;
      return piece;
    }
    const auto found = std::ranges::find(recordings, request.recording,
                                         [](const auto& recording) { return recording.first; });
    if (found == recordings.end()) {
      piece.outcome = RecordingOutcome::kNotThere;
      return piece;
    }
    const std::vector<std::uint8_t>& all = found->second;
    piece.size = all.size();
    if (request.kind == RecordingRequestKind::kKept) {
      kept.emplace(request.recording, request.offset);
      return piece;
    }
    if (request.offset + request.length > all.size()) {
      piece.outcome = RecordingOutcome::kUnreadable;
      return piece;
    }
    const auto begin = all.begin() + static_cast<long>(request.offset);
    piece.bytes.assign(begin, begin + request.length);
    piece.crc = mcap::Crc32(piece.bytes);
    if (request.kind == RecordingRequestKind::kChecksum) {
      piece.bytes.clear();
    } else {
      bytes_read += request.length;
    }
    return piece;
  }

  FakeClock& clock_;
  std::mt19937 random_;
  std::deque<RecordingPiece> answers_;
};

class RecordingFetcherTest : public ::testing::Test {
 protected:
  RecordingFetcherTest() {
    std::mt19937 random(1);
    bytes_.resize(9'000'123);  // Three checksums, the last one short.
    for (std::uint8_t& byte : bytes_) byte = static_cast<std::uint8_t>(random());
    rig_.recordings = {{kName, bytes_}};
  }

  RecordingFetcher Make() {
    RecordingFetcher::Options options;
    options.on_busy = [this] { ++busy_; };
    return {rig_, clock_, 42, options};
  }
  Status Fetch() {
    RecordingFetcher fetcher = Make();
    const Result<std::vector<RemoteRecording>> list = fetcher.List();
    if (!list) return list.error();
    if (list->empty()) return NotFound("nothing is listed");
    return fetcher.Fetch(list->front(), folder_.path(),
                         [this](std::uint64_t bytes) { progress_ = bytes; });
  }
  std::filesystem::path File() const { return folder_.path() / kName; }
  std::filesystem::path Part() const { return File().string() + ".part"; }
  static std::vector<std::uint8_t> Get(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }
  static void Put(const std::filesystem::path& path, const std::vector<std::uint8_t>& bytes) {
    std::ofstream file(path, std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  }
  void ExpectWhole() const {
    EXPECT_TRUE(Get(File()) == bytes_);
    EXPECT_FALSE(std::filesystem::exists(Part()));
  }

  FakeClock clock_{CaptureTime(1'700'000'000s)};
  FakeRig rig_{clock_};
  std::vector<std::uint8_t> bytes_;
  const testing::TemporaryDirectory folder_;
  std::uint64_t progress_ = 0;
  int busy_ = 0;
};

TEST_F(RecordingFetcherTest, BringsARecordingOverALinkThatLosesDoublesReordersAndDamages) {
  rig_.loss = 0.15;
  rig_.doubled = 0.2;
  rig_.damaged = 0.05;
  const Status fetched = Fetch();
  ASSERT_TRUE(fetched.ok()) << fetched.message();
  ExpectWhole();
  EXPECT_EQ(progress_, bytes_.size());
}

TEST_F(RecordingFetcherTest, GoesOnWhereAnAttemptHasEnded) {
  rig_.answers_left = 200;
  EXPECT_EQ(Fetch().code(), StatusCode::kUnavailable);
  EXPECT_FALSE(std::filesystem::exists(File()));
  ASSERT_TRUE(std::filesystem::exists(Part()));
  const std::uint64_t before = rig_.bytes_read;
  EXPECT_GT(before, 6'000'000U);
  rig_.answers_left = UINT64_MAX;
  ASSERT_TRUE(Fetch().ok());
  ExpectWhole();
  EXPECT_LE(rig_.bytes_read - before, bytes_.size() - 4'000'000) << "what was there is there";
}

TEST_F(RecordingFetcherTest, WhatIsDamagedHereIsFetchedAgain) {
  std::vector<std::uint8_t> damaged = bytes_;
  damaged.resize(8'800'000);
  damaged[5'000'000] ^= 1U;
  Put(Part(), damaged);
  ASSERT_TRUE(Fetch().ok());
  ExpectWhole();
  EXPECT_LT(rig_.bytes_read, 5'000'000U);
  std::filesystem::remove(File());
  damaged.assign(10'000'000, 0);  // Longer than the recording.
  Put(Part(), damaged);
  ASSERT_TRUE(Fetch().ok());
  ExpectWhole();
}

TEST_F(RecordingFetcherTest, AFileThatIsThereIsNotFetchedAgainAndAnotherOneIsLeftAlone) {
  Put(File(), bytes_);
  ASSERT_TRUE(Fetch().ok());
  EXPECT_EQ(rig_.bytes_read, 0U);
  std::vector<std::uint8_t> other = bytes_;
  other[8'999'999] ^= 1U;
  Put(File(), other);
  EXPECT_EQ(Fetch().code(), StatusCode::kInvalidArgument);
  EXPECT_TRUE(Get(File()) == other);
  Put(File(), {1, 2, 3});
  EXPECT_EQ(Fetch().code(), StatusCode::kInvalidArgument);
}

TEST_F(RecordingFetcherTest, ARigThatScansIsWaitedFor) {
  rig_.busy_for = 40;
  ASSERT_TRUE(Fetch().ok());
  ExpectWhole();
  EXPECT_GT(busy_, 0);
}

TEST_F(RecordingFetcherTest, ARecordingThatGrowsOrHasChangedIsNotTaken) {
  rig_.is_being_written = true;
  EXPECT_THAT(Fetch().message(), HasSubstr("end the scan first"));
  rig_.is_being_written = false;
  RecordingFetcher fetcher = Make();
  const RemoteRecording before = fetcher.List().value().at(0);
  rig_.recordings[0].second.resize(100);
  const Status changed = fetcher.Fetch(before, folder_.path(), [](std::uint64_t) {});
  EXPECT_THAT(changed.message(), HasSubstr("has changed on the rig"));
  rig_.recordings.clear();
  EXPECT_EQ(fetcher.Fetch(before, folder_.path(), [](std::uint64_t) {}).code(),
            StatusCode::kNotFound);
  EXPECT_FALSE(std::filesystem::exists(File()));
}

TEST_F(RecordingFetcherTest, ARecordingWithoutAByteIsFetchedToo) {
  rig_.recordings = {{kName, {}}};
  ASSERT_TRUE(Fetch().ok());
  EXPECT_EQ(std::filesystem::file_size(File()), 0U);
}

TEST_F(RecordingFetcherTest, ListsAllInTheirOrder) {
  rig_.recordings.clear();
  EXPECT_TRUE(Make().List().value().empty());
  for (int i = 0; i < 100; ++i)
    rig_.recordings.emplace_back(std::to_string(i) + ".mcap", std::vector<std::uint8_t>(1));
  rig_.loss = 0.2;
  const std::vector<RemoteRecording> list = Make().List().value();
  ASSERT_EQ(list.size(), 100U);
  for (int i = 0; i < 100; ++i)
    EXPECT_EQ(list[static_cast<std::size_t>(i)].name, std::to_string(i) + ".mcap");
  rig_.answers_left = 0;
  EXPECT_EQ(Make().List().error().code(), StatusCode::kUnavailable);
}

TEST_F(RecordingFetcherTest, ANameThatLeadsElsewhereIsNotTaken) {
  rig_.recordings.clear();
  for (const char* name : {"../x.mcap", "/tmp/x.mcap", "..", "", "a/b.mcap", ".bashrc"})
    rig_.recordings.emplace_back(name, std::vector<std::uint8_t>(1));
  EXPECT_TRUE(Make().List().value().empty());
  for (const auto& [name, bytes] : rig_.recordings) {
    const Status refused = Make().Fetch({name, 1}, folder_.path(), [](std::uint64_t) {});
    EXPECT_EQ(refused.code(), StatusCode::kInvalidArgument) << name;
  }
}

TEST_F(RecordingFetcherTest, TheRigIsToldWhatIsKept) {
  rig_.busy_for = 1;
  RecordingFetcher fetcher = Make();
  EXPECT_TRUE(fetcher.TellKept({.name = kName, .size = bytes_.size()}).ok());
  EXPECT_EQ(rig_.kept.at(kName), bytes_.size());
  EXPECT_EQ(fetcher.TellKept({.name = kName, .size = 5}).code(), StatusCode::kFailedPrecondition)
      << "it is another one by now";
  EXPECT_EQ(fetcher.TellKept({.name = "gone.mcap", .size = 5}).code(), StatusCode::kNotFound);
}

}  // namespace
}  // namespace isotherm
