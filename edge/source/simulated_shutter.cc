#include "edge/source/simulated_shutter.h"

#include "common/base/noise.h"
#include "common/simulation/options.h"
#include "common/simulation/simulated_scan.h"
#include "common/simulation/thermal_errors.h"

namespace isotherm {

SimulatedShutter::SimulatedShutter(const SimulationOptions& options)
    : options_(Resolved(options)) {}

SimulatedShutter::~SimulatedShutter() = default;

Status SimulatedShutter::Control(const CameraControl& control) {
  const ShutterOptions& shutter = options_.shutter();
  if (std::holds_alternative<TriggerNuc>(control)) {
    ordered_ = shutter.expert().follows_orders();
    return OkStatus();
  }
  if (const auto* automatic = std::get_if<SetAutomaticNuc>(&control)) {
    // A camera that cannot be told to stop correcting itself says so, and so does this one.
    const bool has_own = shutter.interval_s() > 0.0 || shutter.expert().drift_k() > 0.0;
    if (automatic->on || !has_own) return OkStatus();
    return FailedPrecondition(
        "they are part of the rendered scan (simulation.shutter.interval_s, drift_k)");
  }
  return OkStatus();
}

void SimulatedShutter::Apply(RawFrame& frame) {
  const CaptureTime time = frame.arrival_wall;
  if (!scan_reference_celsius_) scan_reference_celsius_ = frame.housekeeping.housing_celsius;
  FollowOrder(time);
  // The scan's own closings come first: their images are already there.
  closed_by_scan_ = frame.shutter_closed;
  const bool closed = closed_by_scan_ || opens_at_.has_value();
  if (was_closed_ && !closed) opened_at_ = time;
  was_closed_ = closed;
  if (closed) {
    Correct(frame);
    if (!closed_by_scan_) ShowShutter(frame);
  } else {
    AddKelvin(correction_k_, frame.thermal_scale, frame.pixels);
    last_open_ = frame.pixels;
  }
  Say(frame, closed);
}

void SimulatedShutter::FollowOrder(CaptureTime time) {
  if (ordered_) closes_at_ = time + FromSeconds(options_.shutter().expert().order_delay_s());
  ordered_ = false;
  if (closes_at_ && time >= *closes_at_) {
    opens_at_ = time + FromSeconds(options_.shutter().duration_s());
    closes_at_.reset();
  }
  if (opens_at_ && time >= *opens_at_) opens_at_.reset();
}

void SimulatedShutter::Correct(const RawFrame& frame) {
  const float housing_celsius = frame.housekeeping.housing_celsius;
  if (closed_by_scan_) {
    // The rendered drift begins anew with each closing of the scan.
    scan_reference_celsius_ = housing_celsius;
    correction_k_ = 0.0;
    return;
  }
  correction_k_ = options_.drift().error_per_kelvin() *
                  static_cast<double>(*scan_reference_celsius_ - housing_celsius);
}

void SimulatedShutter::ShowShutter(RawFrame& frame) const {
  const ShutterOptions& shutter = options_.shutter();
  if (shutter.expert().appearance() == ShutterOptions::FREEZE) {
    // As cameras do that repeat the last image while they correct.
    if (!last_open_.empty()) frame.pixels = last_open_;
    return;
  }
  const double celsius = shutter.expert().shutter_celsius();
  const auto pixels = frame.pixels.pixels();
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const double noise_k =
        options_.thermal().expert().netd_kelvin() *
        static_cast<double>(NormalNoise(NoiseStream(options_.seed(), 0, frame.frame_number), i));
    pixels[i] = frame.thermal_scale.NearestCountOf(celsius + noise_k);
  }
}

void SimulatedShutter::Say(RawFrame& frame, bool closed) {
  // Then the edge must infer the shutter from the images, which this is to try.
  if (!options_.shutter().expert().reports_shutter()) {
    frame.shutter_closed = false;
    frame.camera_nuc.reset();
    return;
  }
  frame.shutter_closed = closed;
  CameraNuc nuc;
  nuc.state = closed ? NucState::kInProgress : NucState::kIdle;
  nuc.source = NucSource::kInBand;
  if (!closed && opened_at_) nuc.seconds_since = ToSeconds(frame.arrival_wall - *opened_at_);
  frame.camera_nuc = nuc;
}

}  // namespace isotherm
