// Recordings that can be read but cannot be right, as a user meets them: a warning with the likely
// cause, exit status 65, and nothing that was good lost.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <string>

#include "common/codec/codec.h"
#include "common/recording/recording.h"
#include "tests/support/tool.h"

namespace isotherm::testing {
namespace {

/// Holds what a copy of a scan gets wrong.
struct Mistake {
  std::function<void(Rig&)> rig = [](Rig&) {};
  std::function<void(EncodedDepthFrame&)> depth = [](EncodedDepthFrame&) {};
  std::function<void(EncodedThermalFrame&)> thermal = [](EncodedThermalFrame&) {};
};

class DoubtfulScanTest : public ToolRun {
 protected:
  void Simulate(const std::string& name = "scan.mcap",
                const std::string& scene = "corner-sphere") const {
    RunWell("simulate --scene " + scene + " --duration 0.3 -o " + name);
  }

  /// wrong.mcap, made of scan.mcap.
  void Copy(const Mistake& mistake) const {
    auto reader = RecordingReader::Open(folder_ / "scan.mcap");
    ASSERT_TRUE(reader) << reader.error().message();
    auto writer = RecordingWriter::Create(folder_ / "wrong.mcap", {});
    ASSERT_TRUE(writer) << writer.error().message();
    Rig rig = (*reader)->ReadRig().value();
    mistake.rig(rig);
    ASSERT_TRUE((*writer)->Write(rig).ok());
    while (true) {
      auto item = (*reader)->Next();
      ASSERT_TRUE(item) << item.error().message();
      if (!*item) break;
      if (auto* depth = std::get_if<RecordedDepth>(&**item)) {
        mistake.depth(depth->frame);
        ASSERT_TRUE((*writer)->Write(depth->frame, depth->arrival).ok());
      } else if (auto* thermal = std::get_if<RecordedThermal>(&**item)) {
        mistake.thermal(thermal->frame);
        ASSERT_TRUE((*writer)->Write(thermal->frame, thermal->arrival).ok());
      }
    }
    ASSERT_TRUE((*writer)->Close().ok());
  }

  Outcome Reconstruct(const std::string& arguments) const {
    return Run("reconstruct " + arguments +
               " --voxel 0.006 --set calibration_check.expert.enabled=false");
  }

  /// inspect and reconstruct say it, and the result is there and says it, too.
  void ExpectWarning(const std::string& in_recording, const std::string& in_result) const {
    const Outcome inspect = Run("inspect wrong.mcap");
    EXPECT_EQ(inspect.status, in_recording.empty() ? 0 : kData);
    EXPECT_THAT(inspect.err, HasSubstr(in_recording));
    const Outcome reconstruct = Reconstruct("wrong.mcap -o out");
    EXPECT_EQ(reconstruct.status, kData);
    EXPECT_THAT(reconstruct.err, AllOf(HasSubstr("isotherm: warning: "), HasSubstr(in_recording),
                                       HasSubstr(in_result)));
    EXPECT_THAT(ReadAll(folder_ / "out/stats.json"),
                AllOf(HasSubstr("\"warnings\""), HasSubstr(in_result)));
  }
};

TEST_F(DoubtfulScanTest, ASoundScanIsNotDoubted) {
  Simulate();
  const Outcome inspect = Run("inspect scan.mcap");
  EXPECT_EQ(inspect.status, 0) << inspect.err;
  const Outcome reconstruct = Reconstruct("scan.mcap -o out --initial-pose-from scan.mcap");
  EXPECT_EQ(reconstruct.status, 0) << reconstruct.err;
  EXPECT_THAT(ReadAll(folder_ / "out/stats.json"), Not(HasSubstr("\"warnings\"")));
}

TEST_F(DoubtfulScanTest, F57AWrongDepthScaleIsNamed) {
  Simulate();
  Copy({.rig = [](Rig& rig) { rig.depth_scale = 1.0; },
        .depth = [](EncodedDepthFrame& frame) { frame.depth_scale = 1.0; }});
  ExpectWarning("depth_scale 1000 would make it", "depth frames was tracked");
}

TEST_F(DoubtfulScanTest, F57ExtrinsicsInMillimetresAreNamed) {
  Simulate();
  Copy({.rig = [](Rig& rig) { rig.T_thermal_depth->translation() *= 1e3; }});
  ExpectWarning("as millimetres they would be", "the thermal camera does not look at the surface");
}

TEST_F(DoubtfulScanTest, ThermalFramesOfAnotherClockAreNamed) {
  Simulate();
  Copy({.thermal = [](EncodedThermalFrame& frame) {
    frame.header.capture_time += std::chrono::seconds(1000);
  }});
  ExpectWarning("two clocks", "clocks differ");
}

TEST_F(DoubtfulScanTest, CentiDegreesAreNamed) {
  Simulate();
  Copy({.thermal = [](EncodedThermalFrame& frame) {
    static ThermalEncoder encoder;
    Image<std::uint16_t> pixels = Decode(frame.image).value();
    for (std::uint16_t& pixel : pixels.pixels())
      pixel = static_cast<std::uint16_t>(std::max(1, pixel - 27315));
    frame.image = encoder.Encode(pixels, frame.scale);
  }});
  const Outcome reconstruct = Reconstruct("wrong.mcap -o out --initial-pose-from scan.mcap");
  EXPECT_EQ(reconstruct.status, kData);
  EXPECT_THAT(reconstruct.err, HasSubstr("as centi-degrees Celsius they would be"));
  EXPECT_EQ(Run("inspect wrong.mcap").status, kData);
}

TEST_F(DoubtfulScanTest, HeldOutViewsCountWhatCannotBeCompared) {
  Simulate();
  int frames = 0;
  Copy({.thermal = [&frames](EncodedThermalFrame& frame) {
    ++frames;
    if (frames == 1 || frames == 3) frame.image.payload.resize(frame.image.payload.size() / 2);
    // The fourth that can be read: every second is held out.
    if (frames == 6) {
      const Image<std::uint16_t> other(16, 12, 30'000);
      frame.image = ThermalEncoder().Encode(other, frame.scale);
    }
  }});
  ASSERT_GT(frames, 6);
  const Outcome text = Run("evaluate wrong.mcap --held-out-views 2 --voxel 0.006");
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr(", 1 of another size; 2 damaged ones could not be held out\n"));
  const Outcome json = Run("evaluate wrong.mcap --held-out-views 2 --voxel 0.006 --json");
  EXPECT_THAT(json.out, AllOf(HasSubstr("\"wrong_size\": 1"), HasSubstr("\"undecodable\": 2")));
}

TEST_F(DoubtfulScanTest, AFirstPoseOutsideOfTheVolumeIsNamed) {
  Simulate();
  const Outcome reconstruct = Reconstruct("scan.mcap -o out --initial-pose \"50 50 50 0 0 0 1\"");
  EXPECT_EQ(reconstruct.status, kData);
  EXPECT_THAT(reconstruct.err, AllOf(HasSubstr("depth frames was tracked, so there is no surface"),
                                     HasSubstr("correct --initial-pose")));
}

TEST_F(DoubtfulScanTest, AModelThatWasNotFoundAgainDoesNotPassForTheNewResult) {
  Simulate();
  ASSERT_EQ(Reconstruct("scan.mcap -o out").status, 0);
  Simulate("elsewhere.mcap", "furnace-door");
  const Outcome next =
      Run("reconstruct elsewhere.mcap -o next --continue out/model.iso "
          "--set calibration_check.expert.enabled=false");
  EXPECT_EQ(next.status, kData);
  EXPECT_THAT(next.err, AllOf(HasSubstr("was found in the model"), HasSubstr("unchanged"),
                              HasSubstr("without --continue")));
  EXPECT_THAT(ReadAll(folder_ / "next/stats.json"), HasSubstr("that model, unchanged"));
  const Outcome same =
      Run("reconstruct scan.mcap -o same --continue out/model.iso "
          "--set calibration_check.expert.enabled=false");
  EXPECT_EQ(same.status, 0) << same.err;
}

TEST_F(DoubtfulScanTest, ResultsAreReplacedOnlyWhenAskedForAndThenCompletely) {
  Simulate();
  const std::string scan = "scan.mcap -o out --initial-pose-from scan.mcap ";
  ASSERT_EQ(Reconstruct(scan).status, 0);
  Write("out/model-2.iso", "of an earlier scan");
  Write("out/notes.txt", "the user's own");
  const std::string before = ReadAll(folder_ / "out/cloud.ply");
  const Outcome refused = Reconstruct(scan + "--set export.expert.mesh=false");
  EXPECT_EQ(refused.status, kUsage);
  EXPECT_THAT(refused.err, HasSubstr("has results of another scan; --force replaces them"));
  EXPECT_EQ(ReadAll(folder_ / "out/cloud.ply"), before);
  const Outcome forced = Reconstruct(scan + "--force --set export.expert.mesh=false");
  EXPECT_EQ(forced.status, 0) << forced.err;
  EXPECT_FALSE(fs::exists(folder_ / "out/model-2.iso"));
  EXPECT_FALSE(fs::exists(folder_ / "out/mesh.ply"));
  EXPECT_TRUE(fs::exists(folder_ / "out/model.iso"));
  EXPECT_TRUE(fs::exists(folder_ / "out/notes.txt"));
}

TEST_F(DoubtfulScanTest, LostFramesAreExplainedInSentences) {
  Simulate();
  const Outcome outcome =
      Reconstruct("scan.mcap -o out --set preprocessor.expert.max_depth_m=0.31");
  EXPECT_EQ(outcome.status, kData);
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("lost: too few pixels between"), Not(HasSubstr("too_few_pixels"))));
  EXPECT_THAT(ReadAll(folder_ / "out/stats.json"), HasSubstr("\"too_few_pixels\""));
}

// The room of the README: larger voxels need no second option.
TEST_F(DoubtfulScanTest, LargerVoxelsNeedNoOtherOption) {
  Simulate();
  const Outcome outcome =
      Run("reconstruct scan.mcap -o out --volume \"3.2 2.4 3.2\" --voxel 0.006 "
          "--set calibration_check.expert.enabled=false");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(ReadAll(folder_ / "out/stats.json"), HasSubstr("\"truncation_distance_m\": 0.024"));
  EXPECT_THAT(Run("reconstruct scan.mcap -o other --voxel 2").err,
              HasSubstr("voxel_size_m must be at most 0.25 m, got 2 m"));
}

}  // namespace
}  // namespace isotherm::testing
