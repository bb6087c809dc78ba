#include "edge/daemon/validate_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "common/options/text_proto.h"
#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

using testing::HasSubstr;

/// A line per problem.
std::string Problems(const EdgeOptions& options) {
  std::string text;
  for (const Status& problem : ValidateAll(options)) {
    EXPECT_EQ(problem.code(), StatusCode::kInvalidArgument);
    text += problem.message() + "\n";
  }
  return text;
}

TEST(ValidateEdgeOptionsTest, DefaultsAreValid) { EXPECT_EQ(Problems(EdgeOptions()), ""); }

TEST(ValidateEdgeOptionsTest, TheShippedFileLoadsAndIsValid) {
  EdgeOptions options;
  const Status loaded = LoadTextProto(ISOTHERM_SOURCE_DIR "/deploy/edge.textproto", options);
  ASSERT_TRUE(loaded.ok()) << loaded.message();
  EXPECT_EQ(Problems(options), "");
}

TEST(ValidateEdgeOptionsTest, F59AllProblemsAreListed) {
  EdgeOptions options;
  options.mutable_source()->set_rate(-1);
  options.mutable_timestamper()->mutable_expert()->set_depth_window(0);
  options.mutable_nuc()->mutable_expert()->set_settle_time_s(
      std::numeric_limits<double>::quiet_NaN());
  options.mutable_nuc()->mutable_expert()->set_min_interval_s(0);
  options.mutable_link()->set_domain(231);
  options.mutable_link()->set_edge_id("drone 1");
  const std::string problems = Problems(options);
  EXPECT_THAT(problems, HasSubstr("source.rate: is -1"));
  EXPECT_THAT(problems, HasSubstr("timestamper.expert.depth_window: is 0"));
  EXPECT_THAT(problems, HasSubstr("nuc.expert.settle_time_s: is nan"));
  EXPECT_THAT(problems, HasSubstr("nuc.expert.min_interval_s: is 0"));
  EXPECT_THAT(problems, HasSubstr("link.domain: is 231"));
  EXPECT_THAT(problems, HasSubstr("link.edge_id: is \"drone 1\""));
}

TEST(ValidateEdgeOptionsTest, WithoutANameItIsTheComputers) {
  EdgeOptions options;
  options.mutable_link()->set_edge_id("");
  EXPECT_EQ(Problems(options), "");
}

TEST(ValidateEdgeOptionsTest, ReplayNeedsARecording) {
  EdgeOptions options;
  options.mutable_source()->set_kind(REPLAY);
  EXPECT_THAT(Problems(options), HasSubstr("source.recording: is empty"));
  options.mutable_source()->set_recording("scan.mcap");
  EXPECT_EQ(Problems(options), "");
}

TEST(ValidateEdgeOptionsTest, MeasuringRangeHasTwoEndsInOrder) {
  EdgeOptions options;
  ThermalCameraOptions& camera = *options.mutable_source()->mutable_thermal_camera();
  camera.mutable_expert()->set_optris_min_celsius(100);
  EXPECT_THAT(Problems(options), HasSubstr("optris_max_celsius: is not set"));
  camera.mutable_expert()->set_optris_max_celsius(100);
  EXPECT_THAT(Problems(options), HasSubstr("must be above optris_min_celsius"));
  camera.mutable_expert()->set_optris_max_celsius(250);
  EXPECT_EQ(Problems(options), "");
  camera.mutable_expert()->set_optris_max_celsius(4000);
  EXPECT_THAT(
      Problems(options),
      HasSubstr("source.thermal_camera.expert.optris_max_celsius: temperatures from 100 to 4000"));
  camera.mutable_expert()->set_optris_max_celsius(900);
  EXPECT_EQ(Problems(options), "");
}

TEST(ValidateEdgeOptionsTest, PathsOfTheSandboxAreAbsolute) {
  EdgeOptions options;
  CameraSandboxOptions& sandbox = *options.mutable_source()->mutable_camera_sandbox();
  sandbox.mutable_expert()->add_read("/usr/share/vendor");
  EXPECT_EQ(Problems(options), "");
  sandbox.mutable_expert()->add_read("calibrations");
  EXPECT_THAT(Problems(options),
              HasSubstr("source.camera_sandbox.expert.read: names \"calibrations\""));
  sandbox.mutable_expert()->add_write("./log");
  EXPECT_THAT(Problems(options), HasSubstr("source.camera_sandbox.expert.write"));
}

TEST(ValidateEdgeOptionsTest, TemperatureLimitsMustBeInOrder) {
  EdgeOptions options;
  options.mutable_frame_check()->mutable_expert()->set_min_celsius(100);
  options.mutable_frame_check()->mutable_expert()->set_max_celsius(50);
  EXPECT_THAT(Problems(options), HasSubstr("must be above min_celsius, which is 100"));
}

TEST(ValidateEdgeOptionsTest, BoundariesAreIncluded) {
  EdgeOptions options;
  options.mutable_source()->set_rate(0);
  options.mutable_source()->set_loops(0);
  options.mutable_timestamper()->mutable_expert()->set_depth_window(1);
  options.mutable_link()->set_domain(230);
  options.mutable_nuc()->mutable_expert()->set_settle_time_s(0);
  EXPECT_EQ(Problems(options), "");
}

}  // namespace
}  // namespace isotherm
