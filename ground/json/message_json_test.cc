#include "ground/json/message_json.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "common/options/text_proto.h"
#include "common/rig/rig_calibration.h"
#include "common/rig/rig_calibration.pb.h"
#include "ground/options/ground_options.pb.h"
#include "ground/options/option_geometry.h"

namespace isotherm {
namespace {

TEST(MessageJsonTest, DefaultsEnumsAndNumbersAreWhatAReaderExpects) {
  GroundOptions options;
  options.set_threads(3);
  options.mutable_volume()->mutable_expert()->set_max_memory_bytes(1LL << 40);
  options.mutable_renderer()->set_scale(FIXED);
  const Json json = ToJson(options);
  EXPECT_EQ(json.at("threads"), 3);
  EXPECT_EQ(json.at("volume").at("expert").at("max_memory_bytes"), 1LL << 40);
  EXPECT_EQ(json.at("renderer").at("scale"), "FIXED");
  // Of a stage that nobody has touched.
  EXPECT_EQ(json.at("tsdf").at("expert").at("truncation_distance_m"),
            TsdfOptions::default_instance().expert().truncation_distance_m());
}

TEST(MessageJsonTest, OptionsReadBackAsTheyWere) {
  GroundOptions options;
  options.mutable_volume()->set_voxel_size_m(0.1 + 0.2);
  options.mutable_tracker()->mutable_external_odometry()->mutable_expert()->set_source(
      "0 0 \"1\"\n\t\\ 0");
  *options.mutable_volume()->mutable_expert()->mutable_initial_pose() =
      ToOptions(MakeTransform({0.1, 0.2, 1.0 / 3.0}, Eigen::Quaterniond(0.6, 0.8, 0, 0)));
  options.mutable_thermal()->mutable_expert()->set_max_footprint_m(
      std::numeric_limits<double>::infinity());
  GroundOptions read;
  const Status status = FromJson(Json::parse(JsonText(ToJson(options))), "stats.json", read);
  ASSERT_TRUE(status.ok()) << status.message();
  EXPECT_EQ(ToTextProto(read), ToTextProto(options));
}

TEST(MessageJsonTest, ACalibrationReadsBackAndWhatIsAbsentStaysAbsent) {
  CameraModel camera;
  camera.width = 382;
  camera.height = 288;
  camera.fx = camera.fy = 523.25;
  Rig rig;
  rig.thermal = camera;
  rig.T_thermal_depth = MakeTransform({0.02, 1.0 / 3.0, 0.0}, Eigen::Quaterniond(0.6, 0.8, 0, 0));
  const Json json = ToJson(ToProto(rig));
  EXPECT_EQ(json.at("thermal").at("fx"), 523.25);
  EXPECT_FALSE(json.contains("depth"));
  RigCalibration read;
  const Status status = FromJson(json, "stats.json", read);
  ASSERT_TRUE(status.ok()) << status.message();
  EXPECT_EQ(ToTextProto(read), ToTextProto(ToProto(rig)));
}

TEST(MessageJsonTest, AnUnknownFieldIsNamed) {
  GroundOptions options;
  const Status status = FromJson({{"thraeds", 3}}, "stats.json", options);
  ASSERT_FALSE(status.ok());
  EXPECT_TRUE(status.message().starts_with("stats.json: ")) << status.message();
  EXPECT_NE(status.message().find("thraeds"), std::string::npos) << status.message();
}

}  // namespace
}  // namespace isotherm
