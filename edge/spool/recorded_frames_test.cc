#include "edge/spool/recorded_frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <vector>

#include "common/testing/test_seed.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr CaptureTime kStart{1'700'000'000s};
CaptureTime TimeOf(std::uint64_t number) { return kStart + 25ms * number; }

std::set<std::uint64_t> Numbers(const std::vector<FrameRange>& ranges) {
  std::set<std::uint64_t> numbers;
  for (const FrameRange& range : ranges) {
    for (std::uint64_t number = range.first; number <= range.last; ++number) numbers.insert(number);
  }
  return numbers;
}

TEST(RecordedFramesTest, KnowsWhichOfTheWantedFramesAreRecorded) {
  std::mt19937 random(testing::Seed());
  for (int round = 0; round < 200; ++round) {
    RecordedFrames recorded;
    recorded.BeginFile("scan.mcap");
    std::set<std::uint64_t> truth;
    for (std::uint64_t number = 0; number < 200; ++number) {
      if (random() % 4 == 0) continue;
      recorded.Add(Sensor::kThermal, number, TimeOf(number));
      truth.insert(number);
    }
    std::vector<FrameRange> wanted;
    for (std::uint64_t first = random() % 9; first < 230;) {
      const std::uint64_t last = first + random() % 20;
      wanted.push_back({first, last});
      first = last + 2 + random() % 20;
    }
    std::set<std::uint64_t> both;
    for (const std::uint64_t number : Numbers(wanted)) {
      if (truth.contains(number)) both.insert(number);
    }
    const std::vector<FrameRange> found = recorded.Of(Sensor::kThermal, wanted);
    ASSERT_EQ(Numbers(found), both);
    ASSERT_TRUE(std::ranges::is_sorted(found, {}, &FrameRange::first));
    ASSERT_THAT(recorded.Of(Sensor::kDepth, wanted), IsEmpty());
    // What cannot be read after all.
    const FrameRange gone{random() % 200, 200};
    recorded.Forget(Sensor::kThermal, gone);
    std::erase_if(both, [&](auto number) { return number >= gone.first && number <= gone.last; });
    ASSERT_EQ(Numbers(recorded.Of(Sensor::kThermal, wanted)), both);
  }
}

TEST(RecordedFramesTest, APlaceIsBeforeItsFrameAndInTheSameFile) {
  RecordedFrames recorded;
  recorded.BeginFile("scan.mcap");
  for (std::uint64_t number = 10; number < 110; ++number)
    recorded.Add(Sensor::kDepth, number, TimeOf(number));
  recorded.BeginFile("scan-2.mcap");
  for (std::uint64_t number = 120; number < 200; ++number)
    recorded.Add(Sensor::kDepth, number, TimeOf(number));
  EXPECT_EQ(recorded.PlaceOf(Sensor::kDepth, 9), std::nullopt);
  for (const std::uint64_t number : {10, 60, 109, 120, 121, 199}) {
    const auto place = recorded.PlaceOf(Sensor::kDepth, number);
    ASSERT_TRUE(place.has_value());
    EXPECT_EQ(place->file, number < 120 ? "scan.mcap" : "scan-2.mcap");
    EXPECT_LE(place->time, TimeOf(number));
    EXPECT_GT(place->time, TimeOf(number) - 1s);
  }
}

TEST(RecordedFramesTest, TheRestOfAFileThatBrokeOffIsForgottenButNotThatOfTheNewest) {
  RecordedFrames recorded;
  recorded.BeginFile("scan.mcap");
  for (std::uint64_t number = 0; number < 100; ++number)
    recorded.Add(Sensor::kDepth, number, TimeOf(number));
  const std::vector<FrameRange> all = {{0, 1000}};
  recorded.ForgetRest(Sensor::kDepth, 90, "scan.mcap");
  EXPECT_THAT(recorded.Of(Sensor::kDepth, all), ElementsAre(FrameRange{0, 99}))
      << "it may not be on the disk yet";
  recorded.BeginFile("scan-2.mcap");
  for (std::uint64_t number = 100; number < 150; ++number)
    recorded.Add(Sensor::kDepth, number, TimeOf(number));
  recorded.ForgetRest(Sensor::kDepth, 90, "scan.mcap");
  EXPECT_THAT(recorded.Of(Sensor::kDepth, all),
              ElementsAre(FrameRange{0, 89}, FrameRange{100, 149}));
}

TEST(RecordedFramesTest, AFileThatCannotBeOpenedIsForgottenAndTheOthersAreNot) {
  RecordedFrames recorded;
  for (const auto& [file, first] :
       {std::pair("scan.mcap", 0), std::pair("scan-2.mcap", 100), std::pair("scan-3.mcap", 200)}) {
    recorded.BeginFile(file);
    for (std::uint64_t number = first; number < first + 100U; ++number)
      recorded.Add(Sensor::kDepth, number, TimeOf(number));
  }
  recorded.ForgetAll(Sensor::kDepth, "scan-2.mcap");
  const std::vector<FrameRange> all = {{0, 1000}};
  EXPECT_THAT(recorded.Of(Sensor::kDepth, all),
              ElementsAre(FrameRange{0, 99}, FrameRange{200, 299}));
  recorded.ForgetAll(Sensor::kDepth, "scan-3.mcap");
  recorded.Add(Sensor::kDepth, 300, TimeOf(300));
  EXPECT_THAT(recorded.Of(Sensor::kDepth, all),
              ElementsAre(FrameRange{0, 99}, FrameRange{300, 300}))
      << "what follows is known";
}

TEST(RecordedFramesTest, OfADeletedFileItIsKnownWhichFramesItHad) {
  RecordedFrames recorded;
  for (const auto& [file, first] :
       {std::pair("scan.mcap", 0), std::pair("scan-2.mcap", 100), std::pair("scan-3.mcap", 200)}) {
    recorded.BeginFile(file);
    for (std::uint64_t number = first; number < first + 90U; ++number)
      recorded.Add(Sensor::kDepth, number, TimeOf(number));
  }
  const std::vector<FrameRange> wanted = {{50, 249}};
  recorded.DeleteUpTo("elsewhere.mcap");
  EXPECT_THAT(recorded.DeletedOf(Sensor::kDepth, wanted), IsEmpty());
  EXPECT_TRUE(recorded.HasFile("scan.mcap"));
  // The first file went without a word.
  recorded.DeleteUpTo("scan-2.mcap");
  EXPECT_FALSE(recorded.HasFile("scan.mcap"));
  EXPECT_THAT(recorded.DeletedOf(Sensor::kDepth, wanted),
              ElementsAre(FrameRange{50, 89}, FrameRange{100, 189}));
  EXPECT_THAT(recorded.Of(Sensor::kDepth, wanted), ElementsAre(FrameRange{200, 249}));
  EXPECT_EQ(recorded.PlaceOf(Sensor::kDepth, 189), std::nullopt);
  EXPECT_EQ(recorded.PlaceOf(Sensor::kDepth, 210)->file, "scan-3.mcap");
  recorded.DeleteUpTo("scan-3.mcap");
  recorded.BeginFile("scan-4.mcap");
  recorded.Add(Sensor::kDepth, 100, TimeOf(100));
  EXPECT_THAT(recorded.Of(Sensor::kDepth, wanted), IsEmpty()) << "numbers rise";
  recorded.Add(Sensor::kDepth, 290, TimeOf(290));
  EXPECT_EQ(recorded.PlaceOf(Sensor::kDepth, 290)->file, "scan-4.mcap");
}

TEST(RecordedFramesTest, ACameraThatComesLateKeepsItsFramesWhenFilesBeforeItAreDeleted) {
  RecordedFrames recorded;
  recorded.BeginFile("scan.mcap");
  recorded.Add(Sensor::kDepth, 0, TimeOf(0));
  recorded.BeginFile("scan-2.mcap");
  recorded.Add(Sensor::kDepth, 1, TimeOf(1));
  recorded.Add(Sensor::kThermal, 0, TimeOf(1));
  recorded.DeleteUpTo("scan.mcap");
  const std::vector<FrameRange> all = {{0, 1000}};
  EXPECT_THAT(recorded.Of(Sensor::kThermal, all), ElementsAre(FrameRange{0, 0}));
  EXPECT_THAT(recorded.DeletedOf(Sensor::kThermal, all), IsEmpty());
  EXPECT_THAT(recorded.DeletedOf(Sensor::kDepth, all), ElementsAre(FrameRange{0, 0}));
}

TEST(RecordedFramesTest, LongScansAndManyGapsTakeBoundedMemory) {
  RecordedFrames recorded;
  recorded.BeginFile("scan.mcap");
  // Ten hours at 40 Hz.
  constexpr std::uint64_t kFrames = 1'440'000;
  for (std::uint64_t number = 0; number < kFrames; ++number)
    recorded.Add(Sensor::kDepth, number, TimeOf(number));
  for (const std::uint64_t number : {std::uint64_t{0}, kFrames / 3, kFrames - 1}) {
    const auto place = recorded.PlaceOf(Sensor::kDepth, number);
    ASSERT_TRUE(place.has_value());
    EXPECT_LE(place->time, TimeOf(number));
    EXPECT_GT(place->time, TimeOf(number) - 60s) << "to be read through";
  }
  // Every second frame is missing: the oldest are forgotten, the newest known.
  constexpr std::uint64_t kGaps = 3 * RecordedFrames::kMaxRuns;
  for (std::uint64_t gap = 0; gap < kGaps; ++gap)
    recorded.Add(Sensor::kThermal, 2 * gap, TimeOf(gap));
  const auto known = recorded.Of(Sensor::kThermal, {{0, 2 * kGaps}});
  EXPECT_LE(known.size(), RecordedFrames::kMaxRuns);
  EXPECT_GE(known.size(), RecordedFrames::kMaxRuns / 2);
  EXPECT_EQ(known.back().last, 2 * (kGaps - 1));
}

TEST(RecordedFramesTest, FilesThatAreDeletedTakeNoMemory) {
  RecordedFrames recorded;
  constexpr std::uint64_t kFiles = 20'000;
  for (std::uint64_t number = 0; number < kFiles; ++number) {
    recorded.BeginFile(std::to_string(number));
    // Frames in between are lost, so that each is a run of its own.
    recorded.Add(Sensor::kDepth, 2 * number, TimeOf(number));
    if (number >= 8) recorded.DeleteUpTo(std::to_string(number - 8));
  }
  EXPECT_EQ(recorded.Of(Sensor::kDepth, {{0, 2 * kFiles}}).size(), 8U);
  const auto deleted = recorded.DeletedOf(Sensor::kDepth, {{0, 2 * kFiles}});
  EXPECT_LE(deleted.size(), RecordedFrames::kMaxRuns);
  EXPECT_GE(deleted.size(), RecordedFrames::kMaxRuns / 2);
  EXPECT_EQ(deleted.front().first, 0U) << "what is gone is not forgotten";
  EXPECT_EQ(recorded.PlaceOf(Sensor::kDepth, 2 * (kFiles - 1))->file, std::to_string(kFiles - 1));
}

}  // namespace
}  // namespace isotherm
