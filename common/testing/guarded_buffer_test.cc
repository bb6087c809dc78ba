#include "common/testing/guarded_buffer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <string_view>
#include <vector>

namespace isotherm::testing {
namespace {

/// The byte at `index`, which may lie outside; really read.
std::uint8_t ByteAt(const GuardedBuffer& buffer, std::size_t index) {
  return std::atomic_ref(buffer.bytes().data()[index]).load();
}

TEST(GuardedBufferTest, HoldsTheBytesWhateverTheirNumber) {
  for (const std::size_t size : {0U, 1U, 7U, 4095U, 4096U, 4097U, 70'000U}) {
    std::vector<std::uint8_t> bytes(size);
    for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::uint8_t>(i * 31);
    const GuardedBuffer buffer(bytes);
    ASSERT_EQ(buffer.bytes().size(), size);
    EXPECT_TRUE(std::equal(bytes.begin(), bytes.end(), buffer.bytes().begin()));
  }
  EXPECT_EQ(GuardedBuffer(std::string_view("a text")).text(), "a text");
}

TEST(GuardedBufferTest, ReadingOneByteBeyondEndsTheProcess) {
  for (const std::size_t size : {0U, 5U, 4096U}) {
    const GuardedBuffer buffer(std::vector<std::uint8_t>(size, 1));
    EXPECT_DEATH(static_cast<void>(ByteAt(buffer, size)), "") << size;
  }
}

}  // namespace
}  // namespace isotherm::testing
