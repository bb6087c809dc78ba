// Memory while reading and writing recordings much larger than what may be used. Counts what
// operator new hands out, so it is a program of its own.
#include <gtest/gtest.h>
#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <new>

#include "common/recording/recording_test_data.h"

namespace {

std::atomic<std::size_t> used_bytes{0};
std::atomic<std::size_t> peak_bytes{0};

void* Allocate(std::size_t size) {
  void* const memory = std::malloc(size);
  if (memory == nullptr) throw std::bad_alloc();
  const std::size_t used = used_bytes += malloc_usable_size(memory);
  std::size_t peak = peak_bytes;
  while (used > peak && !peak_bytes.compare_exchange_weak(peak, used)) {
  }
  return memory;
}

void Free(void* memory) noexcept {
  if (memory != nullptr) used_bytes -= malloc_usable_size(memory);
  std::free(memory);
}

}  // namespace

void* operator new(std::size_t size) { return Allocate(size); }
void* operator new[](std::size_t size) { return Allocate(size); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return Allocate(size); }
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept { return Allocate(size); }
void operator delete(void* memory) noexcept { Free(memory); }
void operator delete[](void* memory) noexcept { Free(memory); }
void operator delete(void* memory, std::size_t) noexcept { Free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { Free(memory); }

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using testing::kScanStart;
using testing::MakeDepth;

constexpr int kFrames = 400;
constexpr std::size_t kChunkBytes = 1U << 20;
/// The chunk packed and unpacked, its neighbour, the frame in several stages, and the test's own
/// frames.
constexpr std::size_t kAllowedBytes = 10 * kChunkBytes;
constexpr std::uint64_t kLeastFileBytes = 60U << 20;

std::size_t PeakDuring(const auto& work) {
  const std::size_t before = used_bytes;
  peak_bytes = before;
  work();
  return peak_bytes - before;
}

class RecordingMemoryTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern =
        (std::filesystem::temp_directory_path() / "recording_memory_XXXXXX").string();
    ASSERT_NE(::mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
    path_ = folder_ / "large.mcap";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  void WriteLargeFile() {
    auto writer = RecordingWriter::Create(path_, {.chunk_bytes = kChunkBytes, .sync = false});
    ASSERT_TRUE(writer) << writer.error().message();
    for (int i = 0; i < kFrames; ++i) {
      const CaptureTime time = kScanStart + Nanoseconds(33'333'333LL * i);
      const auto frame = MakeDepth(static_cast<std::uint64_t>(i), time, 320, 256);
      ASSERT_TRUE((*writer)->Write(frame, std::nullopt).ok());
    }
    ASSERT_TRUE((*writer)->Close().ok());
    ASSERT_GT(std::filesystem::file_size(path_), kLeastFileBytes);
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
