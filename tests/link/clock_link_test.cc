// Row F18 over DDS on loopback: the ground compares the rig's clock with its own.
#include <gtest/gtest.h>

#include <condition_variable>
#include <memory>
#include <optional>

#include "common/base/mutex.h"
#include "common/transport/testing/test_domain.h"
#include "ground/subscriber/subscriber.h"
#include "tests/link/edge_side.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;

/// The clocks of a computer whose wall clock is wrong.
class WrongClock final : public Clock {
 public:
  explicit WrongClock(Nanoseconds ahead) : ahead_(ahead) {}
  CaptureTime Now() const override { return right_.Now() + ahead_; }
  SteadyTime SteadyNow() const override { return right_.SteadyNow(); }

 private:
  const SystemClock right_{};
  const Nanoseconds ahead_;
};

class ClockLinkTest : public ::testing::Test {
 protected:
  /// Statuses of a rig whose clock is `ahead` until the ground has compared; what it then thinks.
  std::optional<SessionClock> Compare(Nanoseconds ahead) {
    auto participant = std::move(*Participant::Create(environment_, domain_.number()));
    SubscriberOptions options;
    options.edge_id = "test-edge";
    SubscriberHandlers handlers;
    handlers.clock = [this](const SessionClock& counters) {
      MutexLock lock(mutex_);
      if (counters.offset) counters_ = counters;
      changed_.notify_all();
    };
    const auto subscriber =
        std::move(*Subscriber::Create(*participant, clock_, options, std::move(handlers)));
    std::jthread receiver([&](const std::stop_token& stop) { subscriber->Run(stop); });

    const WrongClock wrong(ahead);
    EdgePlan plan;
    plan.domain = domain_.number();
    EdgeSide edge(environment_, wrong, plan);
    EXPECT_TRUE(edge.publisher().WaitForGround(kLinkPatience, {}));
    edge.Begin();
    EdgeStatus status;
    status.scan_state = ScanState::kScanning;
    status.clock.synchronised = true;
    const auto deadline = std::chrono::steady_clock::now() + kLinkPatience;
    MutexLock lock(mutex_);
    while (!counters_ && std::chrono::steady_clock::now() < deadline) {
      lock.unlock();
      EXPECT_TRUE(edge.publisher().Publish(status).ok());
      lock.lock();
      changed_.wait_for(lock, 100ms);
    }
    return counters_;
  }

  SystemClock clock_;
  TransportEnvironment environment_{clock_};
  TestDomain domain_;
  Mutex mutex_;
  std::condition_variable_any changed_;
  std::optional<SessionClock> counters_ GUARDED_BY(mutex_);
};

TEST_F(ClockLinkTest, F18AClockThatIsAheadIsMeasuredAndAlarmed) {
  const auto counters = Compare(3600s);
  ASSERT_TRUE(counters.has_value());
  EXPECT_TRUE(counters->alarm);
  EXPECT_NEAR(counters->offset->offset_s, 3600.0, counters->offset->uncertainty_s);
}

TEST_F(ClockLinkTest, F18AClockThatIsBehindIsMeasuredAndAlarmed) {
  const auto counters = Compare(-3600s);
  ASSERT_TRUE(counters.has_value());
  EXPECT_TRUE(counters->alarm);
  EXPECT_NEAR(counters->offset->offset_s, -3600.0, counters->offset->uncertainty_s);
}

TEST_F(ClockLinkTest, F18ARightClockIsNoAlarm) {
  const auto counters = Compare(0s);
  ASSERT_TRUE(counters.has_value());
  EXPECT_FALSE(counters->alarm);
  EXPECT_NEAR(counters->offset->offset_s, 0.0, counters->offset->uncertainty_s);
}

}  // namespace
}  // namespace isotherm
