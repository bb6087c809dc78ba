#include "ground/service/arrival_ages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "common/base/units.h"

namespace isotherm {
namespace {

/// No live frame is under way for that long: a recording of another day is played.
constexpr double kMaxAge_s = 60.0;
constexpr double kMedian = 50.0, kWorst = 99.0;

Json DescribeAges(const StageStats& ages) {
  return {{"frames", ages.count()},
          {"p50_ms", ages.Percentile(kMedian)},
          {"p99_ms", ages.Percentile(kWorst)},
          {"max_ms", ages.max_ms()}};
}

}  // namespace

void ArrivalAges::SetClock(const SessionClock& clock) {
  difference_.reset();
  if (!clock.offset) return;
  // Capture times do not follow the steps of the rig's clock, which the comparison sees.
  difference_ = {.seconds = clock.offset->offset_s - clock.rig.step_sum_s,
                 .uncertainty_s = clock.offset->uncertainty_s};
}

void ArrivalAges::Add(Sensor sensor, CaptureTime capture, CaptureTime arrival) {
  if (!difference_) return;
  const double age_s = ToSeconds(arrival - capture) + difference_->seconds;
  if (std::abs(age_s) > kMaxAge_s) return;
  largest_uncertainty_s_ = std::max(largest_uncertainty_s_, difference_->uncertainty_s);
  StageStats& ages = sensor == Sensor::kDepth ? depth_ : thermal_;
  ages.Add(kMsPerS * age_s);
}

Json ArrivalAges::Describe() const {
  if (depth_.count() + thermal_.count() == 0) return nullptr;
  return {{"depth", DescribeAges(depth_)},
          {"thermal", DescribeAges(thermal_)},
          {"uncertainty_ms", kMsPerS * largest_uncertainty_s_}};
}

std::string ArrivalAges::ToText() const {
  if (depth_.count() + thermal_.count() == 0) return {};
  return fmt::format(
      "arrival  from capture to here, depth p50 {:.0f} ms, p99 {:.0f} ms; thermal {:.0f}, {:.0f} "
      "ms; "
      "within {:.1f} ms, as far as the clocks could be compared\n",
      depth_.Percentile(kMedian), depth_.Percentile(kWorst), thermal_.Percentile(kMedian),
      thermal_.Percentile(kWorst), kMsPerS * largest_uncertainty_s_);
}

}  // namespace isotherm
