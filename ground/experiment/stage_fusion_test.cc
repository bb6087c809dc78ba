#include "ground/experiment/stage_fusion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "ground/experiment/corner_scene.h"
#include "ground/experiment/experiment_scan.h"
#include "ground/surface/depth_preprocessor.h"
#include "ground/thermal/thermal_options.h"

namespace isotherm {
namespace {

/// Half a second of a corner with a hot sphere, by the pipeline and by a stage that follows it.
class StageFusionTest : public ::testing::Test {
 protected:
  StageFusionTest() {
    scan_ = SimulatedScan::Create(
                ExperimentCameras(0.5, 0.6),
                CornerScene("corner",
                            {.back_wall = 30.0, .side_wall = 40.0, .floor = 35.0, .sphere = 70.0}))
                .value();
    pipeline_ = StartPipeline(GroundOptions(), *scan_, pool_).value();
  }

  /// The words of all thermal voxels.
  static std::vector<std::uint32_t> WordsOf(const ThermalVolume& thermal, const TsdfVolume& tsdf) {
    std::vector<std::uint32_t> words;
    for (std::int32_t block = 0; block < tsdf.block_count(); ++block) {
      for (const ThermalVoxel& voxel : thermal.voxels(block)) words.push_back(voxel.bits);
    }
    return words;
  }

  void Play(StageFusion& fusion) {
    DepthPreprocessor preprocessor(PreprocessorOptions(), *scan_->rig().depth,
                                   scan_->rig().depth_sensor);
    PlayScan(*scan_, pool_,
             {[&](const DepthFrame& frame) {
                pipeline_->ProcessDepth(frame);
                fusion.AfterDepth(preprocessor.Process(frame, pool_).depth_m, pool_);
              },
              [&](const ThermalFramePtr& frame) {
                pipeline_->ProcessThermal(frame);
                fusion.AddThermal(frame);
              }});
    pipeline_->Finish();
    fusion.Finish(pool_);
  }

  ThreadPool pool_{2};
  std::unique_ptr<SimulatedScan> scan_;
  std::unique_ptr<GroundPipeline> pipeline_;
};

TEST_F(StageFusionTest, WithThePipelinesOptionsItHasThePipelinesTemperatures) {
  const ScanModel model = pipeline_->model();
  StageFusion fusion({ThermalOptions(), scan_->rig()}, 0.0F, model);
  Play(fusion);
  const std::vector<std::uint32_t> expected = WordsOf(model.thermal(), model.tsdf());
  EXPECT_GT(std::ranges::count_if(expected, [](std::uint32_t word) { return word != 0; }), 10'000);
  EXPECT_TRUE(WordsOf(fusion.thermal(), model.tsdf()) == expected);
}

TEST_F(StageFusionTest, WithItsRulesSwitchedOffMoreIsAssigned) {
  const ScanModel model = pipeline_->model();
  ThermalSettings without{ThermalOptions(), scan_->rig()};
  for (const ThermalRule& rule : ThermalRules()) rule.switch_off(without);
  StageFusion fusion(without, 0.0F, model);
  Play(fusion);
  const auto measured = [&](const ThermalVolume& thermal) {
    std::int64_t count = 0;
    for (std::int32_t block = 0; block < model.tsdf().block_count(); ++block)
      count += std::ranges::count_if(thermal.voxels(block), &ThermalVoxel::measured);
    return count;
  };
  EXPECT_GT(measured(fusion.thermal()), measured(model.thermal()));
}

TEST(ThermalRulesTest, EachSwitchesSomethingElseOff) {
  const auto text_of = [](const ThermalSettings& settings) {
    return settings.options.SerializeAsString() +
           std::to_string(settings.rig.depth_sensor.near_range_m);
  };
  std::set<std::string> switched_off{text_of({})};
  for (const ThermalRule& rule : ThermalRules()) {
    ThermalSettings settings;
    rule.switch_off(settings);
    const Status valid = Validate(settings.options);
    EXPECT_TRUE(valid.ok()) << rule.name << ": " << valid.message();
    EXPECT_TRUE(switched_off.insert(text_of(settings)).second) << rule.name;
  }
}

}  // namespace
}  // namespace isotherm
