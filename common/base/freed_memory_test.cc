#include "common/base/freed_memory.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <memory>
#include <vector>

#include "common/testing/resident_memory.h"
#include "common/testing/sanitizers.h"

namespace isotherm {
namespace {

using std::chrono::seconds;

long Resident_kb() { return testing::ResidentMemory_kb(getpid()); }

TEST(FreedMemoryTest, WhatWasNeededOnceIsGivenBackWhenItIsDue) {
  if (testing::kAddressSanitizer || testing::kThreadSanitizer)
    GTEST_SKIP() << "sanitizers have an allocator of their own";
  constexpr std::size_t kBlockBytes = 100'000;  // Too small to be mapped by itself.
  constexpr int kBlocks = 400;
  constexpr long kBlocks_kb = kBlockBytes * kBlocks / 1024;
  const std::chrono::steady_clock::time_point start;
  FreedMemory freed;
  freed.GiveBackIfDue(start);
  std::vector<std::unique_ptr<std::vector<char>>> blocks(kBlocks);
  for (auto& block : blocks) block = std::make_unique<std::vector<char>>(kBlockBytes, 'x');
  const long full_kb = Resident_kb();
  // The last one stays, so that the heap's end cannot move back.
  for (int i = 0; i + 1 < kBlocks; ++i) blocks[static_cast<std::size_t>(i)].reset();
  freed.GiveBackIfDue(start + seconds(9));
  EXPECT_GT(Resident_kb(), full_kb - kBlocks_kb / 10) << "kept for later";
  freed.GiveBackIfDue(start + seconds(10));
  EXPECT_LT(Resident_kb(), full_kb - kBlocks_kb * 9 / 10);
}

}  // namespace
}  // namespace isotherm
