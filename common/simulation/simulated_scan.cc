#include "common/simulation/simulated_scan.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/check.h"
#include "common/base/noise.h"
#include "common/base/units.h"
#include "common/simulation/options.h"
#include "common/simulation/thermal_errors.h"

namespace isotherm {
namespace {

/// Says what a stream of random numbers is for.
enum NoisePurpose : std::uint64_t {
  kDepthPixels,
  kThermalPixels,
  kDepthClock,
  kThermalClock,
  kThermalPattern,
  kThermalFlicker
};

}  // namespace

Result<std::unique_ptr<SimulatedScan>> SimulatedScan::Create(const SimulationOptions& options) {
  if (Status status = Validate(options); !status.ok()) return Err(std::move(status));
  return Create(options, MakeScene(options.scene()));
}

Result<std::unique_ptr<SimulatedScan>> SimulatedScan::Create(const SimulationOptions& options,
                                                             StagedScene staged) {
  if (Status status = Validate(options); !status.ok()) return Err(std::move(status));
  const Result<Rig> rig = SimulatedRig(options);
  if (!rig) return Err(rig.error());
  return std::unique_ptr<SimulatedScan>(
      new SimulatedScan(Resolved(options), *rig, std::move(staged)));
}

SimulatedScan::SimulatedScan(const SimulationOptions& resolved, const Rig& rig, StagedScene staged)
    : options_(resolved),
      rig_(rig),
      staged_(std::move(staged)),
      depth_sensor_(*rig.depth, resolved.depth()),
      thermal_sensor_(*rig.thermal, resolved.thermal()),
      start_(CaptureTimeFromNanoseconds(resolved.expert().start_time_ns())) {
  ScheduleFrames();
  ScheduleShutter();
}

SimulatedScan::~SimulatedScan() = default;

void SimulatedScan::ScheduleFrames() {
  const auto schedule = [&](const ClockOptions& clock_options, double rate_hz,
                            CaptureTime first_exposure, NoisePurpose purpose) {
    SimulatedClock clock(clock_options, rate_hz, start_, first_exposure,
                         NoiseStream(options_.seed(), purpose, 0));
    const auto frames = static_cast<std::size_t>(std::lround(options_.duration_s() * rate_hz));
    std::vector<SimulatedFrameTime> times;
    for (std::size_t i = 0; i < frames; ++i) times.push_back(clock.Next());
    return times;
  };
  // Both clocks run before anything is rendered, so that frames can be rendered in any order and on
  // any thread.
  depth_times_ = schedule(options_.depth_clock(), options_.depth().rate_hz(), start_, kDepthClock);
  thermal_times_ =
      schedule(options_.thermal_clock(), options_.thermal().rate_hz(),
               start_ + FromSeconds(options_.expert().thermal_phase_s()), kThermalClock);
}

void SimulatedScan::ScheduleShutter() {
  const ShutterOptions& shutter = options_.shutter();
  if (shutter.duration_s() <= 0.0) return;
  // Otherwise it would be closed again before it has opened.
  const double interval_s = std::max(shutter.interval_s(), shutter.duration_s());
  const bool by_drift = shutter.expert().drift_k() > 0.0;
  if (!by_drift && shutter.interval_s() <= 0.0) return;
  double at_s = by_drift ? NextDrift(0.0) : shutter.first_s();
  while (at_s < options_.duration_s()) {
    const CaptureTime closed = start_ + FromSeconds(at_s);
    const double duration_s = shutter.duration_s() + shutter.expert().duration_step_s() *
                                                         static_cast<double>(nuc_events_.size());
    nuc_events_.push_back({closed, closed + FromSeconds(duration_s), NucSource::kInBand});
    const double next_s = at_s + interval_s;
    // Drift counts from when the shutter opened: that correction is the new reference.
    const double drifted_s = by_drift ? NextDrift(at_s + duration_s) : next_s;
    at_s = by_drift && shutter.interval_s() <= 0.0 ? drifted_s : std::min(next_s, drifted_s);
  }
}

double SimulatedScan::HousingCelsius(double seconds) const {
  const ThermalDriftOptions& drift = options_.drift();
  return drift.housing_celsius() +
         drift.warm_up_k() * (1.0 - std::exp(-seconds / drift.time_constant_s()));
}

double SimulatedScan::NextDrift(double after_s) const {
  constexpr double kStep_s = 0.005;  // Finer than frames are.
  const double reference = HousingCelsius(after_s);
  double at_s = after_s;
  while (at_s < options_.duration_s() &&
         std::abs(HousingCelsius(at_s) - reference) < options_.shutter().expert().drift_k()) {
    at_s += kStep_s;
  }
  return at_s;
}

double SimulatedScan::CorrectedAfter(CaptureTime time) const {
  return ToSeconds(LastOpening(time).value_or(start_) - start_);
}

double SimulatedScan::DriftErrorKelvin(CaptureTime time) const {
  return options_.drift().error_per_kelvin() *
         (HousingCelsius(ToSeconds(time - start_)) - HousingCelsius(CorrectedAfter(time)));
}

double SimulatedScan::DepthStretch(CaptureTime time) const {
  const SimulatedDepthExpertOptions& depth = options_.depth().expert();
  const double seconds = ToSeconds(time - start_);
  return 1.0 +
         depth.warm_up_stretch() * (1.0 - std::exp(-seconds / depth.warm_up_time_constant_s()));
}

bool SimulatedScan::IsShutterClosed(CaptureTime time) const {
  return std::any_of(nuc_events_.begin(), nuc_events_.end(), [&](const NucEvent& event) {
    return time >= event.start && time < event.end;
  });
}

std::optional<CaptureTime> SimulatedScan::LastOpening(CaptureTime time) const {
  std::optional<CaptureTime> opening;
  for (const NucEvent& event : nuc_events_) {
    if (event.end <= time) opening = event.end;
  }
  return opening;
}

RigidTransform SimulatedScan::PoseAt(CaptureTime time) const {
  return staged_.path.PoseAt(ToSeconds(time - start_));
}

RigidTransform SimulatedScan::ThermalPoseAt(CaptureTime time) const {
  return PoseAt(time) * rig_.T_thermal_depth->inverse();
}

RawFrame SimulatedScan::RenderDepth(std::uint64_t frame_number, Scratch& scratch) const {
  CHECK(frame_number < depth_times_.size());
  const SimulatedFrameTime& time = depth_times_[frame_number];
  RawFrame frame;
  frame.sensor = Sensor::kDepth;
  frame.frame_number = frame_number;
  frame.device_ticks = time.device_ticks;
  frame.arrival_wall = time.arrival;
  frame.depth_scale = rig_.depth_scale;
  frame.pixels = depth_sensor_.RenderMoving(
      scene(), [&](double seconds) { return PoseAt(time.exposure + FromSeconds(seconds)); },
      DepthStretch(time.exposure), NoiseStream(options_.seed(), kDepthPixels, frame_number),
      scratch.depth);
  return frame;
}

RawFrame SimulatedScan::RenderThermal(std::uint64_t frame_number, Scratch& scratch) const {
  CHECK(frame_number < thermal_times_.size());
  const SimulatedFrameTime& time = thermal_times_[frame_number];
  RawFrame frame;
  frame.sensor = Sensor::kThermal;
  frame.frame_number = frame_number;
  frame.device_ticks = time.device_ticks;
  frame.arrival_wall = time.arrival;
  frame.shutter_closed = IsShutterClosed(time.exposure);
  frame.housekeeping = HousekeepingAt(time.exposure);
  frame.thermal_scale = rig_.thermal_scale;
  frame.pixels = ThermalPixels(frame_number, scratch);
  return frame;
}

Image<std::uint16_t> SimulatedScan::ThermalPixels(std::uint64_t frame_number,
                                                  Scratch& scratch) const {
  const auto closed = [&](std::uint64_t number) {
    return IsShutterClosed(thermal_times_[number].exposure);
  };
  const bool freeze = options_.shutter().expert().appearance() == ShutterOptions::FREEZE;
  // A frozen camera repeats the last image from before the shutter closed, noise included.
  std::uint64_t shown = frame_number;
  while (freeze && shown > 0 && closed(shown)) --shown;
  const std::uint64_t noise = NoiseStream(options_.seed(), kThermalPixels, shown);
  if (closed(shown)) {
    return thermal_sensor_.RenderShutter(options_.shutter().expert().shutter_celsius(), noise,
                                         scratch.thermal);
  }
  const CaptureTime time = thermal_times_[shown].exposure;
  const auto pose_after = [&](double seconds) {
    return ThermalPoseAt(time + FromSeconds(seconds));
  };
  Image<std::uint16_t> pixels =
      staged_.carried.empty()
          ? thermal_sensor_.RenderMoving(scene(), pose_after, noise, scratch.thermal)
          : thermal_sensor_.RenderMoving(SceneAround(staged_, PoseAt(time)), pose_after, noise,
                                         scratch.thermal);
  // Added to the finished counts: the camera's own errors are not those of optics or detector.
  AddErrors(time, pixels);
  return pixels;
}

void SimulatedScan::AddErrors(CaptureTime time, Image<std::uint16_t>& temperature_raw) const {
  const SimulatedThermalExpertOptions& expert = options_.thermal().expert();
  const double corrected_s = CorrectedAfter(time);
  const double since_s = ToSeconds(time - start_) - corrected_s;
  // Each correction takes the pattern out; another one grows.
  const auto epoch = static_cast<std::uint64_t>(std::llround(corrected_s * kMsPerS));
  AddPattern(expert.pattern_k_per_sqrt_minute() * std::sqrt(since_s / kSPerMin),
             NoiseStream(options_.seed(), kThermalPattern, epoch), rig_.thermal_scale,
             temperature_raw);
  const double flicker_k =
      FlickerKelvin(expert.flicker_k(), expert.flicker_memory_s(), ToSeconds(time - start_),
                    NoiseStream(options_.seed(), kThermalFlicker, 0));
  AddKelvin(DriftErrorKelvin(time) + flicker_k, rig_.thermal_scale, temperature_raw);
}

ThermalHousekeeping SimulatedScan::HousekeepingAt(CaptureTime time) const {
  // The detector of an uncooled camera runs a few kelvins above its housing; only the change of
  // either is ever used.
  constexpr double kFpaAboveHousing_k = 4.0;
  ThermalHousekeeping housekeeping;
  housekeeping.housing_celsius = static_cast<float>(HousingCelsius(ToSeconds(time - start_)));
  housekeeping.fpa_celsius = housekeeping.housing_celsius + static_cast<float>(kFpaAboveHousing_k);
  housekeeping.shutter_celsius = static_cast<float>(options_.shutter().expert().shutter_celsius());
  return housekeeping;
}

}  // namespace isotherm
