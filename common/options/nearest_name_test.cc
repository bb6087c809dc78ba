#include "common/options/nearest_name.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace isotherm {
namespace {

TEST(NearestNameTest, FindsTypingErrorsOnly) {
  const std::vector<std::string> names{"depth.txt", "thermal.txt", "rig.textproto"};
  EXPECT_EQ(NearestName("dpeth.txt", names), "depth.txt");
  EXPECT_EQ(NearestName("Depth.TXT", names), "depth.txt");
  EXPECT_EQ(NearestName("velocity", names), "");
  EXPECT_EQ(NearestName("", names), "");
}

}  // namespace
}  // namespace isotherm
