#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/base/stage_stats.h"
#include "common/concurrency/thread_pool.h"
#include "common/frame/frame.h"
#include "common/geometry/camera.h"
#include "common/geometry/map_pose.h"
#include "common/geometry/pose_covariance.h"
#include "common/geometry/stamped_pose.h"
#include "ground/atlas/atlas.h"
#include "ground/model/model_file.h"
#include "ground/options/ground_options.pb.h"
#include "ground/pipeline/block_spiller.h"
#include "ground/pipeline/loop_closer.h"
#include "ground/pipeline/pipeline_counts.h"
#include "ground/pipeline/rig_tracker.h"
#include "ground/pipeline/thermal_stage.h"
#include "ground/surface/depth_preprocessor.h"
#include "ground/tsdf/tsdf_integrator.h"

namespace isotherm {

/// The work that a pipeline leaves out under load. It costs quality where the next frames do
/// not see the same again.
enum class LoadShedding : std::uint8_t {
  kNone,
  kNoThermal,    ///< Thermal frames are left out ("behind").
  kEverySecond,  ///< And only every second depth frame is integrated; all are tracked.
};

struct DepthReport {
  bool tracked = false;
  bool unconfirmed = false;  ///< Has a pose that is not believed yet; counts as not tracked.
  bool repeated = false;  ///< The same image as before: it says nothing new, and nothing was done.
  bool integrated = false;
  TrackingResult
      tracking;  ///< In the coordinates of the sub-map that the frame was tracked against.
  MapPose pose;  ///< If tracked: in the sub-map that is active after the frame.
};

/// The straight line from frames to a validated thermogram (algorithm 1 and chapter 6), one frame
/// at a time, in capture-time order. Both drivers, live and inline, call it; it owns no thread but
/// its pool, no device and no clock that matters to the result (stage times are measured for
/// statistics only). Thread-bound.
class GroundPipeline {
 public:
  /// `rig` must have depth intrinsics. `initial_pose` is T_world_depth of the first depth frame;
  /// without one it comes from options.volume.initial_pose, and without that the volume's centre is
  /// put on the first frame's optical axis at its median depth.
  static Result<std::unique_ptr<GroundPipeline>> Create(const GroundOptions& options,
                                                        const Rig& rig,
                                                        std::optional<RigidTransform> initial_pose);

  /// Before the first frame: goes on with a saved model, whose volume the options must have
  /// (ModelFile::AdoptVolume). The rig is looked for around the poses it knows. After a failure the
  /// pipeline must not be used.
  Status Continue(const ModelFile& model);
  bool is_continued() const { return is_continued_; }
  /// Everything that Continue needs.
  Status Save(const std::filesystem::path& path) const { return Save(path, 0); }
  /// The same of a sub-map that was never joined, 1 <= index < atlas().size() after Finish.
  Status Save(const std::filesystem::path& path, int index,
              const std::function<void(double fraction)>& progress = {}) const;

  DepthReport ProcessDepth(const DepthFrame& frame);
  /// Keeps the frame until the next tracked depth frame tells where the rig was (6.2.3).
  void ProcessThermal(ThermalFramePtr frame);
  /// Where an odometry source says that the rig was. In order of capture time, ideally before the
  /// first depth frame that is not older; late ones help the frames to come.
  void ProcessExternalOdometry(const ExternalOdometry& pose) { tracker_.AddExternalOdometry(pose); }
  /// For the frames to come, until said otherwise.
  void set_load_shedding(LoadShedding load_shedding) { load_shedding_ = load_shedding; }
  /// Thermal frames still waiting are counted as left out, and sub-maps become one model, but for
  /// those that were never joined. `progress` gets a fraction 0..1.
  void Finish(const std::function<void(double)>& progress = {});

  /// The volume of the active sub-map, in its coordinates; the whole model in `world` after Finish.
  const TsdfVolume& tsdf() const { return *atlas_.active().tsdf; }
  const ThermalVolume& thermal() const { return *atlas_.active().thermal; }
  const Atlas& atlas() const { return atlas_; }
  /// The model as seen from the last tracked pose; empty maps before the first frame.
  const ModelView& view() const { return tracker_.view(); }
  /// The same at the depth camera's full resolution, cast now.
  SurfaceMaps CastFullView();
  /// How uncertain the last tracked pose is.
  const PoseUncertainty& uncertainty() const { return tracker_.uncertainty(); }
  const RigTracker& tracker() const { return tracker_; }
  /// In `world`, as far as the sub-maps are joined, and as it is known by now: closing a loop moves
  /// what came before.
  const std::vector<StampedPose>& trajectory() const { return trajectory_; }
  /// One standard deviation of each pose of the trajectory, relative to the model.
  const std::vector<PoseSigma>& trajectory_sigmas() const { return trajectory_sigmas_; }
  const PipelineCounts& counts() const { return counts_; }
  /// Milliseconds per call by stage, in the order of the line.
  const std::map<std::string, StageStats>& stage_stats() const { return stage_stats_; }
  /// Why thermal frames are not fused at all, or ok.
  const Status& thermal_status() const { return thermal_status_; }
  const BlockSpiller& spiller() const { return spiller_; }
  int threads() const { return pool_.threads(); }
  /// For work between frames (views, results).
  ThreadPool& pool() { return pool_; }

 private:
  /// What the trajectory is made of whenever sub-maps move.
  struct TrackedPose {
    StampedMapPose pose;  ///< In the coordinates of sub-map `map`.
    PoseSigma sigma;      ///< Of any axes, since it is along the least certain direction.
    int map = 0;
  };

  GroundPipeline(const GroundOptions& options, const Rig& rig, const VoxelGrid& grid,
                 std::optional<RigidTransform> initial_pose);

  /// All that a depth frame does to the geometric model; the stage "depth_frame".
  DepthReport TrackAndIntegrate(const DepthFrame& frame);
  RigidTransform InitialPose(const PreparedDepth& depth) const;
  TrackingResult Track(const PreparedDepth& depth, CaptureTime time);
  /// Lost for long, with something in view: goes on in a sub-map of its own.
  bool BeginElsewhere(const PreparedDepth& depth, CaptureTime time);
  /// Goes on in another sub-map.
  void Activate(int index);
  void AddToTrajectory(const StampedMapPose& pose);
  /// If the sub-map is joined.
  void AppendToTrajectory(const TrackedPose& tracked);
  /// Closes loops and begins sub-maps; may change the active one, and the tracker's coordinates.
  void KeepSubMaps(const PreparedDepth& depth, const RigidTransform& T_map_depth);
  bool IsRepeated(const DepthFrame& frame);
  /// False if the model is still empty: nothing of the surface lies in the volume.
  bool Integrate(const PreparedDepth& depth, const RigidTransform& T_map_depth);
  void UpdateView(const RigidTransform& T_map_depth);
  /// Has what was spilled and comes into view read in the background.
  void FetchNearView(const RigidTransform& T_map_depth);
  void FuseThermal();
  /// At the end: all sub-maps into the first.
  void MergeMaps(const std::function<void(double)>& progress);

  const GroundOptions options_;
  const Rig rig_;
  const std::optional<RigidTransform> initial_pose_;
  Status thermal_status_;
  bool is_continued_ = false;
  ThreadPool pool_;
  DepthPreprocessor preprocessor_;
  RigTracker tracker_;
  TsdfIntegrator integrator_;
  IntegrationGate gate_;
  Atlas atlas_;
  LoopCloser loop_closer_;
  const PreparedDepth* last_depth_ = nullptr;  ///< The last depth frame; owned by the preprocessor.
  BlockSpiller spiller_;
  VisibleBlocks near_view_;
  std::uint64_t wrong_size_ = 0;  ///< Depth frames of another size, without a right one between.
  bool has_room_ = true;          ///< For temperatures; false once the disk to spill to is full.
  std::vector<TrackedPose> tracked_;
  std::vector<StampedPose> trajectory_;  ///< The poses of tracked_ that are joined, in world.
  std::vector<PoseSigma> trajectory_sigmas_;
  std::optional<CaptureTime> lost_since_;
  int searched_ = 0;                         ///< The sub-map a lost rig is looked for in.
  std::vector<StampedMapPose> unconfirmed_;  ///< Found again; part of the trajectory once believed.
  Image<std::uint16_t> last_raw_;            ///< Image of the last depth frame.
  LoadShedding load_shedding_ = LoadShedding::kNone;
  bool integrate_next_ = true;  ///< With kEverySecond.
  PipelineCounts counts_;
  std::map<std::string, StageStats> stage_stats_;
  std::optional<ThermalStage> thermal_stage_;  ///< Only if the rig's thermal frames can be fused.
};

}  // namespace isotherm
