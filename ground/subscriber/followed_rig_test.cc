#include "ground/subscriber/followed_rig.h"

#include <gtest/gtest.h>

#include <array>
#include <barrier>
#include <thread>
#include <vector>

namespace isotherm {
namespace {

TEST(FollowedRigTest, AChosenRigIsTheOnlyOne) {
  FollowedRig followed("drone");
  EXPECT_EQ(followed.edge_id(), "drone") << "before it is seen";
  EXPECT_FALSE(followed.See("cart"));
  EXPECT_TRUE(followed.See("drone"));
  EXPECT_FALSE(followed.See("cart"));
  EXPECT_EQ(followed.edge_id(), "drone");
}

TEST(FollowedRigTest, WithoutAChoiceTheFirstThatIsSeenStaysIt) {
  FollowedRig followed("");
  EXPECT_EQ(followed.edge_id(), "");
  EXPECT_TRUE(followed.See("cart"));
  EXPECT_EQ(followed.edge_id(), "cart");
  EXPECT_FALSE(followed.See("drone"));
  EXPECT_TRUE(followed.See("cart"));
  EXPECT_EQ(followed.edge_id(), "cart");
}

TEST(FollowedRigTest, OfRigsThatAreSeenAtTheSameTimeExactlyOneIsFollowed) {
  constexpr std::size_t kRigs = 4;
  for (int round = 0; round < 50; ++round) {
    FollowedRig followed("");
    std::barrier start(kRigs);
    std::array<bool, kRigs> is_followed{};
    {
      std::vector<std::jthread> threads;
      for (std::size_t rig = 0; rig < kRigs; ++rig) {
        threads.emplace_back([&, rig] {
          start.arrive_and_wait();
          is_followed[rig] = followed.See(std::to_string(rig));
        });
      }
    }
    for (std::size_t rig = 0; rig < kRigs; ++rig) {
      EXPECT_EQ(is_followed[rig], followed.edge_id() == std::to_string(rig));
    }
  }
}

}  // namespace
}  // namespace isotherm
