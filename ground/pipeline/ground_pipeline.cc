#include "ground/pipeline/ground_pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <thread>
#include <utility>

#include "common/base/log.h"
#include "common/geometry/pose_text.h"
#include "ground/pipeline/initial_pose.h"
#include "ground/pipeline/stage_timer.h"

namespace isotherm {
namespace {

int ThreadCount(const GroundOptions& options) {
  if (options.threads() > 0) return options.threads();
  return static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

}  // namespace

Result<std::unique_ptr<GroundPipeline>> GroundPipeline::Create(
    const GroundOptions& options, const Rig& rig, std::optional<RigidTransform> initial_pose) {
  for (const Status& status :
       {Validate(options.volume()), Validate(options.preprocessor()), Validate(options.tracker()),
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
  if (options.tracker().use_thermal()) {
    if (Status status = CheckThermalFusion(rig); !status.ok())
      return Err(status.WithContext("tracker.use_thermal"));
  }
  if (initial_pose && !IsRigid(*initial_pose))
    return Err(InvalidArgument("the first frame's pose is not a rigid motion with finite numbers"));
  if (!initial_pose && !options.volume().initial_pose().empty()) {
    const Result<RigidTransform> pose = ParsePose(options.volume().initial_pose());
    if (!pose) return Err(pose.error().WithContext("volume.initial_pose"));
    initial_pose = *pose;
  }
  const Result<VoxelGrid> grid = MakeVoxelGrid(options.volume());
  if (!grid) return Err(grid.error());
  return std::unique_ptr<GroundPipeline>(new GroundPipeline(options, rig, *grid, initial_pose));
}

GroundPipeline::GroundPipeline(const GroundOptions& options, const Rig& rig, const VoxelGrid& grid,
                               std::optional<RigidTransform> initial_pose)
    : options_(options),
      rig_(rig),
      initial_pose_(initial_pose),
      thermal_status_(CheckThermalFusion(rig)),
      pool_(ThreadCount(options)),
      preprocessor_(options.preprocessor(), *rig.depth),
      tracker_(options, rig.depth->WithoutDistortion()),
      integrator_(options.tsdf()),
      gate_(options.tsdf()),
      atlas_(options, rig.depth->WithoutDistortion(), grid),
      loop_closer_(options, atlas_, tracker_),
      spiller_(MaxResidentBlocks(options.volume(), grid)) {
  if (!thermal_status_.ok()) return;
  thermal_stage_.emplace(options.thermal(), rig, static_cast<float>(options.raycast().min_weight()),
                         counts_, stage_stats_["thermal_frame"]);
  if (options.tracker().use_thermal()) tracker_.UseThermal(*rig.thermal, *rig.T_thermal_depth);
}

Status GroundPipeline::Continue(const ModelFile& model) {
  SubMap& map = atlas_.active();
  CHECK(map.tsdf->block_count() == 0);
  if (Status status = model.CheckRig(rig_); !status.ok()) return status;
  if (!map.thermal->Commit(std::min(map.tsdf->max_blocks(), model.block_count())))
    return ResourceExhausted("no room for the model in volume.spill_dir");
  if (Status status = model.ReadBlocks(*map.tsdf, *map.thermal); !status.ok()) return status;
  if (map.tsdf->block_count() == 0) return OkStatus();
  for (const RigidTransform& pose : model.known_poses()) map.relocaliser->Add(pose);
  map.anchors = model.known_poses();
  tracker_.BeginLost();
  gate_.EndBootstrap();
  is_continued_ = true;
  return OkStatus();
}

Status GroundPipeline::Save(const std::filesystem::path& path, int index,
                            const std::function<void(double fraction)>& progress) const {
  const SubMap& map = atlas_.map(index);
  return SaveModel(path, *map.tsdf, *map.thermal, rig_, map.relocaliser->keyframes().poses(),
                   progress);
}

RigidTransform GroundPipeline::InitialPose(const PreparedDepth& depth) const {
  if (initial_pose_ && atlas_.size() == 1) return *initial_pose_;
  return PoseFacingCentre(tsdf().grid(), depth.depth_m);
}

bool GroundPipeline::IsRepeated(const DepthFrame& frame) {
  const bool repeated =
      tracker_.motion().last() && std::ranges::equal(frame.depth_raw.pixels(), last_raw_.pixels());
  if (!repeated) last_raw_ = frame.depth_raw;
  return repeated;
}

TrackingResult GroundPipeline::Track(const PreparedDepth& depth, CaptureTime time) {
  if (tsdf().block_count() == 0) return tracker_.Begin(depth, time, InitialPose(depth));
  const bool lost = tracker_.state() == RigTracker::State::kLost;
  const StageTimer timer(stage_stats_[lost ? "relocalise" : "track"]);
  if (!lost) searched_ = atlas_.active_index();
  TrackingResult result =
      tracker_.Track(depth, time, atlas_.active(), atlas_.map(searched_), pool_);
  if (tracker_.found_elsewhere()) {
    Activate(searched_);
  } else if (lost) {
    searched_ = (searched_ + 1) % atlas_.size();
  }
  if (result.tracked()) {
    lost_since_.reset();
  } else if (!lost_since_) {
    lost_since_ = time;
  } else if (BeginElsewhere(depth, time)) {
    return tracker_.Begin(depth, time, InitialPose(depth));
  }
  return result;
}

bool GroundPipeline::BeginElsewhere(const PreparedDepth& depth, CaptureTime time) {
  const double limit_s = options_.submaps().start_after_lost_s();
  // A hand before the camera is no place to begin at.
  constexpr int kFewestPixels = 10 * kMinTrackedPixels;
  if (limit_s <= 0.0 || ToSeconds(time - *lost_since_) < limit_s ||
      depth.valid_pixels < kFewestPixels || !atlas_.BeginElsewhere()) {
    return false;
  }
  LOG(Ground, Warning) << fmt::format(
      "lost for {:.1f} s: the scan goes on in sub-map {}, which is joined when the rig sees both",
      ToSeconds(time - *lost_since_), atlas_.size());
  lost_since_.reset();
  spiller_.Restart();
  gate_.Restart();
  return true;
}

void GroundPipeline::Activate(int index) {
  atlas_.Activate(index);
  spiller_.Restart();
}

void GroundPipeline::UpdateView(const RigidTransform& T_map_depth) {
  const StageTimer timer(stage_stats_["raycast"]);
  tracker_.LookFrom(T_map_depth, tsdf(), gate_.bootstrapping(), pool_);
}

SurfaceMaps GroundPipeline::CastFullView() {
  SurfaceMaps maps;
  Raycaster().Cast(tsdf(), rig_.depth->WithoutDistortion(), view().T_map_depth,
                   static_cast<float>(options_.raycast().min_weight()), pool_, maps);
  return maps;
}

DepthReport GroundPipeline::ProcessDepth(const DepthFrame& frame) {
  const DepthReport report = TrackAndIntegrate(frame);
  if (report.tracked) FuseThermal();
  return report;
}

bool GroundPipeline::Integrate(const PreparedDepth& depth, const RigidTransform& T_map_depth) {
  const StageTimer timer(stage_stats_["integrate"]);
  SubMap& map = atlas_.active();
  integrator_.Integrate(depth, T_map_depth, pool_, *map.tsdf);
  has_room_ = map.thermal->Commit(map.tsdf->block_count());
  ++map.integrated;
  if (map.anchors.empty()) map.anchors.push_back(T_map_depth);
  spiller_.Touch(integrator_.updated_blocks());
  const std::uint64_t before = spiller_.spilled();
  spiller_.Trim(*map.tsdf, *map.thermal);
  if (before == 0 && spiller_.spilled() > 0) {
    LOG(Ground, Info)
        << "the model has outgrown volume.max_memory_bytes: what is far from the view "
           "goes to "
        << options_.volume().spill_dir();
  }
  if (spiller_.spilled() > 0) FetchNearView(T_map_depth);
  return map.tsdf->block_count() > 0;
}

void GroundPipeline::FetchNearView(const RigidTransform& T_map_depth) {
  constexpr std::uint64_t kEvery = 5;
  if (counts_.depth_in % kEvery != 0) return;
  // As if the camera saw half as much again on each side: some ten frames ahead at the speed at
  // which frames are integrated.
  constexpr double kZoom = 0.5;
  CameraModel camera = view().camera;
  camera.fx *= kZoom;
  camera.fy *= kZoom;
  spiller_.Expect(near_view_.Find(tsdf(), camera, T_map_depth), tsdf(), thermal());
}

DepthReport GroundPipeline::TrackAndIntegrate(const DepthFrame& frame) {
  ++counts_.depth_in;
  DepthReport report;
  if (frame.depth_raw.width() != rig_.depth->width ||
      frame.depth_raw.height() != rig_.depth->height) {
    ++counts_.depth_refused;
    if (wrong_size_++ > 0) return report;  // Told when it began.
    LOG(Ground, Warning) << "depth frame of another size than the calibration's, frame="
                         << frame.header.frame_number << " width_px=" << frame.depth_raw.width()
                         << " height_px=" << frame.depth_raw.height()
                         << ": refused, as are all that follow of this size";
    return report;
  }
  if (const std::uint64_t refused = std::exchange(wrong_size_, 0); refused > 0) {
    LOG(Ground, Info) << "depth frames have the calibration's size again, refused=" << refused;
  }
  if (IsRepeated(frame)) {
    ++counts_.depth_repeated;
    report.repeated = true;
    return report;
  }
  const StageTimer timer(stage_stats_["depth_frame"]);
  const PreparedDepth* depth = nullptr;
  {
    const StageTimer preprocess_timer(stage_stats_["preprocess"]);
    depth = last_depth_ = &preprocessor_.Process(frame, pool_);
  }
  const CaptureTime time = frame.header.capture_time;
  report.tracking = Track(*depth, time);
  report.tracked = report.tracking.tracked();
  if (!report.tracked) {
    ++counts_.depth_lost[std::string(ToString(report.tracking.lost))];
    unconfirmed_.clear();
    return report;
  }
  const RigidTransform& T_map_depth = report.tracking.T_map_depth;
  if (tracker_.state() == RigTracker::State::kConfirming) {
    ++counts_.depth_unconfirmed;
    unconfirmed_.push_back({time, T_map_depth});
    UpdateView(T_map_depth);
    report.tracked = false;
    report.unconfirmed = true;
    return report;
  }
  // The first surface decides whether there is anything to track against.
  const bool is_first = tsdf().block_count() == 0;
  if (is_first && !Integrate(*depth, T_map_depth)) {
    ++counts_.depth_lost["outside_volume"];
    tracker_.Forget();
    report.tracked = false;
    return report;
  }
  ++counts_.depth_tracked;
  if (report.tracking.verdict() == Verdict::kDegraded) ++counts_.depth_degraded;
  const std::optional<StampedMapPose> before = tracker_.motion().before_last();
  const bool skips = load_shedding_ == LoadShedding::kEverySecond &&
                     !std::exchange(integrate_next_, !integrate_next_);
  if (skips) ++counts_.depth_behind;
  report.integrated =
      !skips &&
      gate_.Accepts(before ? std::optional(before->T_map_depth) : std::nullopt, T_map_depth);
  if (report.integrated && !is_first) Integrate(*depth, T_map_depth);
  counts_.depth_integrated += report.integrated ? 1 : 0;
  for (const StampedMapPose& pose : unconfirmed_) AddToTrajectory(pose);
  unconfirmed_.clear();
  AddToTrajectory({time, T_map_depth});
  if (report.integrated && report.tracking.verdict() == Verdict::kTracked) {
    atlas_.active().relocaliser->Add(T_map_depth);
    KeepSubMaps(*depth, T_map_depth);
  }
  // The tracker has followed if another sub-map is active now.
  report.pose = {atlas_.active_index(), tracker_.motion().last()->T_map_depth,
                 uncertainty().covariance()};
  UpdateView(report.pose.T_map_depth);
  return report;
}

void GroundPipeline::ProcessThermal(ThermalFramePtr frame) {
  ++counts_.thermal_in;
  // Of a camera that measures no temperatures (Encoding::kCounts16).
  const bool is_counts = frame->centikelvin.empty() && !frame->valid;
  if (is_counts && counts_.thermal_left_out["counts"]++ == 0) {
    thermal_status_ = FailedPrecondition(
        "the thermal camera sends counts, which nothing relates to temperatures: none are fused, "
        "geometry goes on (source.thermal_camera.kelvin_per_count and offset_kelvin of the rig "
        "could say what counts mean)");
    LOG(Ground, Warning) << thermal_status_.message();
  }
  if (is_counts) return;
  if (!thermal_stage_) {
    ++counts_.thermal_left_out["no_calibration"];
  } else if (thermal_stage_->Add(frame)) {
    tracker_.AddThermal(std::move(frame));
  }
}

void GroundPipeline::FuseThermal() {
  if (!thermal_stage_) return;
  const TrackedDepth depth{
      .depth_m = last_depth_->depth_m,
      .view = view(),
      .before = tracker_.motion().before_last(),
      .now = *tracker_.motion().last(),
      .surface_sigma_rad = uncertainty().surface_sigma_m() / uncertainty().mean_depth_m(),
      .tsdf = tsdf(),
      .refusal = load_shedding_ != LoadShedding::kNone ? "behind"
                 : has_room_                           ? nullptr
                                                       : "disk_full"};
  thermal_stage_->FuseUpTo(depth, *atlas_.active().thermal, pool_);
}

void GroundPipeline::AddToTrajectory(const StampedMapPose& pose) {
  tracked_.push_back({pose, LargestSigma(uncertainty().covariance()), atlas_.active_index()});
  AppendToTrajectory(tracked_.back());
}

void GroundPipeline::AppendToTrajectory(const TrackedPose& tracked) {
  const std::optional<WorldPose> world =
      atlas_.ToWorld({.map = tracked.map, .T_map_depth = tracked.pose.T_map_depth});
  if (!world) return;
  trajectory_.push_back({tracked.pose.time, world->T_world_depth});
  trajectory_sigmas_.push_back(tracked.sigma);
}

void GroundPipeline::KeepSubMaps(const PreparedDepth& depth, const RigidTransform& T_map_depth) {
  const StageTimer timer(stage_stats_["submaps"]);
  const LoopCloser::Change change =
      loop_closer_.Update(depth, T_map_depth, integrator_.updated_blocks(), pool_);
  if (change.switched) spiller_.Restart();
  if (!change.linked) return;
  trajectory_.clear();
  trajectory_sigmas_.clear();
  for (const TrackedPose& tracked : tracked_) AppendToTrajectory(tracked);
}

void GroundPipeline::Finish(const std::function<void(double)>& progress) {
  if (atlas_.size() > 1) MergeMaps(progress);
  if (thermal_stage_) thermal_stage_->Finish(tsdf(), *atlas_.active().thermal, pool_);
}

void GroundPipeline::MergeMaps(const std::function<void(double)>& progress) {
  const StageTimer timer(stage_stats_["merge"]);
  const RigidTransform T_world_map = atlas_.active().T_world_map;
  const bool joined = atlas_.active().joined;
  if (!atlas_.Merge(options_.tsdf().max_weight(), pool_, progress)) {
    LOG(Ground, Warning) << "volume.spill_dir is full: temperatures of some sub-maps are left out";
  }
  if (joined) {
    tracker_.Rebase(T_world_map);
    UpdateView(view().T_map_depth);
  } else if (!trajectory_.empty()) {
    UpdateView(trajectory_.back().T_world_depth);
  }
}

}  // namespace isotherm
