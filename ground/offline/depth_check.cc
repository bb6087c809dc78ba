#include "ground/offline/depth_check.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

#include "common/geometry/map_pose.h"
#include "common/recording/recording.h"
#include "ground/offline/calibration_scan.h"
#include "ground/offline/recorded_frames.h"
#include "ground/options/ground_options.pb.h"
#include "ground/scan/scan_model.h"
#include "ground/surface/depth_preprocessor.h"
#include "ground/tsdf/raycaster.h"

namespace isotherm {
namespace {

/// Each takes a ray for every pixel. Twice as many change the result by less than it is uncertain.
constexpr std::size_t kFrames = 150;

}  // namespace

Result<DepthAssessment> CheckDepth(const std::filesystem::path& recording,
                                   const TrackedRecording& tracked, const GroundOptions& options,
                                   const std::function<void(double)>& progress) {
  Result<std::unique_ptr<RecordingReader>> reader = RecordingReader::Open(recording);
  if (!reader) return Err(reader.error());
  const ScanModel model = tracked.model();
  const std::vector<StampedPose>& poses = model.trajectory.poses();
  const std::size_t stride = 1 + poses.size() / kFrames;
  DepthPreprocessor preprocessor(options.preprocessor(), *tracked.rig().depth,
                                 tracked.rig().depth_sensor);
  Raycaster raycaster;
  SurfaceMaps maps;
  DepthConsistency consistency;
  std::size_t next = 0;
  const auto take = [&](const RecordedItem& item) {
    const auto* depth = std::get_if<RecordedDepth>(&item);
    if (depth == nullptr) return;
    while (next < poses.size() && poses[next].time < depth->frame.header.capture_time)
      next += stride;
    if (next >= poses.size() || poses[next].time != depth->frame.header.capture_time) return;
    const auto frame = Unpack(*depth, tracked.depth_scale());
    if (!frame) return;
    const PreparedDepth& prepared = preprocessor.Process(**frame, model.pool);
    const RigidTransform T_map_depth = InFirstMap(poses[next].T_world_depth);
    raycaster.Cast(model.tsdf(), prepared.camera, T_map_depth,
                   static_cast<float>(options.export_().expert().min_weight()), model.pool, maps);
    consistency.Add(prepared.depth_m, maps, T_map_depth,
                    static_cast<int>(next * DepthConsistency::kBlocks / poses.size()));
  };
  ReadItems(
      **reader, take, [](const Status&) {}, progress);
  return consistency.Assess();
}

}  // namespace isotherm
