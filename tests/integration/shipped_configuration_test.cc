#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "common/options/text_proto.h"
#include "common/rig/rig_calibration.h"
#include "edge/daemon/validate_options.h"
#include "edge/options/edge_options.pb.h"
#include "ground/experiment/nuc_drift_experiment.h"
#include "ground/option_validation/validate_options.h"
#include "ground/options/ground_options.pb.h"
#include "ground/thermal/uncertainty_budget.h"

namespace isotherm {
namespace {

const std::filesystem::path kDeploy = std::filesystem::path(ISOTHERM_SOURCE_DIR) / "deploy";

std::string ReadAll(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

TEST(ShippedConfigurationTest, TheGroundFileLoadsAndValidates) {
  GroundOptions options;
  const Status loaded = LoadTextProto(kDeploy / "ground.textproto", options);
  ASSERT_TRUE(loaded.ok()) << loaded.message();
  for (const Status& problem : ValidateAll(options)) ADD_FAILURE() << problem.message();
}

TEST(ShippedConfigurationTest, TheEdgeFileLoadsAndValidates) {
  EdgeOptions options;
  const Status loaded = LoadTextProto(kDeploy / "edge.textproto", options);
  ASSERT_TRUE(loaded.ok()) << loaded.message();
  EXPECT_THAT(ValidateAll(options), ::testing::IsEmpty());
}

TEST(ShippedConfigurationTest, EdgeAndGroundMeetOnTheLink) {
  EdgeOptions edge;
  GroundOptions ground;
  ASSERT_TRUE(LoadTextProto(kDeploy / "edge.textproto", edge).ok());
  ASSERT_TRUE(LoadTextProto(kDeploy / "ground.textproto", ground).ok());
  EXPECT_EQ(edge.link().domain(), ground.live().domain());
  // The rig has its computer's name; the ground follows whatever rig it meets.
  EXPECT_EQ(edge.link().edge_id(), "");
  EXPECT_EQ(ground.live().edge_id(), "");
}

TEST(ShippedConfigurationTest, TheRigStartsItsCameras) {
  EdgeOptions edge;
  ASSERT_TRUE(LoadTextProto(kDeploy / "edge.textproto", edge).ok());
  EXPECT_EQ(edge.source().kind(), CAMERAS);
}

/// A file that is not named in a test above is not tested: this fails when one is added.
TEST(ShippedConfigurationTest, NoShippedFileIsForgotten) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(kDeploy)) {
    if (entry.path().extension() == ".textproto") names.push_back(entry.path().filename().string());
  }
  EXPECT_THAT(names, ::testing::UnorderedElementsAre("edge.textproto", "ground.textproto"));
}

TEST(ShippedConfigurationTest, TheDriftExperimentCorrectsTheCameraAsTheEdgeDoes) {
  EdgeOptions options;
  EXPECT_EQ(options.nuc().expert().max_housing_drift_k(), kShippedHousingDrift_k) << "by default";
  ASSERT_TRUE(LoadTextProto(kDeploy / "edge.textproto", options).ok());
  EXPECT_EQ(options.nuc().expert().max_housing_drift_k(), kShippedHousingDrift_k)
      << "in the shipped file";
}

TEST(ShippedConfigurationTest, UncertaintiesTakeACameraForWarmWhenTheEdgeDoes) {
  EdgeOptions options;
  EXPECT_EQ(options.nuc().expert().warm_up_housing_rate_k_per_min(), kWarmHousingRate_k_per_min)
      << "by default";
  ASSERT_TRUE(LoadTextProto(kDeploy / "edge.textproto", options).ok());
  EXPECT_EQ(options.nuc().expert().warm_up_housing_rate_k_per_min(), kWarmHousingRate_k_per_min)
      << "in the shipped file";
}

TEST(ShippedConfigurationTest, TheDefaultsAreValid) {
  EXPECT_THAT(ValidateAll(GroundOptions()), ::testing::IsEmpty());
  EXPECT_THAT(ValidateAll(EdgeOptions()), ::testing::IsEmpty());
}

TEST(ShippedConfigurationTest, TheCalibrationInTheDocumentsIsValid) {
  const std::string page = ReadAll(std::filesystem::path(ISOTHERM_SOURCE_DIR) / "docs/data.md");
  const std::size_t begin = page.find("# rig.textproto");
  ASSERT_NE(begin, std::string::npos);
  const Result<Rig> rig =
      ParseRigCalibration(page.substr(begin, page.find("```", begin) - begin), "docs/data.md");
  ASSERT_TRUE(rig.has_value()) << rig.error().message();
  EXPECT_TRUE(CheckThermalFusion(*rig).ok());
}

}  // namespace
}  // namespace isotherm
