#include "ground/experiment/closed_loop_scan.h"

#include <utility>

#include "common/base/noise.h"
#include "common/simulation/depth_sensor.h"
#include "common/simulation/options.h"
#include "common/simulation/simulation_options.pb.h"
#include "common/simulation/thermal_sensor.h"
#include "ground/feedback/feedback_maker.h"
#include "ground/feedback/feedback_pace.h"
#include "ground/pipeline/ground_pipeline.h"

namespace isotherm {
namespace {

// A closed loop renders each frame when its pose is known, so that nothing can be prepared: both
// cameras run at two thirds of the usual rate, and the operator moves in ten steps a frame.
constexpr double kFrameRate_hz = 20.0;
constexpr int kStepsPerFrame = 10;
// A rig that is within this of a surface has touched it.
constexpr double kHandWidth_m = 0.05;

enum NoisePurpose : std::uint64_t { kDepthPixels, kThermalPixels };

/// Nothing is said about temperatures: one ray per pixel will do.
SimulatedThermalOptions SharpThermalCamera() {
  SimulatedThermalOptions options = IdealThermalCamera({});
  options.mutable_expert()->set_rays_per_pixel_side(1);
  return options;
}

/// One scan as it goes on, frame by frame.
class ClosedLoop {
 public:
  ClosedLoop(const ClosedLoopSetup& setup, const GroundOptions& options, const Rig& rig,
             std::unique_ptr<GroundPipeline> pipeline)
      : setup_(setup),
        rig_(rig),
        depth_sensor_(*rig_.depth, IdealDepthCamera(SimulatedDepthOptions())),
        thermal_sensor_(*rig_.thermal, SharpThermalCamera()),
        pipeline_(std::move(pipeline)),
        feedback_(options, {.session = 1, .rig = rig_, .depth = {}, .thermal = {}}),
        pace_(options.live().expert().feedback_hz()),
        operator_(setup.traits, setup.obedience, setup.staged.path.PoseAt(0.0), setup.path,
                  setup.seed) {}

  ClosedLoopLog Run() {
    const auto frames = static_cast<std::uint64_t>(setup_.max_duration_s * kFrameRate_hz);
    for (std::uint64_t i = 0; i < frames && !log_.done_s && !log_.path_complete; ++i) {
      Look(i);
      LetMove();
    }
    log_.end_s = operator_.time_s();
    log_.measured_well_at_end = MeasuredWell();
    return std::move(log_);
  }

 private:
  /// One frame of each camera, and what the operator is told about it.
  void Look(std::uint64_t number) {
    const double time_s = operator_.time_s();
    const RigidTransform T_world_depth = operator_.T_world_depth();
    FrameHeader header;
    header.frame_number = number;
    header.capture_time = CaptureTime(FromSeconds(1000.0 + time_s));
    pipeline_->ProcessThermal(Thermal(header, T_world_depth));
    const DepthReport report = pipeline_->ProcessDepth(Depth(header, T_world_depth));
    ++log_.depth_frames;
    log_.lost_frames += report.tracked ? 0 : 1;
    log_.blocked_frames +=
        setup_.staged.scene.IsCovered(T_world_depth.translation(), -1, kHandWidth_m) ? 1 : 0;
    const auto samples = static_cast<double>(log_.measured_well.size());
    if (time_s >= samples * ClosedLoopLog::kSampleInterval_s)
      log_.measured_well.push_back(MeasuredWell());
    pace_.Add(header, report);
    const std::optional<FeedbackMoment> moment = pace_.Take();
    if (!moment) return;
    const Feedback feedback = feedback_.Make(*moment, pipeline_->model());
    Note(feedback);
    operator_.Hear(feedback, T_world_depth);
    feedback_.ThinkAhead(pipeline_->model());
  }

  void Note(const Feedback& feedback) {
    ++log_.messages;
    for (const Advice advice : feedback.advice) ++log_.advice[static_cast<std::size_t>(advice)];
    if (feedback.done && !log_.done_s) log_.done_s = operator_.time_s();
  }

  void LetMove() {
    for (int i = 0; i < kStepsPerFrame; ++i) {
      const Eigen::Vector3d before = operator_.T_world_depth().translation();
      operator_.Advance(1.0 / (kFrameRate_hz * kStepsPerFrame));
      log_.way_m += (operator_.T_world_depth().translation() - before).norm();
    }
    log_.path_complete = operator_.path_complete() && !setup_.obedience.next_view;
  }

  DepthFrame Depth(const FrameHeader& header, const RigidTransform& T_world_depth) {
    DepthFrame frame;
    frame.header = header;
    frame.depth_scale = rig_.depth_scale;
    frame.depth_raw = depth_sensor_.Render(
        setup_.staged.scene, T_world_depth,
        NoiseStream(setup_.seed, kDepthPixels, header.frame_number), depth_scratch_);
    return frame;
  }

  ThermalFramePtr Thermal(const FrameHeader& header, const RigidTransform& T_world_depth) {
    auto frame = std::make_shared<ThermalFrame>();
    frame->header = header;
    frame->temperature_raw = thermal_sensor_.Render(
        setup_.staged.scene, T_world_depth * rig_.T_thermal_depth->inverse(),
        NoiseStream(setup_.seed, kThermalPixels, header.frame_number), thermal_scratch_);
    frame->scale = rig_.thermal_scale;
    frame->valid = true;
    return frame;
  }

  double MeasuredWell() const { return setup_.surface.MeasuredWell(pipeline_->model()); }

  const ClosedLoopSetup& setup_;
  const Rig rig_;
  const DepthSensor depth_sensor_;
  const ThermalSensor thermal_sensor_;
  DepthSensor::Scratch depth_scratch_;
  ThermalSensor::Scratch thermal_scratch_;
  std::unique_ptr<GroundPipeline> pipeline_;
  FeedbackMaker feedback_;
  FeedbackPace pace_;
  ScriptedOperator operator_;
  ClosedLoopLog log_;
};

}  // namespace

Rig RigForClosedLoop() {
  Rig rig = DefaultSimulatedRig();
  rig.depth_scale = SimulatedDepthExpertOptions().depth_scale();
  rig.thermal_scale = ScaleOf(SimulatedThermalOptions());
  return rig;
}

GroundOptions OptionsForClosedLoop() {
  // Limits per frame are for cameras at 30 Hz.
  constexpr double kUsualRate_hz = 30.0;
  constexpr double kSlower = kUsualRate_hz / kFrameRate_hz;
  GroundOptions options;
  TsdfExpertOptions& tsdf = *options.mutable_tsdf()->mutable_expert();
  tsdf.set_max_step_m(kSlower * tsdf.max_step_m());
  tsdf.set_max_step_deg(kSlower * tsdf.max_step_deg());
  options.mutable_feedback()->mutable_expert()->set_image_width_px(0);
  options.set_threads(1);
  return options;
}

Result<ClosedLoopLog> RunClosedLoop(const ClosedLoopSetup& setup) {
  const GroundOptions options = OptionsForClosedLoop();
  const Rig rig = RigForClosedLoop();
  // The first pose is the true one but for the sway; the others are tracked.
  const ScriptedOperator person(setup.traits, setup.obedience, setup.staged.path.PoseAt(0.0),
                                setup.path, setup.seed);
  auto pipeline = GroundPipeline::Create(options, rig, person.T_world_depth());
  if (!pipeline) return Err(pipeline.error());
  return ClosedLoop(setup, options, rig, std::move(*pipeline)).Run();
}

}  // namespace isotherm
