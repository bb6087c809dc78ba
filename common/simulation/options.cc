#include "common/simulation/options.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "common/base/units.h"
#include "common/radiometry/radiometry.h"
#include "common/rig/rig_calibration.h"
#include "common/simulation/simulation_options.pb.h"

namespace isotherm {
namespace {

/// Collects the first violated range.
class RangeCheck {
 public:
  void operator()(const char* field, double value, double low, double high) {
    if (!status_.ok() || (value >= low && value <= high)) return;
    status_ = InvalidArgument(
        fmt::format("simulation.{} must be {}..{}, got {}", field, low, high, value));
  }
  /// `text` says what must be.
  void Require(bool is_so, const char* text) {
    if (status_.ok() && !is_so) status_ = InvalidArgument(fmt::format("simulation.{}", text));
  }
  Status status() const { return status_; }

 private:
  Status status_;
};

void CheckDepth(const SimulatedDepthOptions& depth, RangeCheck& check) {
  check("depth.rate_hz", depth.rate_hz(), 0.1, 1000.0);
  check("depth.expert.baseline_m", depth.expert().baseline_m(), 0.001, 10.0);
  check("depth.expert.disparity_step_px", depth.expert().disparity_step_px(), 0.0, 10.0);
  check("depth.expert.disparity_noise_px", depth.expert().disparity_noise_px(), 0.0, 10.0);
  check("depth.expert.min_depth_m", depth.expert().min_depth_m(), 0.0, 100.0);
  check("depth.expert.max_depth_m", depth.expert().max_depth_m(), depth.expert().min_depth_m(),
        100.0);
  check("depth.expert.grazing_start_deg", depth.expert().grazing_start_deg(), 0.0, 90.0);
  check("depth.expert.grazing_end_deg", depth.expert().grazing_end_deg(),
        depth.expert().grazing_start_deg(), 90.0);
  check("depth.expert.edge_dropout", depth.expert().edge_dropout(), 0.0, 1.0);
  check("depth.expert.depth_scale", depth.expert().depth_scale(), 1.0, 1e6);
  check("depth.expert.flying_fraction", depth.expert().flying_fraction(), 0.0, 1.0);
  check("depth.expert.readout_s", depth.expert().readout_s(), 0.0, 1.0);
  check("depth.expert.warm_up_stretch", depth.expert().warm_up_stretch(), -0.1, 0.1);
  check("depth.expert.corner_swelling", depth.expert().corner_swelling(), -0.1, 0.1);
  check("depth.expert.warm_up_time_constant_s", depth.expert().warm_up_time_constant_s(), 0.01,
        360'000.0);
}

void CheckRays(const SimulatedThermalExpertOptions& expert, RangeCheck& check) {
  const SimulatedLensOptions& lens = expert.lens();
  check("thermal.expert.rays_per_pixel_side", expert.rays_per_pixel_side(), 1.0, 16.0);
  check("thermal.expert.lens.focus_m", lens.focus_m(), 0.0, 1000.0);
  check("thermal.expert.lens.focal_length_mm", lens.focal_length_mm(), 0.1, 1000.0);
  check("thermal.expert.lens.f_number", lens.f_number(), 0.1, 1000.0);
  check.Require(expert.time_constant_s() == 0.0 || expert.rays_per_pixel_side() >= 3,
                "thermal.expert.rays_per_pixel_side must be 3 or more with time_constant_s: the "
                "rays are spread over time, too");
  if (lens.focus_m() == 0.0) return;
  check.Require(lens.focus_m() > 2.0 * kMPerMm * lens.focal_length_mm(),
                "thermal.expert.lens.focus_m must be 0 (sharp everywhere) or more than twice the "
                "focal length");
  check.Require(expert.rays_per_pixel_side() >= 3,
                "thermal.expert.rays_per_pixel_side must be 3 or more with lens.focus_m: the rays "
                "are spread over the lens, too");
}

void CheckThermal(const SimulatedThermalOptions& thermal, RangeCheck& check) {
  check("thermal.rate_hz", thermal.rate_hz(), 0.1, 1000.0);
  check("thermal.max_celsius", thermal.max_celsius(), 50.0, kMaxRadiometric_celsius);
  check("thermal.expert.netd_kelvin", thermal.expert().netd_kelvin(), 0.0, 10.0);
  check("thermal.expert.blur_px", thermal.expert().blur_px(), 0.0, 10.0);
  check("thermal.expert.band_min_um", thermal.expert().band_min_um(), 0.5, 100.0);
  check("thermal.expert.band_max_um", thermal.expert().band_max_um(),
        thermal.expert().band_min_um() + 0.01, 200.0);
  check("thermal.expert.time_constant_s", thermal.expert().time_constant_s(), 0.0, 1.0);
  check("thermal.expert.readout_s", thermal.expert().readout_s(), 0.0, 1.0);
  check("thermal.expert.pattern_k_per_sqrt_minute", thermal.expert().pattern_k_per_sqrt_minute(),
        0.0, 10.0);
  check("thermal.expert.flicker_k", thermal.expert().flicker_k(), 0.0, 10.0);
  check("thermal.expert.flicker_memory_s", thermal.expert().flicker_memory_s(), 0.001, 1000.0);
  const SceneInfluenceOptions& influence = thermal.expert().scene_influence();
  check("thermal.expert.scene_influence.near_fraction", influence.near_fraction(), 0.0,
        SceneInfluence::kMaxFraction);
  check("thermal.expert.scene_influence.near_sigma_px", influence.near_sigma_px(),
        SceneInfluence::kMinSigma_px, SceneInfluence::kMaxSigma_px);
  check("thermal.expert.scene_influence.total_fraction", influence.total_fraction(), 0.0,
        SceneInfluence::kMaxFraction);
  check("thermal.expert.offset_error_k", thermal.expert().offset_error_k(), -50.0, 50.0);
  check("thermal.expert.gain_error", thermal.expert().gain_error(), -0.2, 0.2);
  CheckRays(thermal.expert(), check);
}

SimulationOptions WithCamerasAsAsked(const SimulationOptions& options) {
  SimulationOptions filled = options;
  if (options.has_ideal_cameras() && !options.ideal_cameras()) return filled;
  *filled.mutable_thermal() = IdealThermalCamera(options.thermal());
  *filled.mutable_depth() = IdealDepthCamera(options.depth());
  filled.mutable_drift()->set_error_per_kelvin(
      options.drift().has_error_per_kelvin() ? options.drift().error_per_kelvin() : 0.0);
  return filled;
}

void CheckClock(const std::string& name, const ClockOptions& clock, RangeCheck& check) {
  check((name + ".drift_ppm").c_str(), clock.drift_ppm(), -1e5, 1e5);
  check((name + ".delay_s").c_str(), clock.delay_s(), 0.0, 10.0);
  check((name + ".jitter_s").c_str(), clock.jitter_s(), 0.0, 1.0);
  check((name + ".impulse_fraction").c_str(), clock.impulse_fraction(), 0.0, 1.0);
  check((name + ".impulse_max_s").c_str(), clock.impulse_max_s(), 0.0, 10.0);
}

void SetClock(double offset_s, double drift_ppm, double delay_s, double jitter_s,
              double impulse_fraction, double impulse_max_s, ClockOptions& clock) {
  clock.set_offset_s(offset_s);
  clock.set_drift_ppm(drift_ppm);
  clock.set_delay_s(delay_s);
  clock.set_jitter_s(jitter_s);
  clock.set_impulse_fraction(impulse_fraction);
  clock.set_impulse_max_s(impulse_max_s);
}

}  // namespace

Status Validate(const SimulationOptions& as_given) {
  const SimulationOptions options = WithCamerasAsAsked(as_given);
  RangeCheck check;
  check("duration_s", options.duration_s(), 0.0, kSPerHour);
  const SceneOptions& scene = options.scene();
  check("scene.surround_celsius", scene.surround_celsius(), kMinRadiometric_celsius,
        kMaxRadiometric_celsius);
  // The hottest parts of a scene are never hotter than this, the coldest not colder than the
  // surroundings.
  if (scene.has_hot_celsius()) check("scene.hot_celsius", scene.hot_celsius(), 0.0, 1400.0);
  check("scene.hole_radius_m", scene.hole_radius_m(), 0.002, 0.4);
  CheckDepth(options.depth(), check);
  CheckThermal(options.thermal(), check);
  const ShutterOptions& shutter = options.shutter();
  check("shutter.first_s", shutter.first_s(), 0.0, kSPerHour);
  check("shutter.interval_s", shutter.interval_s(), 0.0, kSPerHour);
  check("shutter.duration_s", shutter.duration_s(), 0.0, kSPerHour);
  check("shutter.expert.duration_step_s", shutter.expert().duration_step_s(), 0.0, kSPerHour);
  check("shutter.expert.shutter_celsius", shutter.expert().shutter_celsius(),
        kMinRadiometric_celsius, kMaxRadiometric_celsius);
  check("shutter.expert.drift_k", shutter.expert().drift_k(), 0.0, 100.0);
  check("shutter.expert.order_delay_s", shutter.expert().order_delay_s(), 0.0, 60.0);
  const ThermalDriftOptions& drift = options.drift();
  check("drift.housing_celsius", drift.housing_celsius(), -60.0, 120.0);
  check("drift.warm_up_k", drift.warm_up_k(), -100.0, 100.0);
  check("drift.time_constant_s", drift.time_constant_s(), 0.01, 100.0 * kSPerHour);
  check("drift.error_per_kelvin", drift.error_per_kelvin(), -100.0, 100.0);
  CheckClock("depth_clock", options.depth_clock(), check);
  CheckClock("thermal_clock", options.thermal_clock(), check);
  const OdometryOptions& odometry = options.odometry();
  check("odometry.rate_hz", odometry.rate_hz(), 0.0, 1000.0);
  check("odometry.scale_error", odometry.scale_error(), -0.9, 10.0);
  check("odometry.position_sigma_m", odometry.position_sigma_m(), 0.0, 1.0);
  check("odometry.rotation_sigma_deg", odometry.rotation_sigma_deg(), 0.0, 45.0);
  check("thermal_phase_s", options.expert().thermal_phase_s(), 0.0, 10.0);
  return check.status();
}

SimulationOptions Resolved(const SimulationOptions& options) {
  SimulationOptions resolved = WithCamerasAsAsked(options);
  if (!options.has_depth_clock()) {
    // Clocks of two real cameras differ in everything. These are of the size that the thesis
    // measured (5.3): ticks from arbitrary zeros, tens of ppm, delays of some 20 and 30 ms, jitter
    // of a millisecond, one or two frames in a hundred held up longer.
    SetClock(1000.0, 18.0, 0.021, 0.0012, 0.015, 0.030, *resolved.mutable_depth_clock());
  }
  if (!options.has_thermal_clock()) {
    SetClock(52.0, -31.0, 0.034, 0.0016, 0.02, 0.045, *resolved.mutable_thermal_clock());
  }
  return resolved;
}

SimulatedThermalOptions IdealThermalCamera(const SimulatedThermalOptions& set) {
  SimulatedThermalOptions ideal;
  SimulatedThermalExpertOptions& expert = *ideal.mutable_expert();
  // Inertia and defocus, where they are asked for, take several rays.
  if (!set.expert().has_time_constant_s() && !set.expert().lens().has_focus_m())
    expert.set_rays_per_pixel_side(1);
  expert.mutable_lens()->set_focus_m(0.0);
  expert.set_time_constant_s(0.0);
  expert.set_readout_s(0.0);
  expert.set_pattern_k_per_sqrt_minute(0.0);
  expert.set_flicker_k(0.0);
  expert.mutable_scene_influence()->set_near_fraction(0.0);
  expert.mutable_scene_influence()->set_total_fraction(0.0);
  // What was set by hand wins over what an ideal camera has.
  ideal.MergeFrom(set);
  return ideal;
}

SimulatedDepthOptions IdealDepthCamera(const SimulatedDepthOptions& set) {
  SimulatedDepthOptions ideal;
  SimulatedDepthExpertOptions& expert = *ideal.mutable_expert();
  expert.set_flying_fraction(0.0);
  expert.set_readout_s(0.0);
  expert.set_warm_up_stretch(0.0);
  ideal.MergeFrom(set);
  return ideal;
}

Rig DefaultSimulatedRig() {
  Rig rig;
  CameraModel depth;
  depth.width = 640;
  depth.height = 480;
  // Cameras like the thesis's: a PrimeSense Carmine and an Optris PI 450, some centimetres apart,
  // with its wide lens's distortion. Principal points and rotation are off centre on purpose, so
  // that mixed-up axes show.
  depth.fx = depth.fy = 567.7;
  depth.cx = 321.3;
  depth.cy = 242.4;
  CameraModel thermal;
  thermal.width = 382;
  thermal.height = 288;
  thermal.fx = 371.4;
  thermal.fy = 372.1;
  thermal.cx = 205.5;
  thermal.cy = 150.5;
  thermal.k1 = -0.439;
  thermal.k2 = 0.29;
  thermal.p1 = 0.000454;
  thermal.p2 = -0.000257;
  thermal.k3 = -0.114;
  rig.depth = depth;
  rig.thermal = thermal;
  rig.T_thermal_depth = MakeTransform(
      {0.0485, 0.0533, 0.0115},
      Eigen::Quaterniond(0.999984020972, -0.004360234902, 0.003494424540, -0.000857420105));
  rig.serial = "simulated";
  rig.method = "true by construction";
  return rig;
}

namespace {

/// The camera model's focal length, in pixels, is the distance of the image behind the lens (2.19).
void SetLens(const SimulatedLensOptions& lens, Rig& rig) {
  if (lens.focus_m() == 0.0) return;
  const double focal_length_m = kMPerMm * lens.focal_length_mm();
  const double image_m = focal_length_m * lens.focus_m() / (lens.focus_m() - focal_length_m);
  rig.thermal_sensor.pixel_pitch_m = image_m / rig.thermal->fx;
  rig.thermal_sensor.lens = LensModel{focal_length_m, lens.f_number(), lens.focus_m()};
}

/// Sets the detector's times in the rig description. An ideal detector's are not set: then those of
/// the rig file stay.
void SetTimes(const SimulatedThermalExpertOptions& expert, Rig& rig) {
  if (expert.time_constant_s() > 0.0) rig.thermal_sensor.time_constant_s = expert.time_constant_s();
  if (expert.readout_s() > 0.0)
    rig.thermal_sensor.row_readout_s = expert.readout_s() / rig.thermal->height;
}

}  // namespace

Result<Rig> SimulatedRig(const SimulationOptions& as_given) {
  const SimulationOptions options = WithCamerasAsAsked(as_given);
  Rig rig = DefaultSimulatedRig();
  if (!options.rig_file().empty()) {
    Result<Rig> loaded = LoadRigCalibration(options.rig_file());
    if (!loaded) return Err(loaded.error().WithContext("simulation.rig_file"));
    rig = *loaded;
  }
  if (!rig.depth || !rig.thermal || !rig.T_thermal_depth) {
    return Err(InvalidArgument(fmt::format(
        "{}: a simulated rig needs depth, thermal and T_thermal_depth", options.rig_file())));
  }
  rig.depth_scale = options.depth().expert().depth_scale();
  rig.thermal_scale = ScaleOf(options.thermal());
  rig.thermal_sensor.scene_influence = InfluenceOf(options.thermal());
  SetTimes(options.thermal().expert(), rig);
  SetLens(options.thermal().expert().lens(), rig);
  return rig;
}

SceneInfluence InfluenceOf(const SimulatedThermalOptions& options) {
  const SceneInfluenceOptions& influence = options.expert().scene_influence();
  return {.near_fraction = influence.near_fraction(),
          .near_sigma_px = influence.near_sigma_px(),
          .total_fraction = influence.total_fraction()};
}

RadiometricScale ScaleOf(const SimulatedThermalOptions& options) {
  return ScaleForRange(kMinRadiometric_celsius, options.max_celsius()).value();
}

std::string SceneName(const SimulationOptions& options) {
  switch (options.scene().scene()) {
    case CALIBRATOR:
      return "calibrator";
    case PLANE:
      return "plane";
    case CORNER_SPHERE:
      return "corner-sphere";
    case FLAT_WALL:
      return "flat-wall";
    case APERTURE_PLATE:
      return "aperture-plate";
    case FURNACE_DOOR:
      break;
  }
  return "furnace-door";
}

}  // namespace isotherm
