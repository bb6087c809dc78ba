#include "common/config/renamed_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <utility>

#include "common/config/text_proto.h"
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
                                        "'follows_orders' now."));
}

TEST(RenamedOptionsTest, AnOldNameOnTheCommandLineFailsWithTheNewOne) {
  SimulationOptions options;
  const Status set = ApplyOverride("shutter.tells=false", options);
  ASSERT_FALSE(set.ok());
  EXPECT_THAT(set.message(), HasSubstr("It is called 'reports_shutter' now."));
  EXPECT_TRUE(ApplyOverride("shutter.reports_shutter=false", options).ok());
  EXPECT_FALSE(options.shutter().reports_shutter());
}

TEST(RenamedOptionsTest, OnlyTheMessageThatHadTheNameKnowsItsNewOne) {
  EXPECT_EQ(NameSinceRenaming(*ShutterOptions::descriptor(), "tells"), "reports_shutter");
  EXPECT_EQ(NameSinceRenaming(*ClockOptions::descriptor(), "tells"), "");
  EXPECT_EQ(NameSinceRenaming(*ShutterOptions::descriptor(), "interval_s"), "");
}

TEST(RenamedOptionsTest, WhatAnOlderProgramWroteDownIsReadWithThePresentNames) {
  SimulationOptions before;
  before.mutable_shutter()->set_reports_shutter(false);
  before.mutable_depth_clock()->set_impulse_fraction(0.25);
  std::string text = ToTextProto(before);
  for (const auto& [now, old] :
       {std::pair{"reports_shutter", "tells"}, std::pair{"impulse_fraction", "impulse_share"}}) {
    for (auto at = text.find(now); at != std::string::npos; at = text.find(now, at + 1))
      text.replace(at, std::string_view(now).size(), old);
  }
  SimulationOptions after;
  ASSERT_FALSE(ParseTextProto(text, "stats.json", after).ok());
  const Status read = ParseTextProto(WithPresentNames(text), "stats.json", after);
  ASSERT_TRUE(read.ok()) << read.message();
  EXPECT_EQ(ToTextProto(after), ToTextProto(before));
}

}  // namespace
}  // namespace isotherm
