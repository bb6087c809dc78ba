#include "edge/source/camera_pair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>

#include "edge/options/edge_options.pb.h"
#include "edge/source/testing/fake_source.h"

namespace isotherm {
namespace {

using std::chrono::seconds;
using ::testing::HasSubstr;

/// A limit for hanging.
constexpr seconds kPatience{20};

/// A camera as the test says; shared, so that the test can look at it and change it.
struct FakeCamera {
  std::atomic<bool> there{true};
  std::atomic<bool> fails{false};  ///< Read fails.
  std::atomic<int> opened{0};
  std::atomic<int> frames{0};
  std::atomic<bool> blocks{false};  ///< Read does not come back.
  std::atomic<int> nuc_orders{0};
  Status answer;  ///< To orders.
  Status opening_error = Unavailable("the camera is not there");
  std::atomic<char> serial{'A'};
};

class FakeCameraSource final : public FrameSource {
 public:
  FakeCameraSource(Sensor sensor, std::shared_ptr<FakeCamera> camera)
      : sensor_(sensor), camera_(std::move(camera)) {}
  std::string_view name() const override { return "fake camera"; }
  Status Open() override {
    ++camera_->opened;
    return camera_->there ? OkStatus() : camera_->opening_error;
  }
  Result<SourceItem> Read(std::stop_token) override {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));  // The camera's period.
    while (camera_->blocks) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    if (camera_->fails || !camera_->there) return Err(Unavailable("the cable came off"));
    RawFrame frame;
    frame.sensor = sensor_;
    frame.frame_number = number_++;
    ++camera_->frames;
    frame.arrival_wall = clock_.Now();
    frame.pixels = Image<std::uint16_t>(4, 3, 30'000);
    return frame;
  }
  void Close() override {}
  std::optional<Status> Control(const CameraControl& control) override {
    if (std::holds_alternative<RestartCamera>(control)) return FailedPrecondition("cannot");
    ++camera_->nuc_orders;
    return camera_->answer;
  }
  std::optional<Rig> rig() const override {
    Rig rig;
    CameraModel model;
    model.width = 4;
    model.height = 3;
    (sensor_ == Sensor::kDepth ? rig.depth : rig.thermal) = model;
    return rig;
  }
  std::vector<CameraDescription> cameras() const override {
    CameraDescription description;
    description.sensor = sensor_;
    description.serial = std::string(1, camera_->serial);
    return {description};
  }

 private:
  const Sensor sensor_;
  const std::shared_ptr<FakeCamera> camera_;
  const SystemClock clock_{};
  std::uint64_t number_ = 0;
};

class CameraPairTest : public ::testing::Test {
 protected:
  CameraPairTest() {
    options_.mutable_expert()->set_retry_min_s(0.01);
    options_.mutable_expert()->set_retry_max_s(0.02);
    std::vector<CameraPair::Camera> cameras;
    cameras.push_back(Supervise(Sensor::kDepth, depth_));
    cameras.push_back(Supervise(Sensor::kThermal, thermal_));
    pair_ = std::make_unique<CameraPair>(
        std::move(cameras),
        CameraPair::Queue{8, OverflowPolicy::kDropOldest,
                          [this](Sensor sensor) { ++dropped_[static_cast<std::size_t>(sensor)]; }});
  }

  CameraPair::Camera Supervise(Sensor sensor, std::shared_ptr<FakeCamera> camera) {
    auto source = std::make_unique<SupervisedSource>(
        std::make_unique<FakeCameraSource>(sensor, std::move(camera)), options_, clock_,
        [this](Sensor from) { ++captured_[static_cast<std::size_t>(from)]; }, [](Sensor) {});
    source->OnWorks(
        [this, sensor](bool works) { works_[static_cast<std::size_t>(sensor)] = works; });
    return {sensor, std::move(source)};
  }
  /// Reads until `count` frames of `sensor` have come; false if they do not.
  bool ReadFrames(Sensor sensor, int count) {
    const SteadyTime end = clock_.SteadyNow() + kPatience;
    while (count > 0 && clock_.SteadyNow() < end) {
      const Result<SourceItem> item = pair_->Read({});
      const auto* frame = item ? std::get_if<RawFrame>(&*item) : nullptr;
      if (frame == nullptr) continue;
      ++read_[static_cast<std::size_t>(frame->sensor)];
      if (frame->sensor == sensor) --count;
    }
    return count == 0;
  }

  /// Reads until so many orders are answered, or so many as are by then.
  std::vector<ControlAnswer> ReadAnswers(std::size_t count) {
    std::vector<ControlAnswer> answers;
    const SteadyTime end = clock_.SteadyNow() + kPatience;
    while (answers.size() < count && clock_.SteadyNow() < end) {
      static_cast<void>(pair_->Read({}));
      for (ControlAnswer& answer : pair_->TakeControlAnswers()) answers.push_back(answer);
    }
    EXPECT_EQ(answers.size(), count);
    return answers;
  }

  FrameCheckOptions options_;
  const SystemClock clock_{};
  const std::shared_ptr<FakeCamera> depth_ = std::make_shared<FakeCamera>();
  const std::shared_ptr<FakeCamera> thermal_ = std::make_shared<FakeCamera>();
  std::array<std::atomic<int>, 2> captured_{}, dropped_{};
  std::array<std::atomic<bool>, 2> works_{};
  std::array<int, 2> read_{};
  std::unique_ptr<CameraPair> pair_;
};

TEST_F(CameraPairTest, FramesOfBothComeAndAreAllAccountedFor) {
  ASSERT_TRUE(pair_->Open().ok());
  EXPECT_TRUE(ReadFrames(Sensor::kDepth, 20));
  EXPECT_TRUE(ReadFrames(Sensor::kThermal, 20));
  pair_->Close();
  while (const std::optional<RawFrame> unread = pair_->TakeUnread()) {
    ++read_[static_cast<std::size_t>(unread->sensor)];
  }
  for (const std::size_t sensor : {0U, 1U}) {
    EXPECT_EQ(captured_[sensor], read_[sensor] + dropped_[sensor]);
  }
}

TEST_F(CameraPairTest, FramesCountFromTheFirstReadOn) {
  ASSERT_TRUE(pair_->Open().ok());
  while (depth_->frames < 20) std::this_thread::yield();
  EXPECT_EQ(captured_[0], 0);
  const SteadyTime end = clock_.SteadyNow() + kPatience;
  while (clock_.SteadyNow() < end) {
    const Result<SourceItem> item = pair_->Read({});
    const auto* frame = item ? std::get_if<RawFrame>(&*item) : nullptr;
    if (frame == nullptr || frame->sensor != Sensor::kDepth) continue;
    EXPECT_EQ(frame->frame_number, 0U);
    return;
  }
  FAIL() << "no frame";
}

TEST_F(CameraPairTest, TheCamerasTellWhatTheyAre) {
  ASSERT_TRUE(pair_->Open().ok());
  EXPECT_EQ(pair_->cameras().size(), 2U);
  ASSERT_TRUE(pair_->rig());
  EXPECT_TRUE(pair_->rig()->depth);
  EXPECT_TRUE(pair_->rig()->thermal);
}

TEST_F(CameraPairTest, F01WithoutTheDepthCameraTheThermalOneGoesOnAndF02ItIsUsedAgain) {
  ASSERT_TRUE(pair_->Open().ok());
  ASSERT_TRUE(ReadFrames(Sensor::kDepth, 1));
  depth_->there = false;
  while (works_[0]) ASSERT_TRUE(ReadFrames(Sensor::kThermal, 1));
  const int opened = depth_->opened;
  EXPECT_TRUE(ReadFrames(Sensor::kThermal, 50));
  while (depth_->opened == opened) ASSERT_TRUE(ReadFrames(Sensor::kThermal, 1)) << "it is retried";
  depth_->there = true;
  EXPECT_TRUE(ReadFrames(Sensor::kDepth, 5)) << "F02: it is used again";
  EXPECT_TRUE(works_[0]);
  EXPECT_EQ(thermal_->opened, 1);
}

TEST_F(CameraPairTest, F04WithoutTheThermalCameraDepthGoesOn) {
  ASSERT_TRUE(pair_->Open().ok());
  ASSERT_TRUE(ReadFrames(Sensor::kThermal, 1));
  thermal_->fails = true;
  while (works_[1]) ASSERT_TRUE(ReadFrames(Sensor::kDepth, 1));
  EXPECT_TRUE(ReadFrames(Sensor::kDepth, 50));
  EXPECT_EQ(depth_->opened, 1);
}

TEST_F(CameraPairTest, ACameraThatIsMissingAtTheStartIsUsedWhenItComes) {
  thermal_->there = false;
  ASSERT_TRUE(pair_->Open().ok());
  EXPECT_FALSE(pair_->rig()->thermal);
  ASSERT_TRUE(ReadFrames(Sensor::kDepth, 5));
  thermal_->there = true;
  EXPECT_TRUE(ReadFrames(Sensor::kThermal, 1));
}

TEST_F(CameraPairTest, NoCameraAtAllIsAFailureThatNamesBoth) {
  depth_->there = thermal_->there = false;
  const Status opened = pair_->Open();
  EXPECT_EQ(opened.code(), StatusCode::kUnavailable);
  EXPECT_THAT(opened.message(), HasSubstr("depth camera: the camera is not there"));
  EXPECT_THAT(opened.message(), HasSubstr("thermal camera: the camera is not there"));
}

TEST_F(CameraPairTest, WhatACameraCannotDoEndsTheStart) {
  depth_->there = false;
  depth_->opening_error = InvalidArgument("no such mode");
  const Status opened = pair_->Open();
  EXPECT_EQ(opened.code(), StatusCode::kInvalidArgument);
  EXPECT_THAT(opened.message(), HasSubstr("no such mode"));
}

TEST_F(CameraPairTest, F03AnotherSerialNumberIsNotUsedUntilTheFirstIsBack) {
  ASSERT_TRUE(pair_->Open().ok());
  for (const Sensor sensor : {Sensor::kDepth, Sensor::kThermal}) {
    const auto index = static_cast<std::size_t>(sensor);
    const Sensor other = sensor == Sensor::kDepth ? Sensor::kThermal : Sensor::kDepth;
    FakeCamera& camera = sensor == Sensor::kDepth ? *depth_ : *thermal_;
    ASSERT_TRUE(ReadFrames(sensor, 1));
    camera.there = false;
    while (works_[index]) ASSERT_TRUE(ReadFrames(other, 1));
    camera.serial = 'B';
    camera.there = true;
    const int opened = camera.opened;
    const int captured = captured_[index];
    while (camera.opened < opened + 3) ASSERT_TRUE(ReadFrames(other, 1));
    EXPECT_FALSE(works_[index]);
    EXPECT_EQ(captured_[index], captured) << "not a frame of it";
    camera.serial = 'A';
    while (!works_[index]) ASSERT_TRUE(ReadFrames(other, 1));
    EXPECT_TRUE(ReadFrames(sensor, 1));
  }
}

TEST_F(CameraPairTest, OrdersReachTheThermalCameraAndItsAnswerComesBack) {
  ASSERT_TRUE(pair_->Open().ok());
  EXPECT_EQ(pair_->Control(TriggerNuc{}), std::nullopt) << "only its thread can ask the camera";
  const std::vector<ControlAnswer> answers = ReadAnswers(1);
  EXPECT_TRUE(answers[0].status.ok()) << answers[0].status.message();
  EXPECT_TRUE(std::holds_alternative<TriggerNuc>(answers[0].control));
  EXPECT_EQ(thermal_->nuc_orders, 1);
  EXPECT_EQ(depth_->nuc_orders, 0);
}

TEST_F(CameraPairTest, ARefusalComesBackAsTheCameraSaidIt) {
  thermal_->answer = IoError("the shutter is stuck");
  ASSERT_TRUE(pair_->Open().ok());
  ASSERT_EQ(pair_->Control(SetAutomaticNuc{false}), std::nullopt);
  const std::vector<ControlAnswer> answers = ReadAnswers(1);
  EXPECT_EQ(answers[0].status.code(), StatusCode::kIoError);
  EXPECT_EQ(answers[0].status.message(), "the shutter is stuck");
}

TEST_F(CameraPairTest, ACameraThatIsLostRefusesForNow) {
  ASSERT_TRUE(pair_->Open().ok());
  ASSERT_TRUE(ReadFrames(Sensor::kThermal, 1));
  thermal_->there = false;
  while (works_[1]) ASSERT_TRUE(ReadFrames(Sensor::kDepth, 1));
  ASSERT_EQ(pair_->Control(TriggerNuc{}), std::nullopt);
  EXPECT_EQ(ReadAnswers(1)[0].status.code(), StatusCode::kUnavailable);
  EXPECT_EQ(thermal_->nuc_orders, 0);
}

TEST_F(CameraPairTest, F05ARestartOpensTheThermalCameraAgainAndOnlyThat) {
  ASSERT_TRUE(pair_->Open().ok());
  ASSERT_TRUE(ReadFrames(Sensor::kThermal, 1));
  ASSERT_EQ(pair_->Control(RestartCamera{}), std::nullopt);
  EXPECT_TRUE(ReadAnswers(1)[0].status.ok());
  while (thermal_->opened < 2) ASSERT_TRUE(ReadFrames(Sensor::kDepth, 1));
  EXPECT_TRUE(ReadFrames(Sensor::kThermal, 5));
  EXPECT_EQ(thermal_->opened, 2);
  EXPECT_EQ(depth_->opened, 1);
}

TEST_F(CameraPairTest, AThreadThatHangsHoldsUpNeitherTheReaderNorTheOrders) {
  ASSERT_TRUE(pair_->Open().ok());
  ASSERT_TRUE(ReadFrames(Sensor::kThermal, 1));
  thermal_->blocks = true;
  for (std::size_t i = 0; i < CameraPair::kMaxOrders; ++i) {
    EXPECT_EQ(pair_->Control(TriggerNuc{}), std::nullopt);
  }
  const std::optional<Status> one_more = pair_->Control(TriggerNuc{});
  ASSERT_TRUE(one_more);
  EXPECT_THAT(one_more->message(), HasSubstr("has not answered the last 8 orders"));
  EXPECT_TRUE(ReadFrames(Sensor::kDepth, 20));
  thermal_->blocks = false;
  ReadAnswers(CameraPair::kMaxOrders);
  EXPECT_EQ(pair_->Control(TriggerNuc{}), std::nullopt) << "there is room again";
}

TEST_F(CameraPairTest, OrdersThatComeTooLateForTheCameraAreAnsweredToo) {
  ASSERT_TRUE(pair_->Open().ok());
  ASSERT_TRUE(ReadFrames(Sensor::kThermal, 1));
  pair_->Close();
  ASSERT_EQ(pair_->Control(TriggerNuc{}), std::nullopt);
  const std::vector<ControlAnswer> answers = pair_->TakeControlAnswers();
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_EQ(answers[0].status.code(), StatusCode::kUnavailable);
}

}  // namespace
}  // namespace isotherm
