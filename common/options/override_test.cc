#include "common/options/override.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/rig/rig_calibration.pb.h"

namespace isotherm {
namespace {

using testing::HasSubstr;

TEST(OverrideTest, SetsNestedNumbersAndStrings) {
  RigCalibration rig;
  ASSERT_TRUE(ApplyOverride("depth.width=320", rig).ok());
  ASSERT_TRUE(ApplyOverride("depth_scale=5e3", rig).ok());
  ASSERT_TRUE(ApplyOverride("serial=a = \"b\"", rig).ok());
  ASSERT_TRUE(ApplyOverride("method='quoted'", rig).ok());
  EXPECT_EQ(rig.depth().width(), 320);
  EXPECT_EQ(rig.depth_scale(), 5000.0);
  EXPECT_EQ(rig.serial(), "a = \"b\"");
  EXPECT_EQ(rig.method(), "quoted");
}

TEST(OverrideTest, RefusesWhatDoesNotExistAndNamesWhatDoes) {
  RigCalibration rig;
  EXPECT_THAT(ApplyOverride("depht.width=1", rig).message(), HasSubstr("Did you mean 'depth'?"));
  EXPECT_THAT(
      ApplyOverride("depth.widht=1", rig).message(),
      HasSubstr("no option 'widht' in 'depth'. Did you mean 'width'? Known: width, height, fx"));
  EXPECT_THAT(ApplyOverride("depth=1", rig).message(), HasSubstr("name one of its fields: width"));
  EXPECT_THAT(ApplyOverride("depth_scale.x=1", rig).message(), HasSubstr("single value"));
  EXPECT_THAT(ApplyOverride("depth_scale", rig).message(), HasSubstr("stage.field=value"));
  EXPECT_THAT(ApplyOverride("=1", rig).message(), HasSubstr("stage.field=value"));
  EXPECT_THAT(ApplyOverride(".=1", rig).message(), HasSubstr("no stage"));
}

TEST(OverrideTest, RefusesValuesOfTheWrongKindOrRange) {
  RigCalibration rig;
  EXPECT_THAT(ApplyOverride("depth.width=99999999999", rig).message(), HasSubstr("out of range"));
  EXPECT_THAT(ApplyOverride("depth.width=1.5", rig).message(), HasSubstr("not an integer"));
  EXPECT_THAT(ApplyOverride("depth_scale=1,5", rig).message(), HasSubstr("not a number"));
  EXPECT_THAT(ApplyOverride("depth_scale=", rig).message(), HasSubstr("not a number"));
  EXPECT_FALSE(rig.has_depth_scale());
}

}  // namespace
}  // namespace isotherm
