#include "ground/evaluation/stamping_trial.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/base/check.h"
#include "common/base/noise.h"
#include "common/stamping/envelope_clock.h"
#include "common/stamping/median_clock.h"
#include "common/stamping/period_tracker.h"

namespace isotherm {
namespace {

constexpr CaptureTime kStart{std::chrono::seconds(1'700'000'000)};
// A transport of usual length; it is the same for all methods, and taken out as their constant
// delay.
constexpr double kTransport_s = 0.012;
// A frame that waited for the one before.
constexpr double kTransfer_s = 50e-6;
// A camera's crystal follows the temperature of its housing within minutes.
constexpr double kWanderPeriod_s = 300.0;
// As TimestamperOptions has them: half a second.
constexpr double kMedianWindow_s = 0.5;

struct SimulatedFrame {
  std::uint64_t number = 0;
  CaptureTime exposure;
  DeviceTicks ticks;
  CaptureTime arrival;
};

/// One camera's frames on their way to the computer. Thread-compatible.
class SimulatedTransport {
 public:
  SimulatedTransport(const StampingScenario& scenario, const StampingTrialOptions& options, int run)
      : scenario_(scenario),
        period_s_(1.0 / options.rate_hz),
        stream_(NoiseStream(options.seed, 0x7354616d70, static_cast<std::uint64_t>(run))),
        drift_(1e-6 * options.max_drift_ppm * (2.0 * Uniform() - 1.0)),
        wander_(1e-6 * options.wander_ppm),
        wander_phase_(2.0 * std::numbers::pi * Uniform()),
        phase_s_(period_s_ * Uniform()) {}

  SimulatedFrame Next() {
    SimulatedFrame frame;
    frame.number = number_++;
    const double exposure_s = phase_s_ + static_cast<double>(frame.number) * period_s_;
    // The camera's clock runs by 1 + drift + wander(t): its integral.
    const double angle = 2.0 * std::numbers::pi / kWanderPeriod_s;
    const double device_s = exposure_s * (1.0 + drift_) -
                            wander_ / angle * std::cos(angle * exposure_s + wander_phase_);
    const double arrival_s =
        std::max(exposure_s + kTransport_s + Delay(exposure_s), last_arrival_s_ + kTransfer_s);
    last_arrival_s_ = arrival_s;
    frame.exposure = kStart + FromSeconds(exposure_s);
    frame.ticks = DeviceTicks(std::chrono::microseconds(std::llround(1e6 * device_s)));
    frame.arrival = kStart + FromSeconds(arrival_s);
    return frame;
  }

 private:
  double Uniform() { return UniformNoise(stream_, counter_++); }
  double Exponential(double mean) { return -mean * std::log1p(-Uniform()); }

  double Delay(double time_s) {
    double delay_s = Baseline();
    if (Uniform() < scenario_.impulse_fraction) delay_s += scenario_.impulse_max_s * Uniform();
    if (scenario_.burst_period_s > 0.0) {
      const double since_s =
          std::fmod(time_s + 0.5 * scenario_.burst_period_s, scenario_.burst_period_s);
      if (since_s < scenario_.burst_length_s && time_s > 0.25 * scenario_.burst_period_s)
        delay_s += scenario_.burst_least_s + Exponential(scenario_.burst_mean_s);
    }
    return delay_s;
  }

  double Baseline() {
    switch (scenario_.shape) {
      case JitterShape::kGamma:
        return Exponential(scenario_.jitter_s) + Exponential(scenario_.jitter_s);
      case JitterShape::kExponential:
        return Exponential(scenario_.jitter_s);
      case JitterShape::kNormal:
        break;
    }
    // An arrival is never early: the normal distribution is shifted by four sigmas, and the rest (3
    // of 100 000) is cut.
    constexpr double kCutSigmas = 4.0;
    const auto normal = static_cast<double>(NormalNoise(stream_, counter_++));
    return scenario_.jitter_s * std::max(0.0, kCutSigmas + normal);
  }

  const StampingScenario scenario_;
  const double period_s_;
  const std::uint64_t stream_;
  std::uint64_t counter_ = 0;
  const double drift_, wander_, wander_phase_, phase_s_;
  std::uint64_t number_ = 0;
  double last_arrival_s_ = -1.0;
};

/// The stamps of one method.
class Stamper {
 public:
  Stamper(StampingMethod method, double rate_hz)
      : method_(method),
        median_(MedianWindow(rate_hz)),
        envelope_(EnvelopeOptions{.median_window = MedianWindow(rate_hz)}),
        period_(EnvelopeOptions{.median_window = MedianWindow(rate_hz)}) {}

  Stamp Process(const SimulatedFrame& frame) {
    switch (method_) {
      case StampingMethod::kMedian:
        return median_.Process(frame.ticks, frame.arrival);
      case StampingMethod::kEnvelope:
        return envelope_.Process(frame.ticks, frame.arrival);
      case StampingMethod::kPeriod:
        return period_.Process(frame.number, frame.arrival);
      case StampingMethod::kArrival:
        break;
    }
    return {.time = frame.arrival};
  }

 private:
  static int MedianWindow(double rate_hz) {
    return 2 * static_cast<int>(kMedianWindow_s * rate_hz / 2.0) + 1;
  }

  const StampingMethod method_;
  MedianClock median_;
  EnvelopeClock envelope_;
  PeriodTracker period_;
};

struct Residual {
  double late_s = 0.0;
  double sigma_s = 0.0;
};

std::vector<Residual> Residuals(const StampingScenario& scenario, StampingMethod method,
                                const StampingTrialOptions& options) {
  std::vector<Residual> residuals;
  for (int run = 0; run < options.runs; ++run) {
    SimulatedTransport transport(scenario, options, run);
    Stamper stamper(method, options.rate_hz);
    const int frames = static_cast<int>(options.duration_s * options.rate_hz);
    for (int i = 0; i < frames; ++i) {
      const SimulatedFrame frame = transport.Next();
      const Stamp stamp = stamper.Process(frame);
      if (ToSeconds(frame.exposure - kStart) < options.skip_s) continue;
      residuals.push_back({ToSeconds(stamp.time - frame.exposure), ToSeconds(stamp.sigma)});
    }
  }
  return residuals;
}

double Quantile(std::vector<double> values, double fraction) {
  CHECK(!values.empty());
  const auto rank = static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

double MedianLateness(const std::vector<Residual>& residuals) {
  std::vector<double> late_s;
  late_s.reserve(residuals.size());
  for (const Residual& residual : residuals) late_s.push_back(residual.late_s);
  return Quantile(std::move(late_s), 0.5);
}

}  // namespace

std::vector<StampingScenario> StampingScenarios() {
  const StampingScenario usual{.name = "usual"};
  const StampingScenario bursts{.name = "load bursts",
                                .burst_period_s = 40.0,
                                .burst_length_s = 10.0,
                                .burst_least_s = 0.005,
                                .burst_mean_s = 0.010};
  const StampingScenario exponential{
      .name = "exponential", .shape = JitterShape::kExponential, .jitter_s = 0.002};
  const StampingScenario normal{.name = "normal", .shape = JitterShape::kNormal};
  return {usual, bursts, exponential, normal};
}

std::string_view ToString(StampingMethod method) {
  switch (method) {
    case StampingMethod::kArrival:
      return "raw arrival";
    case StampingMethod::kMedian:
      return "median";
    case StampingMethod::kEnvelope:
      return "envelope";
    case StampingMethod::kPeriod:
      return "no device clock";
  }
  return "?";
}

StampingResidual RunStampingTrial(const StampingScenario& scenario, StampingMethod method,
                                  const StampingTrialOptions& options) {
  const std::vector<Residual> residuals = Residuals(scenario, method, options);
  StampingScenario without_bursts = scenario;
  without_bursts.burst_period_s = 0.0;
  const double delay_s = MedianLateness(
      scenario.burst_period_s > 0.0 ? Residuals(without_bursts, method, options) : residuals);
  StampingResidual result;
  std::vector<double> absolute_s;
  double squares = 0.0, within_sigma = 0.0, within_3_sigma = 0.0;
  for (const Residual& residual : residuals) {
    const double error_s = std::abs(residual.late_s - delay_s);
    absolute_s.push_back(error_s);
    squares += error_s * error_s;
    within_sigma += error_s <= residual.sigma_s ? 1.0 : 0.0;
    within_3_sigma += error_s <= 3.0 * residual.sigma_s ? 1.0 : 0.0;
  }
  const auto count = static_cast<double>(absolute_s.size());
  result.stamps = absolute_s.size();
  result.rms_s = std::sqrt(squares / count);
  result.within_sigma = within_sigma / count;
  result.within_3_sigma = within_3_sigma / count;
  result.worst_s = *std::max_element(absolute_s.begin(), absolute_s.end());
  result.p99_s = Quantile(std::move(absolute_s), 0.99);
  return result;
}

}  // namespace isotherm
