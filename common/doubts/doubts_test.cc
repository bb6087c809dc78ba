#include "common/doubts/doubts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace isotherm {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Rig SoundRig() {
  Rig rig;
  rig.depth = CameraModel{.width = 640, .height = 480, .fx = 580, .fy = 580, .cx = 320, .cy = 240};
  rig.thermal =
      CameraModel{.width = 382, .height = 288, .fx = 560, .fy = 560, .cx = 190, .cy = 143};
  rig.T_thermal_depth = MakeTransform({-0.07, 0.01, 0.0}, Eigen::Quaterniond::Identity());
  rig.thermal_delay_s = -0.0427;
  return rig;
}

/// `frames` stamps, the first at `start_s`, all `period_s` apart.
std::vector<CaptureTime> Stamps(int frames, double start_s, double period_s) {
  std::vector<CaptureTime> times;
  for (int i = 0; i < frames; ++i) {
    times.push_back(CaptureTime(FromSeconds(start_s) + i * FromSeconds(period_s)));
  }
  return times;
}

StreamTimes Times(int frames, double start_s, double period_s) {
  std::vector<CaptureTime> times = Stamps(frames, start_s, period_s);
  return MeasureTimes(times);
}

TEST(DoubtsTest, ASoundRigIsNotDoubted) {
  EXPECT_THAT(DoubtsAbout(SoundRig()), IsEmpty());
  EXPECT_THAT(DoubtsAbout(Rig()), IsEmpty());
}

TEST(DoubtsTest, ExtrinsicsInMillimetresAreNamedWithTheirLikelyValue) {
  Rig rig = SoundRig();
  rig.T_thermal_depth->translation() *= 1e3;
  EXPECT_THAT(DoubtsAbout(rig),
              ElementsAre(AllOf(HasSubstr("70.71 m apart"),
                                HasSubstr("millimetres they would be 0.07071 m"))));
}

TEST(DoubtsTest, UnitsOfDelayAndDepthScaleAreDoubted) {
  Rig rig = SoundRig();
  rig.thermal_delay_s = -42.7;
  rig.depth_scale = 1.0;
  EXPECT_THAT(DoubtsAbout(rig),
              ElementsAre(HasSubstr("thermal_delay_s is -42.7 s"), HasSubstr("depth_scale: 1000")));
}

TEST(DoubtsTest, StampsInOtherUnitsAreFound) {
  const auto doubts = [](double per_second) {
    return DoubtsAboutTimes(Times(30, 5.0 * per_second, per_second / 30.0), {});
  };
  EXPECT_THAT(doubts(1.0), IsEmpty());
  EXPECT_THAT(doubts(1e3), ElementsAre(HasSubstr("milliseconds (30.0 Hz): divide them by 1000")));
  EXPECT_THAT(doubts(1e6), ElementsAre(HasSubstr("microseconds (30.0 Hz)")));
  EXPECT_THAT(doubts(1e-3), ElementsAre(HasSubstr("30000 frames a second")));
  // One frame every 90 s fits no unit.
  EXPECT_THAT(DoubtsAboutTimes(Times(9, 0, 1800.0), {}),
              ElementsAre(AllOf(HasSubstr("every 1800 s"), HasSubstr("another unit?"))));
}

TEST(DoubtsTest, StreamsOfTwoClocksAreFound) {
  const StreamTimes depth = Times(300, 100.0, 1.0 / 30.0);
  EXPECT_THAT(DoubtsAboutTimes(depth, Times(400, 99.9, 1.0 / 40.0)), IsEmpty());
  // The thermal camera was plugged in late, or gave up early.
  EXPECT_THAT(DoubtsAboutTimes(depth, Times(40, 108.0, 1.0 / 40.0)), IsEmpty());
  EXPECT_THAT(DoubtsAboutTimes(depth, Times(400, 1100.0, 1.0 / 40.0)),
              ElementsAre(AllOf(HasSubstr("begin +1000.000 s after"), HasSubstr("two clocks"))));
  EXPECT_THAT(DoubtsAboutTimes(depth, Times(400, 92.0, 1.0 / 40.0)),
              ElementsAre(HasSubstr("overlap for 1.975 s only")));
}

TEST(DoubtsTest, WrongDepthScalesAreNamedWithTheRightOne) {
  EXPECT_THAT(DoubtsAboutDepths(800.0, 1000.0), IsEmpty());
  EXPECT_THAT(DoubtsAboutDepths(800.0, 1.0),
              ElementsAre(AllOf(HasSubstr("say 800 m"), HasSubstr("depth_scale 1000 would make it "
                                                                  "0.8 m"))));
  EXPECT_THAT(DoubtsAboutDepths(800.0, 5000.0),
              ElementsAre(AllOf(HasSubstr("say 0.16 m"), HasSubstr("depth_scale 1000"))));
  EXPECT_THAT(DoubtsAboutDepths(0.0, 1000.0), ElementsAre(HasSubstr("covered")));
}

TEST(DoubtsTest, ThermalImagesInOtherUnitsAreDoubted) {
  EXPECT_THAT(DoubtsAboutTemperatures({.mean_raw = 29615.0}), IsEmpty());
  EXPECT_THAT(DoubtsAboutTemperatures({.mean_raw = 23400.0}), IsEmpty()) << "-39.15 °C";
  EXPECT_THAT(DoubtsAboutTemperatures({.mean_raw = 17408.0}),
              ElementsAre(AllOf(HasSubstr("-99.1 °C"),
                                HasSubstr("as centi-degrees Celsius they would be 174.1 °C"))));
  EXPECT_THAT(DoubtsAboutTemperatures({.mean_raw = 2961.5}),
              ElementsAre(HasSubstr("as deci-kelvin they would be 23.0 °C")));
  EXPECT_THAT(DoubtsAboutTemperatures({.none_ratio = 1.0}), ElementsAre(HasSubstr("all are 0")));
  EXPECT_THAT(DoubtsAboutTemperatures({.mean_raw = 65535.0, .saturated_ratio = 1.0}),
              ElementsAre(HasSubstr("largest value")));
}

TEST(DoubtsTest, PixelsOfAnotherScaleAreDoubtedInTheirOwn) {
  constexpr RadiometricScale kHot{0.02, 0.0};
  EXPECT_THAT(DoubtsAboutTemperatures({.scale = kHot, .mean_raw = 56'000.0}), IsEmpty())
      << "846.85 °C";
  EXPECT_THAT(DoubtsAboutTemperatures({.scale = {0.1, 0.0}, .mean_raw = 29615.5}),
              ElementsAre(AllOf(HasSubstr("2688.4 °C with thermal_scale 0.1"),
                                HasSubstr("as centi-kelvin (thermal_scale: 0.01) they would be "
                                          "23.0 °C"))));
  EXPECT_THAT(
      DoubtsAboutTemperatures({.scale = kHot, .mean_raw = 65'535.0, .saturated_ratio = 1.0}),
      ElementsAre(HasSubstr("1038 °C")));
}

}  // namespace
}  // namespace isotherm
