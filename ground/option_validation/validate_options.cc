#include "ground/option_validation/validate_options.h"

#include <fmt/format.h>

#include <utility>

#include "ground/calibration/calibration_check.h"
#include "ground/console/console_options.h"
#include "ground/export/result_files.h"
#include "ground/feedback/advice.h"
#include "ground/icp/icp_tracker.h"
#include "ground/interpretation/interpretation.h"
#include "ground/options/ground_options.pb.h"
#include "ground/options/option_geometry.h"
#include "ground/relocaliser/relocaliser.h"
#include "ground/renderer/renderer.h"
#include "ground/surface/depth_preprocessor.h"
#include "ground/thermal/thermal_options.h"
#include "ground/tsdf/growing_arena.h"
#include "ground/tsdf/raycaster.h"
#include "ground/tsdf/tsdf_integrator.h"

namespace isotherm {

Status Validate(const LiveOptions& o) {
  // The largest whose ports are below 65536.
  constexpr int kMaxDomain = 230;
  if (o.domain() < 0 || o.domain() > kMaxDomain) {
    return InvalidArgument(
        fmt::format("live.domain must be 0..{}, got {}", kMaxDomain, o.domain()));
  }
  if (o.expert().queue_frames() < 1 || o.expert().queue_frames() > 4096) {
    return InvalidArgument(
        fmt::format("live.expert.queue_frames must be 1..4096, got {}", o.expert().queue_frames()));
  }
  if (!(o.expert().feedback_hz() > 0.0 && o.expert().feedback_hz() <= 100.0)) {
    return InvalidArgument(
        fmt::format("live.expert.feedback_hz must be above 0 and at most 100 Hz, got {}",
                    o.expert().feedback_hz()));
  }
  if (!(o.expert().reorder_window_s() >= 0.0 && o.expert().reorder_window_s() <= 0.2)) {
    return InvalidArgument(fmt::format("live.expert.reorder_window_s must be 0..0.2 s, got {}",
                                       o.expert().reorder_window_s()));
  }
  if (!(o.expert().max_wait_s() == 0.0 ||
        (o.expert().max_wait_s() >= 0.05 && o.expert().max_wait_s() <= 10.0))) {
    return InvalidArgument(fmt::format(
        "live.expert.max_wait_s must be 0 (never leave work out) or 0.05 to 10 s, got {}",
        o.expert().max_wait_s()));
  }
  if (!(o.expert().max_clock_offset_s() == 0.0 ||
        (o.expert().max_clock_offset_s() >= 0.001 && o.expert().max_clock_offset_s() <= 3600.0))) {
    return InvalidArgument(fmt::format(
        "live.expert.max_clock_offset_s must be 0 (no alarm) or 0.001 to 3600 s, got {}",
        o.expert().max_clock_offset_s()));
  }
  if (!(o.quota_gb() >= 0.0 && o.quota_gb() <= 1e6)) {
    return InvalidArgument(
        fmt::format("live.quota_gb must be 0 (no quota) to 1000000 GB, got {}", o.quota_gb()));
  }
  if (o.output_dir().empty()) return InvalidArgument("live.output_dir must name a folder");
  return OkStatus();
}

std::vector<Status> ValidateAll(const GroundOptions& options) {
  std::vector<Status> problems;
  const auto check = [&](Status status) {
    if (!status.ok()) problems.push_back(std::move(status));
  };
  // All are checked, so that the user sees every mistake at once.
  check(Validate(options.volume()));
  check(CheckSpillDir(options.volume().spill_dir()));
  check(Validate(options.preprocessor()));
  check(Validate(options.tracker()));
  check(Validate(options.relocaliser()));
  check(Validate(options.tsdf(), options.volume()));
  check(Validate(options.raycast()));
  check(Validate(options.thermal()));
  check(Validate(options.renderer()));
  check(Validate(options.export_()));
  check(Validate(options.interpretation()));
  check(Validate(options.live()));
  check(Validate(options.feedback()));
  check(Validate(options.calibration_check()));
  check(Validate(options.console()));
  if (options.threads() < 0 || options.threads() > 256) {
    check(InvalidArgument(
        fmt::format("threads must be 0 (one per core) to 256, got {}", options.threads())));
  }
  if (options.volume().expert().has_initial_pose()) {
    if (const auto pose = ToTransform(options.volume().expert().initial_pose()); !pose) {
      check(pose.error().WithContext("volume.expert.initial_pose"));
    }
  }
  return problems;
}

}  // namespace isotherm
