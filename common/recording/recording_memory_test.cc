// Memory while reading and writing recordings much larger than what may be used, as the kernel
// counts it for the process: a program of its own.
#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "common/recording/testing/recording_data.h"
#include "common/testing/sanitizers.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using testing::kScanStart;
using testing::MakeDepth;

constexpr int kFrames = 400;
constexpr std::size_t kChunkBytes = 1U << 20;
/// The chunk packed and unpacked, its neighbour, the frame in several stages, the test's own
/// frames, and as much again that the allocator keeps in between.
constexpr std::size_t kAllowedBytes = 20 * kChunkBytes;
constexpr std::uint64_t kMinFileBytes = 60U << 20;

/// "VmRSS", what the process has in memory, or "VmHWM", the most that it had.
std::size_t ResidentBytes(std::string_view key) {
  std::ifstream status("/proc/self/status");
  for (std::string name; status >> name; status.ignore(1000, '\n')) {
    if (!name.starts_with(key)) continue;
    std::size_t kilobytes = 0;
    status >> kilobytes;
    return kilobytes << 10;
  }
  ADD_FAILURE() << "the kernel does not say " << key;
  return 0;
}

std::size_t PeakDuring(const auto& work) {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";  // From here on counts what is the most.
  const std::size_t before = ResidentBytes("VmRSS");
  work();
  return std::max(ResidentBytes("VmHWM"), before) - before;
}

class RecordingMemoryTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (testing::kAddressSanitizer || testing::kThreadSanitizer)
      GTEST_SKIP() << "a sanitizer's own memory would count";
    std::string pattern =
        (std::filesystem::temp_directory_path() / "recording_memory_XXXXXX").string();
    ASSERT_NE(::mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
    path_ = folder_ / "large.mcap";
  }
  void TearDown() override {
    if (!folder_.empty()) std::filesystem::remove_all(folder_);
  }

  void WriteLargeFile() {
    auto writer = RecordingWriter::Create(path_, {.chunk_bytes = kChunkBytes, .sync = false});
    ASSERT_TRUE(writer) << writer.error().message();
    for (int i = 0; i < kFrames; ++i) {
      const CaptureTime time = kScanStart + Nanoseconds(33'333'333LL * i);
      const auto frame = MakeDepth(static_cast<std::uint64_t>(i), time, 320, 256);
      ASSERT_TRUE((*writer)->Write(frame, std::nullopt).ok());
    }
    ASSERT_TRUE((*writer)->Close().ok());
    ASSERT_GT(std::filesystem::file_size(path_), kMinFileBytes);
  }

  int CountItems() {
    auto reader = RecordingReader::Open(path_);
    EXPECT_TRUE(reader);
    int items = 0;
    while (true) {
      const auto item = (*reader)->Next();
      EXPECT_TRUE(item);
      if (!item || !*item) return items;
      ++items;
    }
  }

  std::filesystem::path folder_;
  std::filesystem::path path_;
};

TEST_F(RecordingMemoryTest, WhatIsMeasuredIsWhatIsUsedInBetween) {
  constexpr std::size_t kBytes = 100U << 20;
  EXPECT_GT(PeakDuring([] { EXPECT_EQ(std::vector<char>(kBytes, 'x').back(), 'x'); }),
            kBytes - kChunkBytes);
  EXPECT_LT(PeakDuring([] {}), kChunkBytes);
}

TEST_F(RecordingMemoryTest, F46FileMuchLargerThanMemoryIsWrittenReadSoughtAndRebuilt) {
  EXPECT_LT(PeakDuring([this] { WriteLargeFile(); }), kAllowedBytes);
  int items = 0;
  EXPECT_LT(PeakDuring([&] { items = CountItems(); }), kAllowedBytes);
  EXPECT_EQ(items, kFrames);

  EXPECT_LT(PeakDuring([this] {
              auto reader = RecordingReader::Open(path_);
              ASSERT_TRUE((*reader)->Seek(kScanStart + 10s).ok());
              const auto item = (*reader)->Next();
              ASSERT_TRUE(item && *item);
              EXPECT_GE(testing::TimeOf(**item), kScanStart + 10s);
            }),
            kAllowedBytes);

  std::filesystem::resize_file(path_, std::filesystem::file_size(path_) - 100);  // No summary now.
  EXPECT_LT(PeakDuring([&] { items = CountItems(); }), kAllowedBytes);
  EXPECT_EQ(items, kFrames);
}

}  // namespace
}  // namespace isotherm
