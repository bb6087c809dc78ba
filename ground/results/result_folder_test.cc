#include "ground/results/result_folder.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "common/options/text_proto.h"
#include "common/testing/temporary_directory.h"
#include "ground/json/message_json.h"

namespace isotherm {
namespace {

class ResultFolderTest : public ::testing::Test {
 protected:
  std::optional<GroundOptions> ConfigurationIn(const std::string& stats) const {
    std::ofstream(folder_.path() / "stats.json") << stats;
    return ConfigurationOf(folder_.path());
  }
  static GroundOptions Options() {
    GroundOptions options;
    options.mutable_volume()->set_voxel_size_m(0.0037);
    return options;
  }

  const testing::TemporaryDirectory folder_;
};

TEST_F(ResultFolderTest, TheConfigurationIsReadFromItsObject) {
  Json stats;
  stats["frames"]["depth"]["in"] = 300;
  stats["configuration"] = ToJson(Options());
  const std::optional<GroundOptions> read = ConfigurationIn(JsonText(stats));
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(ToTextProto(*read), ToTextProto(Options()));
}

TEST_F(ResultFolderTest, TheConfigurationOfAnOlderVersionIsTextInAString) {
  Json stats;
  stats["configuration"] = ToTextProto(Options());
  const std::optional<GroundOptions> read = ConfigurationIn(JsonText(stats));
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->volume().voxel_size_m(), 0.0037);
}

TEST_F(ResultFolderTest, WhatAnOlderVersionWroteIsReadByThePresentNames) {
  const std::optional<GroundOptions> read = ConfigurationIn(R"({"configuration": {
      "volume": {"size_x_m": 2.0, "min_x_m": -1.0, "initial_pose": ""},
      "renderer": {"shading": false, "isotherms": "", "palette": "IRON"},
      "thermal": {"distance_good_m": 0.5, "smear_max_px": 1.5, "near_range_m": 0.2, "lens": {}},
      "tracker": {"external_odometry": {"max_turn_deg_s": 90.0, "T_depth_body": ""}}}})");
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->volume().size_x_m(), 2.0);
  EXPECT_EQ(read->volume().expert().min_x_m(), -1.0);
  EXPECT_FALSE(read->volume().expert().has_initial_pose());
  EXPECT_EQ(read->renderer().palette(), IRON);
  EXPECT_FALSE(read->renderer().expert().shading());
  EXPECT_EQ(read->renderer().isotherm_size(), 0);
  EXPECT_EQ(read->thermal().distance().good_m(), 0.5);
  EXPECT_EQ(read->thermal().expert().motion().smear_max_px(), 1.5);
  EXPECT_EQ(read->tracker().external_odometry().expert().max_rotation_deg_s(), 90.0);
  EXPECT_FALSE(read->tracker().external_odometry().has_t_depth_body());
}

TEST_F(ResultFolderTest, TheLinesOfAnOlderVersionAreReadByThePresentNames) {
  Json stats;
  stats["configuration"] =
      "volume {\n  voxel_size_m: 0.003\n  initial_pose: \"\"\n}\nrenderer {\n  palette: IRON\n"
      "  shading: false\n}\nfeedback {\n  advise_share: 0.25\n}\nthreads: 3\n";
  const std::optional<GroundOptions> read = ConfigurationIn(JsonText(stats));
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->volume().voxel_size_m(), 0.003);
  EXPECT_EQ(read->renderer().palette(), IRON);
  EXPECT_FALSE(read->renderer().expert().shading());
  EXPECT_EQ(read->feedback().expert().advise_fraction(), 0.25);
  EXPECT_EQ(read->threads(), 3);
}

TEST_F(ResultFolderTest, WhatIsNotUnderstoodIsNoConfiguration) {
  EXPECT_FALSE(ConfigurationOf(folder_.path()).has_value());
  for (const char* text : {"", "{", "[1, 2]", "{}", R"({"configuration": 7})",
                           R"({"configuration": {"voxels_of_tomorrow": 1}})",
                           R"({"configuration": {"threads": 1e999}})"}) {
    EXPECT_FALSE(ConfigurationIn(text).has_value()) << text;
  }
}

TEST_F(ResultFolderTest, NestingWithoutEndIsNoConfiguration) {
  constexpr std::size_t kLevels = 400'000;
  const std::string open(kLevels, '[');
  const std::string close(kLevels, ']');
  EXPECT_FALSE(ConfigurationIn(R"({"configuration": {"threads": )" + open + close + "}}"));
}

}  // namespace
}  // namespace isotherm
