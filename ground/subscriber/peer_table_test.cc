#include "ground/subscriber/peer_table.h"

#include <gtest/gtest.h>

#include <map>

namespace isotherm {
namespace {

constexpr PeerHandle kRig = 100;
constexpr PeerHandle kOther = 200;

/// Knows only the writers that are there, as the middleware does.
struct FakeReader {
  PeerHandle PeerOf(std::uint64_t writer) const {
    const auto found = writers.find(writer);
    return found == writers.end() ? 0 : found->second;
  }
  std::map<std::uint64_t, PeerHandle> writers;
};

class PeerTableTest : public ::testing::Test {
 protected:
  FakeReader depth_;
  FakeReader status_;
  PeerTable peers_;
};

TEST_F(PeerTableTest, AWriterThatHasLeftIsStillKnown) {
  depth_.writers = {{1, kRig}};
  EXPECT_EQ(peers_.Identify(depth_, 1), kRig);
  depth_.writers.clear();
  EXPECT_EQ(peers_.Identify(depth_, 1), kRig) << "its last samples come after it";
}

TEST_F(PeerTableTest, WhoLeftBeforeItWasSeenIsNobodyUntilTheMiddlewareKnowsIt) {
  EXPECT_EQ(peers_.Identify(depth_, 1), 0U);
  depth_.writers = {{1, kRig}};
  EXPECT_EQ(peers_.Identify(depth_, 1), kRig);
}

TEST_F(PeerTableTest, AProcessIsPresentAsLongAsOneOfItsWritersIs) {
  depth_.writers = {{1, kRig}};
  status_.writers = {{2, kRig}, {3, kOther}};
  EXPECT_FALSE(peers_.IsPresent(kRig)) << "nothing of it was seen";
  peers_.Identify(depth_, 1);
  peers_.Identify(status_, 2);
  peers_.Identify(status_, 3);
  depth_.writers.clear();
  EXPECT_TRUE(peers_.IsPresent(kRig));
  status_.writers = {{3, kOther}};
  EXPECT_FALSE(peers_.IsPresent(kRig));
  EXPECT_TRUE(peers_.IsPresent(kOther));
}

TEST_F(PeerTableTest, WhenItIsFullTheGoneMakeRoomAndTheLivingDoNot) {
  const std::uint64_t max = PeerTable::kMaxWriters;
  for (std::uint64_t writer = 1; writer <= max + 1; ++writer)
    depth_.writers[writer] = 1000 + writer;
  for (std::uint64_t writer = 1; writer <= max; ++writer) {
    ASSERT_EQ(peers_.Identify(depth_, writer), 1000 + writer);
  }
  EXPECT_EQ(peers_.Identify(depth_, max + 1), 0U) << "all of them are there";
  EXPECT_EQ(peers_.Identify(depth_, 1), 1001U);
  depth_.writers.erase(2);
  EXPECT_EQ(peers_.Identify(depth_, max + 1), 1000 + max + 1);
  EXPECT_EQ(peers_.Identify(depth_, 2), 0U) << "it is forgotten";
}

}  // namespace
}  // namespace isotherm
