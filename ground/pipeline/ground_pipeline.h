#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "common/base/stage_stats.h"
#include "common/concurrency/thread_pool.h"
#include "common/doubts/repeat_detector.h"
#include "common/frame/frame.h"
#include "common/rig/rig.h"
#include "ground/atlas/atlas.h"
#include "ground/model/block_spiller.h"
#include "ground/model/model_file.h"
#include "ground/options/ground_options.pb.h"
#include "ground/pipeline/load_shedding.h"
#include "ground/pipeline/thermal_pass.h"
#include "ground/pipeline/thermal_stage.h"
#include "ground/scan/depth_report.h"
#include "ground/scan/scan_counts.h"
#include "ground/scan/scan_model.h"
#include "ground/surface/depth_preprocessor.h"
#include "ground/tracker/tracker.h"
#include "ground/tsdf/tsdf_integrator.h"

namespace isotherm {

/// The straight line from frames to a validated thermogram (algorithm 1 and chapter 6), one frame
/// at a time, in capture-time order. Both drivers, live and inline, call it; it owns no thread but
/// its pool, no device and no clock that matters to the result (stage times are measured for
/// statistics only). Thread-bound.
class GroundPipeline {
 public:
  /// `rig` must have depth intrinsics. `initial_pose` is T_world_depth of the first depth frame;
  /// without one it comes from options.volume.expert.initial_pose, and without that the volume's
  /// centre is put on the first frame's optical axis at its median depth.
  static Result<std::unique_ptr<GroundPipeline>> Create(const GroundOptions& options,
                                                        const Rig& rig,
                                                        std::optional<RigidTransform> initial_pose);

  /// Before the first frame: goes on with a saved model, whose volume the options must have
  /// (ModelFile::AdoptVolume). The rig is looked for around the poses it knows. After a failure the
  /// pipeline must not be used.
  Status Continue(const ModelFile& model);

  DepthReport ProcessDepth(const DepthFrame& frame);
  /// Keeps the frame until the next tracked depth frame tells where the rig was (6.2.3).
  void ProcessThermal(ThermalFramePtr frame);
  /// Takes where an odometry source says that the rig was. Poses come in order of capture time,
  /// ideally before the first depth frame that is not older; late ones help the frames to come.
  void ProcessExternalOdometry(const ExternalOdometry& pose) { tracker_.AddExternalOdometry(pose); }
  /// For the frames to come, until said otherwise.
  void set_load_shedding(LoadShedding load_shedding) { load_shedding_ = load_shedding; }
  /// Thermal frames still waiting are counted as left out, and sub-maps become one model, but for
  /// those that were never joined. `progress` gets a fraction 0..1.
  void Finish(const std::function<void(double)>& progress = {});

  /// After Finish: forgets all temperatures, and returns the pass that assigns them anew; it must
  /// get all frames of the scan again, and refers to the pipeline. Returns nullptr, and changes
  /// nothing, if there is nothing to assign, or parts of the model are on the disk.
  std::unique_ptr<ThermalPass> BeginThermalPass();

  /// Returns what all frames so far have given.
  ScanModel model();

 private:
  GroundPipeline(const GroundOptions& options, const Rig& rig, const VoxelGrid& grid,
                 const std::optional<RigidTransform>& initial_pose);

  /// False for frames that cannot be used, or say nothing new.
  bool Admit(const DepthFrame& frame, DepthReport& report);
  bool HasCalibratedSize(const DepthFrame& frame);

  // The verbs of a depth frame's life, in order. Each leaves alone what the one before gave up.
  const PreparedDepth& Prepare(const DepthFrame& frame);
  TrackedFrame Track(const PreparedDepth& depth, CaptureTime time);
  /// True if the frame became part of the surface. A first frame that shows none is lost.
  bool Integrate(const PreparedDepth& depth, TrackedFrame& frame);
  /// Casts the model from the rig's pose: the view that the next frame is tracked against.
  void Raycast(const TrackedFrame& frame);
  void FuseThermal(const PreparedDepth& depth, const TrackedFrame& frame);
  DepthReport Report(const TrackedFrame& frame, bool integrated) const;

  /// Returns whether the pose is known to within the band that a surface takes. Along a direction
  /// that the view does not hold it may be anywhere after a while, and what was added there would
  /// not meet what the model has of the same surface.
  bool IsCertain() const;
  /// Returns whether this frame is to be integrated: the pose is certain, its turn has come, and
  /// the rig moved as it should.
  bool IsDue(const TrackedFrame& frame);
  /// False if the model is still empty: nothing of the surface lies in the volume.
  bool AddSurface(const PreparedDepth& depth, const RigidTransform& T_map_depth);
  /// Has what was spilled and comes into view read in the background.
  void ReadAheadAround(const RigidTransform& T_map_depth);
  void RaycastFrom(const RigidTransform& T_map_depth);
  /// At the end: all sub-maps into the first.
  void MergeMaps(const std::function<void(double)>& progress);

  /// Holds how certain a pose was (TrackedDepth).
  struct PoseCertainty {
    CaptureTime time;
    float surface_sigma_rad;
    float mean_depth_m;
  };
  /// Does to no depth what is done to each depth image, so that the first is not slower.
  void WarmUp();
  void MakeThermalStage();

  /// Holds the times of work that no stage counts itself.
  struct OwnTimes {
    StageStats depth_frame, preprocess, integrate, merge;
  };

  const GroundOptions options_;
  const Rig rig_;
  Status thermal_status_;
  bool is_continued_ = false;
  ThreadPool pool_;
  ScanCounts counts_;
  OwnTimes times_;
  Atlas atlas_;
  DepthPreprocessor preprocessor_;
  Tracker tracker_;
  TsdfIntegrator integrator_;
  IntegrationGate gate_;
  BlockSpiller spiller_;
  VisibleBlocks near_view_;
  std::uint64_t wrong_size_ = 0;  ///< Depth frames of another size, without a right one between.
  RepeatDetector repeats_;        ///< Among depth frames.
  std::vector<PoseCertainty> certainties_;  ///< One for each tracked frame, in order of time.
  bool thermal_has_room_ = true;  ///< For temperatures; false once the disk to spill to is full.
  LoadShedding load_shedding_ = LoadShedding::kNone;
  bool slides_ = false;  ///< DepthReport::slides of the last frame that was tracked.
  int turn_ = 0;         ///< To be integrated, with kEverySecond and kEveryFourth.
  std::optional<ThermalStage> thermal_stage_;  ///< Only if the rig's thermal frames can be fused.
};

}  // namespace isotherm
