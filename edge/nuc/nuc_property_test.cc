// What must hold whatever cameras and operators do.

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "common/testing/test_seed.h"
#include "edge/nuc/nuc_supervisor.h"
#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

constexpr int kScans = 200;
constexpr int kFrames = 4000;  // 100 s at 40 Hz.

/// A camera whose shutter closes when it likes, or some frames after an order, or not at all.
class WilfulCamera {
 public:
  WilfulCamera(std::mt19937& random, bool reports_shutter)
      : random_(random), reports_shutter_(reports_shutter) {}

  void Order() {
    if (Chance(0.7)) closes_in_ = Pick(0, 30);
  }
  NucObservation Next(CaptureTime time) {
    if (closes_in_ > 0) --closes_in_;
    if (closes_in_ == 0 || Chance(0.001)) {
      open_in_ = Chance(0.02) ? Pick(200, 800) : Pick(10, 60);
      closes_in_ = -1;
    }
    if (open_in_ > 0) --open_in_;
    NucObservation seen;
    seen.time = time;
    seen.shutter_closed = open_in_ > 0;
    housing_celsius_ += Chance(0.5) ? 0.002F : -0.001F;
    seen.housekeeping.housing_celsius = housing_celsius_;
    if (reports_shutter_)
      seen.camera = CameraNuc{seen.shutter_closed ? NucState::kInProgress : NucState::kIdle,
                              NucSource::kInBand, std::nullopt};
    return seen;
  }
  bool Chance(double probability) { return std::bernoulli_distribution(probability)(random_); }
  int Pick(int first, int last) { return std::uniform_int_distribution(first, last)(random_); }

 private:
  std::mt19937& random_;
  const bool reports_shutter_;
  int closes_in_ = -1;
  int open_in_ = 0;
  float housing_celsius_ = 30.0F;
};

TEST(NucProperties, F07NoFrameFromClosingToTheEndOfSettlingIsValidAndOrdersKeepTheirDistance) {
  std::mt19937 random(testing::Seed());
  for (int scan = 0; scan < kScans; ++scan) {
    NucOptions options;
    options.set_before_scan(scan % 2 == 0);
    options.mutable_expert()->set_max_housing_drift_k(scan % 3 == 0 ? 0.2 : 0.0);
    options.set_max_interval_s(scan % 5 == 0 ? 12.0 : 0.0);
    NucSupervisor supervisor(options, NucSupervisor::Role::kSupervise);
    WilfulCamera camera(random, scan % 2 == 0);
    const Nanoseconds settle = FromSeconds(options.expert().settle_time_s());
    const Nanoseconds apart = FromSeconds(options.expert().min_interval_s());
    CaptureTime now{std::chrono::hours(1)};
    CaptureTime last_closed{}, last_order{};
    struct Answer {
      NucOrder order;
      int frame;  ///< At which it comes.
    };
    std::vector<Answer> answers;
    for (int i = 0; i < kFrames; ++i) {
      now += std::chrono::milliseconds(camera.Pick(20, 30));
      const NucObservation seen = camera.Next(now);
      if (seen.shutter_closed) last_closed = now;
      const NucStatus status = supervisor.Update(seen);
      // The last closed frame is no earlier than a frame before the opening.
      ASSERT_FALSE(status.valid && now - last_closed < settle)
          << "scan " << scan << " frame " << i << ": " << ToSeconds(now - last_closed)
          << " s after the shutter was closed";
      if (status.order == NucOrder::kTrigger) {
        ASSERT_GE(now - last_order, apart) << "scan " << scan << " frame " << i;
        ASSERT_FALSE(seen.shutter_closed);
        last_order = now;
        camera.Order();
      }
      if (status.order) answers.push_back({*status.order, i + std::max(0, camera.Pick(-10, 10))});
      std::erase_if(answers, [&](const Answer& answer) {
        if (answer.frame > i) return false;
        supervisor.OnAnswer(answer.order, camera.Chance(0.1) ? IoError("it stalls") : OkStatus());
        return true;
      });
      if (camera.Chance(0.005)) static_cast<void>(supervisor.Request());
      if (camera.Chance(0.002)) static_cast<void>(supervisor.Hold(camera.Pick(0, 100)));
      if (camera.Chance(0.001))
        static_cast<void>(supervisor.SetPolicy(static_cast<NucPolicy>(camera.Pick(0, 2))));
      static_cast<void>(supervisor.TakeNotices());
    }
  }
}

}  // namespace
}  // namespace isotherm
