// Two ground stations follow one rig: one is served, and both know which.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "common/base/mutex.h"
#include "common/transport/testing/test_domain.h"
#include "tests/link/edge_side.h"
#include "tests/link/ground_side.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class TwoGroundsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    EdgePlan plan;
    plan.domain = domain_.number();
    plan.depth_frames = plan.thermal_frames = 10;
    PublisherHandlers handlers;
    handlers.feedback = [this](const Feedback& feedback, CaptureTime, bool) {
      MutexLock lock(mutex_);
      advised_.push_back(feedback.frame_number);
    };
    edge_ = std::make_unique<EdgeSide>(environment_, clock_, plan, handlers);
    first_ = StartGround();
    ASSERT_TRUE(edge_->publisher().WaitForGround(kLinkPatience, {}));
    edge_->Begin();
    edge_->SendFrames(0, 10);
    ASSERT_TRUE(first_->AwaitDepth(10));
    ASSERT_TRUE(AwaitWithStatuses([this] { return edge_->publisher().receipt().has_value(); }));
    second_ = StartGround();
  }
  std::unique_ptr<GroundSide> StartGround() {
    return std::make_unique<GroundSide>(environment_, clock_, domain_.number());
  }
  static std::string Problem(GroundSide& ground) { return ground.subscriber().stats().rig_problem; }
  /// The rig tells its status meanwhile, as its daemon does.
  bool AwaitWithStatuses(const std::function<bool()>& is_done) {
    const auto deadline = std::chrono::steady_clock::now() + kLinkPatience;
    while (!is_done() && std::chrono::steady_clock::now() < deadline) {
      EdgeStatus status;
      status.scan_state = ScanState::kScanning;
      CHECK(edge_->publisher().Publish(status).ok());
      std::this_thread::sleep_for(100ms);
    }
    return is_done();
  }
  static void Advise(GroundSide& ground, std::uint64_t number) {
    const auto frame = MakeFrame<EncodedDepthFrame>(1, number, 8, 6);
    Feedback feedback;
    feedback.session = 1;
    feedback.frame_number = number;
    feedback.capture_time = frame.header.capture_time;
    ASSERT_TRUE(ground.subscriber().Publish(feedback).ok());
  }
  std::vector<std::uint64_t> advised() {
    MutexLock lock(mutex_);
    return advised_;
  }

  SystemClock clock_;
  TransportEnvironment environment_{clock_};
  TestDomain domain_;
  Mutex mutex_;
  std::vector<std::uint64_t> advised_ GUARDED_BY(mutex_);
  std::unique_ptr<EdgeSide> edge_;
  std::unique_ptr<GroundSide> first_;
  std::unique_ptr<GroundSide> second_;
};

TEST_F(TwoGroundsTest, TheSecondIsToldAndHasItsTurnWhenTheFirstHasLeft) {
  ASSERT_TRUE(AwaitWithStatuses([this] { return !Problem(*second_).empty(); }));
  EXPECT_THAT(Problem(*second_), HasSubstr("THE RIG SERVES ANOTHER GROUND STATION, on \"desk\""));
  EXPECT_THAT(Problem(*first_), IsEmpty());
  // One hand cannot follow two.
  Advise(*second_, 3);
  Advise(*first_, 4);
  ASSERT_TRUE(AwaitWithStatuses([this] { return !advised().empty(); }));
  first_->Stop();
  first_.reset();
  ASSERT_TRUE(AwaitWithStatuses([this] {
    Advise(*second_, 5);  // The rig has to notice first that the other one has left.
    return advised().back() == 5;
  }));
  EXPECT_TRUE(AwaitWithStatuses([this] { return Problem(*second_).empty(); }));
  EXPECT_EQ(advised().front(), 4U);
  EXPECT_THAT(advised(), Not(Contains(3)));
}

}  // namespace
}  // namespace isotherm
