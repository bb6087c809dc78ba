#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "edge/nuc/nuc_supervisor.h"
#include "edge/options/edge_options.pb.h"

namespace isotherm {

inline constexpr std::chrono::milliseconds kPeriod(25);  // 40 Hz.

/// Says what a camera shows for a while.
enum class Shows {
  kScene,     ///< The shutter is open, and the camera says nothing.
  kShutFlag,  ///< The frame says that the shutter is closed.
  kSaysIdle,  ///< A camera that tells its state in band.
  kSaysDesired,
  kSaysImminent,
  kSaysClosed,
  kSaysBlocked,
  kSaysError,
  kPolledClosed,
  kFrozen,   ///< The same image, without a word.
  kUniform,  ///< Like the shutter, without a word.
};

inline NucObservation Observe(Shows shows) {
  using enum NucState;
  NucObservation seen;
  const auto says = [&seen](NucState state, NucSource source = NucSource::kInBand) {
    seen.camera = CameraNuc{state, source, std::nullopt};
  };
  switch (shows) {
    case Shows::kScene:
      break;
    case Shows::kShutFlag:
      seen.shutter_closed = true;
      break;
    case Shows::kSaysIdle:
      says(kIdle);
      break;
    case Shows::kSaysDesired:
      says(kDesired);
      break;
    case Shows::kSaysImminent:
      says(kImminent);
      break;
    case Shows::kSaysClosed:
      says(kInProgress);
      break;
    case Shows::kSaysBlocked:
      says(kBlocked);
      break;
    case Shows::kSaysError:
      says(kError);
      break;
    case Shows::kPolledClosed:
      says(kInProgress, NucSource::kPolled);
      break;
    case Shows::kFrozen:
      seen.image.is_frozen = true;
      break;
    case Shows::kUniform:
      seen.image.is_like_shutter = true;
      break;
  }
  return seen;
}

/// Feeds a supervisor with the frames of a scripted camera.
class NucSupervisorTest : public ::testing::Test {
 protected:
  NucSupervisorTest() {
    options_.mutable_expert()->set_settle_time_s(0.5);
    options_.set_warm_up(NucOptions::IGNORE);
    options_.set_max_interval_s(0);
  }

  void Start(NucSupervisor::Role role = NucSupervisor::Role::kSupervise) {
    supervisor_ = std::make_unique<NucSupervisor>(options_, role);
  }
  /// One frame; orders are kept and, if the camera is that fast, answered with `answer_`.
  NucStatus Frame(NucObservation seen) {
    seen.time = now_;
    if (!std::isfinite(seen.housekeeping.housing_celsius))
      seen.housekeeping.housing_celsius = housing_celsius_;
    last_ = supervisor_->Update(seen);
    if (last_.order) {
      orders_.push_back({*last_.order, now_});
      if (answers_at_once_) supervisor_->OnAnswer(*last_.order, answer_);
    }
    for (NucNotice& notice : supervisor_->TakeNotices()) notices_ += notice.text + "\n";
    now_ += kPeriod;
    return last_;
  }
  NucStatus Frames(Shows shows, double seconds) {
    for (double t = 0.0; t < seconds - 1e-9; t += ToSeconds(kPeriod)) Frame(Observe(shows));
    return last_;
  }
  std::vector<CaptureTime> Triggers() const {
    std::vector<CaptureTime> times;
    for (const auto& [order, time] : orders_)
      if (order == NucOrder::kTrigger) times.push_back(time);
    return times;
  }

  NucOptions options_;
  std::unique_ptr<NucSupervisor> supervisor_;
  CaptureTime now_{std::chrono::hours(1)};
  float housing_celsius_ = 30.0F;
  Status answer_;
  bool answers_at_once_ = true;
  NucStatus last_;
  std::vector<std::pair<NucOrder, CaptureTime>> orders_;
  std::string notices_;
};

}  // namespace isotherm
