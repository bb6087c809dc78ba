#include "edge/daemon/rig_name.h"

#include <gtest/gtest.h>

#include <string>

namespace isotherm {
namespace {

TEST(RigNameTest, IsTheHostNameWithoutItsDomain) {
  EXPECT_EQ(RigNameOf("drone-7"), "drone-7");
  EXPECT_EQ(RigNameOf("drone-7.field.example"), "drone-7");
}

TEST(RigNameTest, IsANameThatTheLinkTakes) {
  EXPECT_EQ(RigNameOf("my rig\xc3\xa9"), "my-rig--");
  EXPECT_EQ(RigNameOf(std::string(80, 'x')), std::string(32, 'x'));
  EXPECT_EQ(RigNameOf(""), "edge");
  EXPECT_EQ(RigNameOf(".example"), "edge");
}

}  // namespace
}  // namespace isotherm
