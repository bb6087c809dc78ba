#include "common/transport/instance_limit.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

TEST(InstanceLimitTest, F62OneWriterHasSoManyNamesAndNoMore) {
  InstanceLimit limit;
  std::size_t admitted = 0;
  for (std::uint64_t instance = 0; instance < 1000; ++instance) {
    admitted += limit.Admit(1, instance) ? 1 : 0;
  }
  EXPECT_EQ(admitted, InstanceLimit::kPerWriter);
  EXPECT_TRUE(limit.Admit(1, 0)) << "one that it has already";
  EXPECT_TRUE(limit.Admit(2, 5000)) << "another writer is not its fault";
}

TEST(InstanceLimitTest, TwoWritersOfOneNameShareIt) {
  InstanceLimit limit;
  EXPECT_TRUE(limit.Admit(1, 77));
  EXPECT_TRUE(limit.Admit(2, 77));
}

TEST(InstanceLimitTest, ANameThatIsGoneLeavesRoom) {
  InstanceLimit limit;
  for (std::uint64_t instance = 0; instance < 1000; ++instance) {
    EXPECT_TRUE(limit.Admit(1, instance)) << "a writer that comes and goes with its link";
    limit.Forget(instance);
  }
}

TEST(InstanceLimitTest, F62ManyWritersAreBoundedToo) {
  InstanceLimit limit;
  std::size_t admitted = 0;
  for (std::uint64_t writer = 0; writer < 10'000; ++writer) {
    admitted += limit.Admit(writer, writer) ? 1 : 0;
  }
  EXPECT_EQ(admitted, InstanceLimit::kInAll);
}

}  // namespace
}  // namespace isotherm
