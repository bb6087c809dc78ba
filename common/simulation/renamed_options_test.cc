#include "common/options/renamed_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "common/options/override.h"
#include "common/options/text_proto.h"
#include "common/simulation/simulation_options.pb.h"

namespace isotherm {
namespace {

using ::testing::HasSubstr;

TEST(RenamedOptionsTest, AnOldNameInAFileFailsWithTheNewOne) {
  SimulationOptions options;
  const Status read = ParseTextProto(
      "depth_clock { impulse_share: 0.1 }\nshutter { obeys: false }\n", "old.textproto", options);
  ASSERT_FALSE(read.ok());
  EXPECT_THAT(read.message(), HasSubstr("old.textproto:1:15: unknown field 'impulse_share'. It is "
                                        "called 'impulse_fraction' now."));
  EXPECT_THAT(read.message(), HasSubstr("old.textproto:2:11: unknown field 'obeys'. It is called "
                                        "'expert.follows_orders' now."));
}

TEST(RenamedOptionsTest, AnOldNameOnTheCommandLineFailsWithTheNewOne) {
  SimulationOptions options;
  const Status set = ApplyOverride("shutter.tells=false", options);
  ASSERT_FALSE(set.ok());
  EXPECT_THAT(set.message(), HasSubstr("It is called 'shutter.expert.reports_shutter' now."));
  EXPECT_TRUE(ApplyOverride("shutter.expert.reports_shutter=false", options).ok());
  EXPECT_FALSE(options.shutter().expert().reports_shutter());
}

TEST(RenamedOptionsTest, OldNamesAreFoundWhereverTheyStand) {
  SimulationOptions options;
  const Status read = ParseTextProto(
      "# tells: 1\nscene < hot_celsius: -5 >;\nshutter: { tells: -1.5 interval_s: 1\n"
      "obeys: false }\nrig_file: 'tells: 1'\ndepth_clock { impulse_share: 1 nonsense { tells: 1 } "
      "}",
      "old", options);
  ASSERT_FALSE(read.ok());
  for (const char* place :
       {"old:3:12: unknown field 'tells'", "old:4:1: unknown field 'obeys'",
        "old:6:15: unknown field 'impulse_share'", "old:6:32: unknown field 'nonsense'"}) {
    EXPECT_THAT(read.message(), HasSubstr(place));
  }
  EXPECT_EQ(std::ranges::count(read.message(), '\n'), 3) << read.message();
}

TEST(RenamedOptionsTest, OnlyTheMessageThatHadTheNameKnowsItsNewOne) {
  ASSERT_NE(FindRenamed(*ShutterOptions::descriptor(), "tells"), nullptr);
  EXPECT_EQ(FindRenamed(*ShutterOptions::descriptor(), "tells")->now, "expert.reports_shutter");
  EXPECT_EQ(FindRenamed(*ClockOptions::descriptor(), "tells"), nullptr);
  EXPECT_EQ(FindRenamed(*ShutterOptions::descriptor(), "interval_s"), nullptr);
}

}  // namespace
}  // namespace isotherm
