#include "ground/pipeline/ground_pipeline.h"

#include <algorithm>
#include <thread>
#include <utility>
#include <vector>

#include "common/base/check.h"
#include "common/base/log.h"
#include "common/base/stage_timer.h"
#include "ground/model/saved_model.h"
#include "ground/options/option_geometry.h"
#include "ground/thermal/thermal_options.h"
#include "ground/tsdf/growing_arena.h"

namespace isotherm {
namespace {

int ThreadCount(const GroundOptions& options) {
  if (options.threads() > 0) return options.threads();
  return static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

const StageStats* IfCalled(const StageStats& stats) { return stats.count() > 0 ? &stats : nullptr; }

}  // namespace

Result<std::unique_ptr<GroundPipeline>> GroundPipeline::Create(
    const GroundOptions& options, const Rig& rig, std::optional<RigidTransform> initial_pose) {
  for (const Status& status :
       {Validate(options.volume()), CheckSpillDir(options.volume().spill_dir()),
        Validate(options.preprocessor()), Validate(options.tracker()),
        Validate(options.relocaliser()), Validate(options.submaps()),
        Validate(options.tsdf(), options.volume()), Validate(options.raycast()),
        Validate(options.thermal())}) {
    if (!status.ok()) return Err(status);
  }
  if (Status status = Validate(rig); !status.ok())
    return Err(status.WithContext("rig calibration"));
  if (!rig.depth) {
    return Err(
        FailedPrecondition("the rig calibration has no depth intrinsics: nothing can be "
                           "reconstructed without a depth camera"));
  }
  for (const Status& status : {CheckRange(options.preprocessor(), rig.depth_sensor),
                               CheckSharpness(options.thermal(), rig.thermal_sensor)}) {
    if (!status.ok()) return Err(status);
  }
  if (options.tracker().use_thermal()) {
    if (Status status = CheckThermalFusion(rig); !status.ok())
      return Err(status.WithContext("tracker.use_thermal"));
  }
  if (initial_pose && !IsRigid(*initial_pose))
    return Err(InvalidArgument("the first frame's pose is not a rigid motion with finite numbers"));
  if (!initial_pose && options.volume().expert().has_initial_pose()) {
    const Result<RigidTransform> pose = ToTransform(options.volume().expert().initial_pose());
    if (!pose) return Err(pose.error().WithContext("volume.expert.initial_pose"));
    initial_pose = *pose;
  }
  const Result<VoxelGrid> grid = MakeVoxelGrid(options.volume());
  if (!grid) return Err(grid.error());
  return std::unique_ptr<GroundPipeline>(new GroundPipeline(options, rig, *grid, initial_pose));
}

GroundPipeline::GroundPipeline(const GroundOptions& options, const Rig& rig, const VoxelGrid& grid,
                               const std::optional<RigidTransform>& initial_pose)
    : options_(options),
      rig_(rig),
      thermal_status_(CheckThermalFusion(rig)),
      pool_(ThreadCount(options)),
      atlas_(options, rig.depth->WithoutDistortion(), grid),
      preprocessor_(options.preprocessor(), *rig.depth, rig.depth_sensor),
      tracker_(options, rig.depth->WithoutDistortion(), initial_pose, atlas_),
      integrator_(options.tsdf()),
      gate_(options.tsdf()),
      spiller_(MaxResidentBlocks(options.volume(), grid)) {
  WarmUp();
  if (!thermal_status_.ok()) return;
  MakeThermalStage();
  if (options.tracker().use_thermal()) tracker_.UseThermal(*rig.thermal, *rig.T_thermal_depth);
}

void GroundPipeline::WarmUp() {
  // Memory is handed out page by page when it is first written: on a virtual computer the first
  // frame took 55 ms here, later ones 1.6 ms. A live scan's first frames would wait.
  DepthFrame nothing;
  nothing.depth_raw = Image<std::uint16_t>(rig_.depth->width, rig_.depth->height, kNoDepth);
  preprocessor_.Process(nothing, pool_);
}

void GroundPipeline::MakeThermalStage() {
  thermal_stage_.emplace(options_.thermal(), rig_,
                         static_cast<float>(options_.raycast().expert().min_weight()), counts_);
}

Status GroundPipeline::Continue(const ModelFile& model) {
  SubMap& map = atlas_.active();
  if (Status status = LoadSubMap(model, rig_, map); !status.ok()) return status;
  if (map.tsdf->block_count() == 0) return OkStatus();
  map.versions.NoteAll(map.tsdf->block_count());
  // The rig is somewhere near the views of the model; until it is found nothing is added.
  tracker_.BeginLost();
  // The model is there: its first frames need not be integrated whatever their motion.
  gate_.EndBootstrap();
  is_continued_ = true;
  return OkStatus();
}

ScanModel GroundPipeline::model() {
  const TrackerTimes& tracker = tracker_.times();
  return {.rig = rig_,
          .atlas = atlas_,
          .trajectory = tracker_.trajectory(),
          .view = tracker_.view(),
          .motion = tracker_.motion(),
          .uncertainty = tracker_.uncertainty(),
          .external_odometry = tracker_.external_odometry(),
          .counts = counts_,
          .stages = {{Stage::kDepthFrame, IfCalled(times_.depth_frame)},
                     {Stage::kIntegrate, IfCalled(times_.integrate)},
                     {Stage::kMerge, IfCalled(times_.merge)},
                     {Stage::kPreprocess, IfCalled(times_.preprocess)},
                     {Stage::kRaycast, IfCalled(tracker.raycast)},
                     {Stage::kRelocalise, IfCalled(tracker.relocalise)},
                     {Stage::kSubMaps, IfCalled(tracker.sub_maps)},
                     {Stage::kThermalFrame, thermal_stage_ ? &thermal_stage_->times() : nullptr},
                     {Stage::kTrack, IfCalled(tracker.track)}},
          .spiller = spiller_,
          .thermal_status = thermal_status_,
          .is_continued = is_continued_,
          .pool = pool_};
}

DepthReport GroundPipeline::ProcessDepth(const DepthFrame& frame) {
  DepthReport report;
  if (!Admit(frame, report)) return report;
  StageTimer timer(times_.depth_frame);
  const PreparedDepth& depth = Prepare(frame);
  TrackedFrame tracked = Track(depth, frame.header.capture_time);
  const bool integrated = Integrate(depth, tracked);
  Raycast(tracked);
  // Temperatures have a time of their own (Stage::kThermalFrame).
  timer.Stop();
  // Behind the cast: temperatures see the model with this frame in it.
  FuseThermal(depth, tracked);
  return Report(tracked, integrated);
}

bool GroundPipeline::Admit(const DepthFrame& frame, DepthReport& report) {
  ++counts_.depth_in;
  if (!HasCalibratedSize(frame)) {
    ++counts_.depth_refused;
    return false;
  }
  // A rig that is lost is looked for in each frame anew.
  report.repeated = repeats_.Add(frame.depth_raw) > 0 && tracker_.motion().last().has_value();
  if (report.repeated) ++counts_.depth_repeated;
  return !report.repeated;
}

bool GroundPipeline::HasCalibratedSize(const DepthFrame& frame) {
  if (frame.depth_raw.width() != rig_.depth->width ||
      frame.depth_raw.height() != rig_.depth->height) {
    if (wrong_size_++ > 0) return false;  // Told when it began.
    LOG(Ground, Warning) << "depth frame of another size than the calibration's, frame="
                         << frame.header.frame_number << " width_px=" << frame.depth_raw.width()
                         << " height_px=" << frame.depth_raw.height()
                         << ": refused, as are all that follow of this size";
    return false;
  }
  if (const std::uint64_t refused = std::exchange(wrong_size_, 0); refused > 0) {
    LOG(Ground, Info) << "depth frames have the calibration's size again, refused=" << refused;
  }
  return true;
}

const PreparedDepth& GroundPipeline::Prepare(const DepthFrame& frame) {
  const StageTimer timer(times_.preprocess);
  return preprocessor_.Process(frame, pool_);
}

TrackedFrame GroundPipeline::Track(const PreparedDepth& depth, CaptureTime time) {
  const TrackedFrame frame = tracker_.Track(depth, time, pool_);
  counts_.relocalisations = tracker_.relocalisations();
  // Blocks are numbered by sub-map: what was noted of the old one's is void.
  if (frame.switched) spiller_.Restart();
  switch (frame.outcome) {
    case TrackedFrame::Outcome::kLost:
      ++counts_.depth_lost[frame.tracking.lost];
      break;
    case TrackedFrame::Outcome::kUnconfirmed:
      ++counts_.depth_unconfirmed;
      break;
    case TrackedFrame::Outcome::kFirst:
      // A new sub-map begins with one frame's noise, as the scan did.
      gate_.Restart();
      break;
    case TrackedFrame::Outcome::kTracked:
      break;
  }
  return frame;
}

bool GroundPipeline::Integrate(const PreparedDepth& depth, TrackedFrame& frame) {
  if (!frame.is_believed()) return false;
  const RigidTransform& T_map_depth = frame.tracking.T_map_depth;
  // The first surface decides whether there is anything to track against.
  const bool is_first = frame.outcome == TrackedFrame::Outcome::kFirst;
  if (is_first && !AddSurface(depth, T_map_depth)) {
    ++counts_.depth_lost[LostReason::kOutsideVolume];
    tracker_.Reject();
    frame.outcome = TrackedFrame::Outcome::kLost;
    return false;
  }
  ++counts_.depth_tracked;
  const TrackingQuality quality = frame.tracking.quality();
  if (quality == TrackingQuality::kDegraded) ++counts_.depth_degraded;
  const bool integrates = IsDue(frame);
  if (integrates && !is_first) AddSurface(depth, T_map_depth);
  if (integrates) ++counts_.depth_integrated;
  // After the integration: what follows (loops, sub-maps) may leave this sub-map.
  tracker_.Accept(frame);
  // A degraded pose is held, not measured: it must neither become a known view nor join sub-maps.
  if (integrates && quality == TrackingQuality::kTracked &&
      tracker_.CloseLoops(frame, depth, integrator_.updated_blocks(), pool_)) {
    spiller_.Restart();
  }
  return integrates;
}

bool GroundPipeline::IsCertain() const {
  // As long as nothing has ever held the rig there is nothing to contradict. A source of odometry
  // has its drift whatever is in view, and the model has it then.
  return gate_.bootstrapping() || !tracker_.is_speed_known() || tracker_.is_held_by_odometry() ||
         tracker_.uncertainty().surface_sigma_m() <= atlas_.active().tsdf->truncation_distance_m();
}

bool GroundPipeline::IsDue(const TrackedFrame& frame) {
  slides_ = !IsCertain();
  if (slides_) {
    ++counts_.depth_uncertain;
    return false;
  }
  const int stride = IntegrationStride(load_shedding_);
  if (stride > 1 && turn_++ % stride != 0) {
    ++counts_.depth_behind;
    return false;
  }
  const std::optional<StampedMapPose> before = tracker_.motion().before_last();
  return gate_.Accepts(before ? std::optional(before->T_map_depth) : std::nullopt,
                       frame.tracking.T_map_depth);
}

bool GroundPipeline::AddSurface(const PreparedDepth& depth, const RigidTransform& T_map_depth) {
  const StageTimer timer(times_.integrate);
  SubMap& map = atlas_.active();
  integrator_.Integrate(depth, T_map_depth, pool_, *map.tsdf);
  // Temperatures lie beside the distances block by block, so they grow with them.
  thermal_has_room_ = map.thermal->Commit(map.tsdf->block_count());
  map.versions.Note(integrator_.updated_blocks());
  ++map.integrated;
  if (map.anchors.empty()) map.anchors.push_back(T_map_depth);
  spiller_.Touch(integrator_.updated_blocks());
  const std::uint64_t before = spiller_.spilled();
  spiller_.Trim(*map.tsdf, *map.thermal);
  if (before == 0 && spiller_.spilled() > 0) {
    LOG(Ground, Info) << "the model has outgrown volume.expert.max_memory_bytes: what is far from "
                         "the view goes to "
                      << options_.volume().spill_dir();
  }
  if (spiller_.spilled() > 0) ReadAheadAround(T_map_depth);
  return map.tsdf->block_count() > 0;
}

void GroundPipeline::ReadAheadAround(const RigidTransform& T_map_depth) {
  // Looking up the blocks costs as much as a cast's bounds. Five frames of motion are within what
  // the wider view below covers.
  constexpr std::uint64_t kEvery = 5;
  if (counts_.depth_in % kEvery != 0) return;
  // As if the camera saw half as much again on each side. Not tuned.
  constexpr double kZoom = 0.5;
  CameraModel camera = tracker_.view().camera;
  camera.fx *= kZoom;
  camera.fy *= kZoom;
  const SubMap& map = atlas_.active();
  spiller_.Expect(near_view_.Find(*map.tsdf, camera, T_map_depth), *map.tsdf, *map.thermal);
}

void GroundPipeline::Raycast(const TrackedFrame& frame) {
  // The tracker has followed if another sub-map is active now.
  if (frame.outcome != TrackedFrame::Outcome::kLost) RaycastFrom(tracker_.pose().T_map_depth);
}

void GroundPipeline::RaycastFrom(const RigidTransform& T_map_depth) {
  tracker_.LookFrom(T_map_depth, gate_.bootstrapping(), pool_);
}

DepthReport GroundPipeline::Report(const TrackedFrame& frame, bool integrated) const {
  DepthReport report;
  report.tracked = frame.is_believed();
  report.unconfirmed = frame.outcome == TrackedFrame::Outcome::kUnconfirmed;
  report.integrated = integrated;
  report.slides = report.tracked && slides_;
  report.tracking = frame.tracking;
  if (report.tracked) report.pose = tracker_.pose();
  return report;
}

void GroundPipeline::ProcessThermal(ThermalFramePtr frame) {
  ++counts_.thermal_in;
  const bool is_counts = IsCountsOnly(*frame);
  if (is_counts && counts_.thermal_left_out[LeftOutReason::kCounts]++ == 0) {
    thermal_status_ = FailedPrecondition(
        "the thermal camera sends counts, which nothing relates to temperatures: none are fused, "
        "geometry goes on (source.thermal_camera.expert.kelvin_per_count and offset_kelvin in the "
        "configuration of isotherm-edge say what counts mean)");
    LOG(Ground, Warning) << thermal_status_.message();
  }
  if (is_counts) return;
  if (!thermal_stage_) {
    ++counts_.thermal_left_out[LeftOutReason::kNoCalibration];
  } else if (thermal_stage_->Add(frame)) {
    tracker_.AddThermal(std::move(frame));
  }
}

void GroundPipeline::FuseThermal(const PreparedDepth& depth, const TrackedFrame& frame) {
  if (!thermal_stage_ || !frame.is_believed()) return;
  const PoseUncertainty& uncertainty = tracker_.uncertainty();
  SubMap& map = atlas_.active();
  const TrackedDepth tracked{
      .depth_m = depth.depth_m,
      .view = tracker_.view(),
      .earlier = tracker_.motion().third_last(),
      .before = tracker_.motion().before_last(),
      .now = *tracker_.motion().last(),
      .surface_sigma_rad = uncertainty.surface_sigma_m() / uncertainty.mean_depth_m(),
      .mean_depth_m = uncertainty.mean_depth_m(),
      .tsdf = *map.tsdf,
      .refusal = thermal_has_room_ ? std::nullopt : std::optional(LeftOutReason::kDiskFull),
      .thinning = Thinning(load_shedding_),
      .versions = &map.versions};
  certainties_.push_back({frame.time, static_cast<float>(tracked.surface_sigma_rad),
                          static_cast<float>(tracked.mean_depth_m)});
  thermal_stage_->FuseUpTo(tracked, *map.thermal, pool_);
}

void GroundPipeline::Finish(const std::function<void(double)>& progress) {
  // All temperatures are reviewed, in the merged model.
  if (atlas_.size() > 1) MergeMaps(progress);
  if (thermal_stage_) {
    const SubMap& map = atlas_.active();
    thermal_stage_->Finish(*map.tsdf, *map.thermal, pool_);
  }
  atlas_.active().versions.NoteAll(atlas_.active().tsdf->block_count());
}

std::unique_ptr<ThermalPass> GroundPipeline::BeginThermalPass() {
  // An earlier scan's temperatures cannot be measured again from the frames of this one.
  if (counts_.thermal_fused == 0 || is_continued_ || spiller_.spilled() > 0) return nullptr;
  std::vector<PassPose> poses;
  auto certainty = certainties_.begin();
  for (const StampedPose& pose : tracker_.trajectory().poses()) {
    while (certainty != certainties_.end() && certainty->time < pose.time) ++certainty;
    // A frame that came to be believed only later has none.
    if (certainty == certainties_.end() || certainty->time != pose.time) continue;
    poses.push_back({pose.time, InFirstMap(pose.T_world_depth), certainty->surface_sigma_rad,
                     certainty->mean_depth_m});
  }
  CHECK(atlas_.ForgetTemperatures());  // It had the room before.
  counts_.ForgetThermal();
  MakeThermalStage();
  SubMap& map = atlas_.active();
  return std::make_unique<ThermalPass>(
      options_, rig_, std::move(poses),
      PassModel{*map.tsdf, *map.thermal, *thermal_stage_, counts_, pool_});
}

void GroundPipeline::MergeMaps(const std::function<void(double)>& progress) {
  const StageTimer timer(times_.merge);
  const RigidTransform T_world_map = atlas_.active().T_world_map;
  const bool joined = atlas_.active().joined;
  if (!atlas_.Merge(options_.tsdf().expert().max_weight(), pool_, progress)) {
    LOG(Ground, Warning) << "volume.spill_dir is full: temperatures of some sub-maps are left out";
  }
  const std::vector<StampedPose>& poses = tracker_.trajectory().poses();
  if (joined) {
    // The merged model is in `world`; the view of it must be, too, for renderings.
    tracker_.Rebase(T_world_map);
    RaycastFrom(tracker_.view().T_map_depth);
  } else if (!poses.empty()) {
    RaycastFrom(InFirstMap(poses.back().T_world_depth));
  }
}

}  // namespace isotherm
