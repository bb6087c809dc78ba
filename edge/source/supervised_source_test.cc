#include "edge/source/supervised_source.h"

#include <gtest/gtest.h>

#include <map>
#include <utility>

#include "edge/options/edge_options.pb.h"
#include "edge/source/testing/fake_source.h"

namespace isotherm {
namespace {

using std::chrono::milliseconds;

using Loss = SupervisedSource::Loss;
constexpr Nanoseconds kNoPause{0};

class SupervisedSourceTest : public testing::Test {
 protected:
  void Start(std::string_view script) {
    auto fake = std::make_unique<FakeSource>(script);
    fake_ = fake.get();
    source_ = std::make_unique<SupervisedSource>(
        std::move(fake), options_, clock_, [this](Sensor) { ++captured_; },
        [this](Sensor) { ++rejected_; }, kNoPause);
    ASSERT_TRUE(source_->Open().ok());
  }

  void StartThermal(std::string_view script, bool counts_only) {
    auto fake = std::make_unique<FakeSource>(script);
    fake_ = fake.get();
    fake->DescribeThermal(counts_only);
    source_ = std::make_unique<SupervisedSource>(
        std::move(fake), options_, clock_, [](Sensor) {}, [](Sensor) {}, kNoPause);
    ASSERT_TRUE(source_->Open().ok());
  }
  RawFrame ReadFrame() {
    const Result<SourceItem> item = source_->Read({});
    return item && std::holds_alternative<RawFrame>(*item) ? std::get<RawFrame>(*item) : RawFrame{};
  }

  /// Reads this many times; returns how many frames came.
  int Read(int times) {
    int frames = 0;
    for (int i = 0; i < times; ++i) {
      const Result<SourceItem> item = source_->Read({});
      frames += item && std::holds_alternative<RawFrame>(*item) ? 1 : 0;
    }
    return frames;
  }

  FrameCheckOptions options_;
  FakeClock clock_;
  FakeSource* fake_ = nullptr;
  std::unique_ptr<SupervisedSource> source_;
  int captured_ = 0;
  int rejected_ = 0;
};

TEST_F(SupervisedSourceTest, GoodFramesPass) {
  Start("3*d - 2*t");
  EXPECT_EQ(Read(6), 5);
  EXPECT_EQ(captured_, 5);
  EXPECT_EQ(rejected_, 0);
  const Result<SourceItem> end = source_->Read({});
  ASSERT_TRUE(end.has_value());
  EXPECT_TRUE(std::holds_alternative<EndOfStream>(*end));
}

TEST_F(SupervisedSourceTest, F11BadFramesAreDroppedAndCounted) {
  Start("d 3*d:empty 2*d:size d");
  EXPECT_EQ(Read(7), 2);
  EXPECT_EQ(captured_, 7);
  EXPECT_EQ(rejected_, 5);
  EXPECT_EQ(source_->reopened(), 0U);
}

TEST_F(SupervisedSourceTest, F11TenBadFramesInARowReopenTheSource) {
  Start("d 10*d:size d");
  EXPECT_EQ(Read(12), 1);
  EXPECT_EQ(fake_->opened(), 1) << "not before the wait is over";
  clock_.Advance(milliseconds(500));
  EXPECT_EQ(Read(2), 1) << "one call to open, one frame";
  EXPECT_EQ(fake_->opened(), 2);
  EXPECT_EQ(source_->reopened(), 1U);
}

TEST_F(SupervisedSourceTest, F04OnlyTheFirstFrameAfterOpeningAgainSaysSo) {
  Start("2*d 10*d:size 3*d");
  const auto next_frame = [this] {
    const Result<SourceItem> item = source_->Read({});
    const auto* frame = item ? std::get_if<RawFrame>(&*item) : nullptr;
    return frame == nullptr ? std::optional<bool>() : frame->reopened;
  };
  EXPECT_EQ(next_frame(), false) << "opened for the first time";
  EXPECT_EQ(next_frame(), false);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(next_frame(), std::nullopt);
  clock_.Advance(milliseconds(500));
  EXPECT_EQ(next_frame(), std::nullopt) << "opened";
  EXPECT_EQ(next_frame(), true);
  EXPECT_EQ(next_frame(), false);
}

TEST_F(SupervisedSourceTest, F11NineBadFramesAndAGoodOneStartTheCountAgain) {
  Start("d 9*d:size d 9*d:size d");
  EXPECT_EQ(Read(21), 3);
  EXPECT_EQ(source_->reopened(), 0U);
}

TEST_F(SupervisedSourceTest, F11GoodFramesOfTheOtherCameraDoNotHideTheBadOnes) {
  Start(
      "d t d:size t d:size t d:size t d:size t d:size t d:size t d:size t d:size t d:size t "
      "d:size");
  EXPECT_EQ(Read(21), 11);
  clock_.Advance(milliseconds(500));
  Read(1);
  EXPECT_EQ(source_->reopened(), 1U);
}

TEST_F(SupervisedSourceTest, FramesThatWereLeftOutAndFramesThatTheCameraLostAreToldApart) {
  Start("2*d d:left d d:lost t t:left d:left");
  std::map<std::pair<Sensor, Loss>, std::uint64_t> losses;
  source_->OnLoss([&losses](Sensor sensor, Loss loss, std::uint64_t frames) {
    losses[{sensor, loss}] += frames;
  });
  EXPECT_EQ(Read(8), 8);
  EXPECT_EQ((losses[{Sensor::kDepth, Loss::kLeftOut}]), 6U);
  EXPECT_EQ((losses[{Sensor::kDepth, Loss::kInCamera}]), 3U);
  EXPECT_EQ((losses[{Sensor::kThermal, Loss::kLeftOut}]), 3U);
  EXPECT_EQ((losses[{Sensor::kThermal, Loss::kInCamera}]), 0U);
}

TEST_F(SupervisedSourceTest, F14WhatWasLeftOutUntilTheEndIsCounted) {
  Start("d");
  std::uint64_t left_out = 0;
  source_->OnLoss([&left_out](Sensor sensor, Loss loss, std::uint64_t frames) {
    EXPECT_EQ(sensor, Sensor::kDepth);
    EXPECT_EQ(loss, Loss::kLeftOut);
    left_out += frames;
  });
  EXPECT_EQ(Read(1), 1);
  fake_->left_out_at_close = 4;
  source_->Close();
  EXPECT_EQ(left_out, 4U);
}

TEST_F(SupervisedSourceTest, WhatIsLostBeforeTheScanBeginsCountsNothing) {
  Start("d:lost d:left d d:lost");
  std::uint64_t lost = 0;
  source_->OnLoss([&lost](Sensor, Loss, std::uint64_t frames) { lost += frames; });
  source_->SetIdle(true);
  Read(2);
  source_->SetIdle(false);
  EXPECT_EQ(ReadFrame().frame_number, 0U);
  EXPECT_EQ(lost, 0U);
  EXPECT_EQ(ReadFrame().frame_number, 4U);
  EXPECT_EQ(lost, 3U);
}

TEST_F(SupervisedSourceTest, AFailedReadReopensTheSource) {
  Start("d ! d");
  EXPECT_EQ(Read(2), 1);
  clock_.Advance(milliseconds(500));
  EXPECT_EQ(Read(2), 1);
  EXPECT_EQ(fake_->opened(), 2);
}

TEST_F(SupervisedSourceTest, TheWaitDoublesUpToItsLimit) {
  Start("! d");
  Read(1);
  fake_->FailToOpen(100);
  milliseconds expected(500);
  for (int attempt = 1; attempt <= 8; ++attempt) {
    clock_.Advance(expected - milliseconds(1));
    Read(1);
    EXPECT_EQ(fake_->opened(), attempt) << "opened too early after " << expected.count() << " ms";
    clock_.Advance(milliseconds(1));
    Read(1);
    EXPECT_EQ(fake_->opened(), attempt + 1);
    expected = std::min(2 * expected, milliseconds(5000));
  }
}

TEST_F(SupervisedSourceTest, AGoodFrameEndsTheLongWaits) {
  Start("! d ! d");
  Read(1);
  fake_->FailToOpen(6);
  for (int attempt = 0; attempt < 7; ++attempt) {
    clock_.Advance(milliseconds(5000));
    Read(1);
  }
  ASSERT_EQ(Read(1), 1);
  Read(1);
  const int opened = fake_->opened();
  clock_.Advance(milliseconds(500));
  Read(1);
  EXPECT_EQ(fake_->opened(), opened + 1);
}

TEST_F(SupervisedSourceTest, CameraThatSendsCountsKeepsThem) {
  StartThermal("2*t:hot", /*counts_only=*/true);
  EXPECT_EQ(ReadFrame().pixels.At(0, 0), 65'535);  // No temperature that a camera could see.
}

TEST_F(SupervisedSourceTest, CameraThatSendsCountsDoesNotReplaceOneThatMeasures) {
  StartThermal("t ! 3*t", /*counts_only=*/false);
  EXPECT_EQ(Read(2), 1);
  fake_->DescribeThermal(/*counts_only=*/true);
  clock_.Advance(milliseconds(500));
  EXPECT_EQ(Read(3), 0);
  EXPECT_EQ(fake_->opened(), 2);
  fake_->DescribeThermal(/*counts_only=*/false);
  clock_.Advance(milliseconds(1000));
  EXPECT_EQ(Read(2), 1);
}

TEST_F(SupervisedSourceTest, CountsAreRefusedInAScanThatBeganWithoutAThermalCamera) {
  auto fake = std::make_unique<FakeSource>("3*t");
  fake->FailToOpen(1);
  fake->DescribeThermal(/*counts_only=*/true);
  fake_ = fake.get();
  source_ = std::make_unique<SupervisedSource>(
      std::move(fake), options_, clock_, [](Sensor) {}, [](Sensor) {}, kNoPause);
  source_->KeepTrying(source_->Open());
  clock_.Advance(milliseconds(500));
  EXPECT_EQ(Read(2), 0);
  EXPECT_EQ(fake_->opened(), 2);
}

TEST_F(SupervisedSourceTest, AFailureToOpenAtStartIsReported) {
  auto fake = std::make_unique<FakeSource>("d");
  fake->FailToOpen(1);
  SupervisedSource source(
      std::move(fake), options_, clock_, [](Sensor) {}, [](Sensor) {}, kNoPause);
  EXPECT_EQ(source.Open().code(), StatusCode::kUnavailable);
}

TEST_F(SupervisedSourceTest, F03ACameraThatTheCalibrationIsNotOfIsNotUsed) {
  for (const Sensor sensor : {Sensor::kDepth, Sensor::kThermal}) {
    auto fake = std::make_unique<FakeSource>("d");
    FakeSource& camera = *fake;
    camera.descriptions.resize(1);
    camera.descriptions[0].sensor = sensor;
    camera.descriptions[0].serial = "NEW-2";
    SupervisedSource source(
        std::move(fake), options_, clock_, [](Sensor) {}, [](Sensor) {}, kNoPause);
    Rig calibration;
    (sensor == Sensor::kDepth ? calibration.depth_serial : calibration.thermal_serial) = "OLD-1";
    source.Expect(calibration);
    const Status opened = source.Open();
    EXPECT_EQ(opened.code(), StatusCode::kFailedPrecondition);
    EXPECT_NE(opened.message().find("\"NEW-2\" is not used: the calibration is of \"OLD-1\""),
              std::string::npos)
        << opened.message();
    camera.descriptions[0].serial = "OLD-1";
    EXPECT_TRUE(source.Open().ok());
  }
}

TEST_F(SupervisedSourceTest, F05ASourceThatCannotRestartItsCameraIsOpenedAgain) {
  Start("d d");
  Read(1);
  EXPECT_TRUE(source_->Control(RestartCamera{})->ok());
  EXPECT_TRUE(source_->Control(RestartCamera{})->ok()) << "it is under way";
  Read(1);
  EXPECT_EQ(fake_->opened(), 1) << "not before the wait is over";
  clock_.Advance(milliseconds(500));
  EXPECT_EQ(Read(2), 1);
  EXPECT_EQ(fake_->opened(), 2);
}

TEST_F(SupervisedSourceTest, ASourceThatRestartsItsCameraItselfIsLeftOpen) {
  Start("d d");
  fake_->control_answer = OkStatus();
  EXPECT_TRUE(source_->Control(RestartCamera{})->ok());
  EXPECT_EQ(Read(2), 2);
  EXPECT_EQ(fake_->opened(), 1);
}

TEST_F(SupervisedSourceTest, WhileItIsReopenedOrdersAreRefusedForNow) {
  Start("! d");
  Read(1);
  EXPECT_EQ(source_->Control(TriggerNuc{})->code(), StatusCode::kUnavailable);
  EXPECT_TRUE(fake_->controls.empty());
}

}  // namespace
}  // namespace isotherm
