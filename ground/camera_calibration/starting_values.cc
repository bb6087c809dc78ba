#include "ground/camera_calibration/starting_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "common/base/units.h"
#include "ground/camera_calibration/opencv_calibration.h"
#include "ground/camera_calibration/target_calibration.h"

namespace isotherm {
namespace {

/// Fewer cannot tell a lens from the board's shape.
constexpr std::size_t kMinViews = 6;
/// Views that all face the same way do not tell focal length from distance.
constexpr double kMinSpread_deg = 10.0;

Status CheckSizes(const CalibrationInput& input) {
  for (std::size_t camera = 0; camera < input.camera_names.size(); ++camera) {
    const CalibrationView* first = nullptr;
    for (const CalibrationView& view : input.views) {
      const Image<float>& image = view.images[camera];
      if (image.empty()) continue;
      if (first == nullptr) first = &view;
      const Image<float>& reference = first->images[camera];
      if (image.width() == reference.width() && image.height() == reference.height()) continue;
      return InvalidArgument(fmt::format(
          "{} image {} has {} x {} pixels, {} has {} x {}: give images of one camera in one mode",
          input.camera_names[camera], view.name, image.width(), image.height(), first->name,
          reference.width(), reference.height()));
    }
  }
  return OkStatus();
}

/// The target in one image, if it is still enough there.
Result<DetectedTarget> Detect(const CalibrationInput& input, int view, int camera) {
  const CalibrationView& v = input.views[static_cast<std::size_t>(view)];
  const auto index = static_cast<std::size_t>(camera);
  Result<DetectedTarget> detected = DetectTarget(v.images[index], input.target);
  if (!detected || index >= v.samples.size()) return detected;
  const std::optional<double> scatter = FeatureScatter(v.samples[index], input.target);
  constexpr double kMaxScatter_px = 0.12;  // Thesis 5.2.3.
  if (scatter && *scatter > kMaxScatter_px) {
    return Err(FailedPrecondition(fmt::format(
        "a feature scatters by {:.2f} px from frame to frame, more than {:.2f}: hold the target "
        "still, with more contrast",
        *scatter, kMaxScatter_px)));
  }
  return detected;
}

std::string FirstReasons(const std::vector<RefusedImage>& refused) {
  std::string text;
  constexpr std::size_t kMaxReasons = 2;
  for (std::size_t i = 0; i < std::min(kMaxReasons, refused.size()); ++i)
    text += fmt::format("; {}: {}", refused[i].name, refused[i].reason);
  return text;
}

/// The largest angle between two views' boards.
double SpreadDegrees(const std::vector<RigidTransform>& poses) {
  double min_cosine = 1.0;
  for (const RigidTransform& a : poses) {
    for (const RigidTransform& b : poses)
      min_cosine = std::min(min_cosine, a.linear().col(2).dot(b.linear().col(2)));
  }
  return std::acos(std::clamp(min_cosine, -1.0, 1.0)) / kRadPerDeg;
}

/// Holds what OpenCV makes of one camera's images.
struct CameraStart {
  BundleCamera camera;
  std::map<int, RigidTransform> T_camera_board;  ///< By view.
};

Result<CameraStart> StartCamera(const CalibrationInput& input, const std::vector<SeenTarget>& seen,
                                int camera) {
  std::vector<std::vector<Eigen::Vector2d>> features;
  std::vector<int> views;
  for (const SeenTarget& s : seen) {
    if (s.camera != camera) continue;
    features.push_back(s.detected.features);
    views.push_back(s.view);
  }
  const auto index = static_cast<std::size_t>(camera);
  const Image<float>& image = input.views[static_cast<std::size_t>(views.front())].images[index];
  const Result<OpenCvCalibration> start =
      StartWithOpenCv(input.target, features, {image.width(), image.height()});
  if (!start) return Err(start.error());
  if (const double spread = SpreadDegrees(start->T_camera_board); spread < kMinSpread_deg) {
    return Err(FailedPrecondition(fmt::format(
        "all {} views of the {} camera are parallel within {:.0f} degrees, which tells no focal "
        "length: tilt the target by 30 to 45 degrees about both of its axes",
        views.size(), input.camera_names[index], spread)));
  }
  CameraStart result;
  result.camera = AsStart(start->lens, input.lenses[index]);
  for (std::size_t i = 0; i < views.size(); ++i)
    result.T_camera_board[views[i]] = start->T_camera_board[i];
  return result;
}

/// Returns, of the poses in the rig that single views give a camera, the one nearest to the others.
std::optional<RigidTransform> MiddlePose(const std::map<int, RigidTransform>& T_camera_board,
                                         const std::map<int, RigidTransform>& T_rig_board) {
  std::vector<RigidTransform> poses;
  for (const auto& [view, pose] : T_camera_board) {
    const auto other = T_rig_board.find(view);
    if (other != T_rig_board.end()) poses.push_back(pose * other->second.inverse());
  }
  std::optional<RigidTransform> best;
  double best_sum = 0.0;
  for (const RigidTransform& pose : poses) {
    double sum = 0.0;
    constexpr double kArm_m = 0.7;  // How far rotations reach, so that both count alike.
    for (const RigidTransform& other : poses)
      sum += TranslationDistance(pose, other) + kArm_m * RotationAngle(pose, other);
    if (best && sum >= best_sum) continue;
    best = pose;
    best_sum = sum;
  }
  return best;
}

}  // namespace

BundleCamera AsStart(const LensParameters& found, LensKind kind) {
  BundleCamera camera{kind, found, RigidTransform::Identity()};
  // Polynomials of another thing: a fisheye begins without any.
  if (kind == LensKind::kFisheye) std::fill(camera.lens.begin() + 4, camera.lens.end(), 0.0);
  return camera;
}

Result<std::vector<SeenTarget>> DetectInAll(const CalibrationInput& input, ThreadPool& pool,
                                            const std::function<void(double)>& progress,
                                            std::vector<RefusedImage>& refused) {
  if (Status status = CheckSizes(input); !status.ok()) return Err(status);
  struct Task {
    int camera, view;
    std::optional<Result<DetectedTarget>> result;
  };
  std::vector<Task> tasks;
  for (std::size_t view = 0; view < input.views.size(); ++view) {
    for (std::size_t camera = 0; camera < input.camera_names.size(); ++camera) {
      if (!input.views[view].images[camera].empty())
        tasks.push_back({static_cast<int>(camera), static_cast<int>(view), {}});
    }
  }
  // Some at a time, so that the progress is told by this thread.
  const int batch = 2 * pool.threads();
  for (int first = 0; first < static_cast<int>(tasks.size()); first += batch) {
    pool.ParallelFor(std::min(batch, static_cast<int>(tasks.size()) - first), [&](int i) {
      Task& task = tasks[static_cast<std::size_t>(first + i)];
      task.result.emplace(Detect(input, task.view, task.camera));
    });
    progress(std::min(1.0, static_cast<double>(first + batch) / static_cast<double>(tasks.size())));
  }
  std::vector<SeenTarget> seen;
  for (const Task& task : tasks) {
    if (*task.result) {
      seen.push_back({task.camera, task.view, **task.result});
    } else {
      refused.push_back({input.views[static_cast<std::size_t>(task.view)].name,
                         input.camera_names[static_cast<std::size_t>(task.camera)],
                         task.result->error().message()});
    }
  }
  Status enough = CheckViews(input, seen);
  if (!enough.ok()) return Err(Status(enough.code(), enough.message() + FirstReasons(refused)));
  return seen;
}

Status CheckViews(const CalibrationInput& input, const std::vector<SeenTarget>& seen) {
  std::vector<std::set<int>> views(input.camera_names.size());
  for (const SeenTarget& s : seen) views[static_cast<std::size_t>(s.camera)].insert(s.view);
  for (std::size_t camera = 0; camera < views.size(); ++camera) {
    if (views[camera].size() >= kMinViews) continue;
    return FailedPrecondition(fmt::format(
        "the target '{}' counts in {} of {} {} images, at least {} are needed: take 30 or more, "
        "near and far, tilted, and into the corners",
        input.target.spec, views[camera].size(), input.views.size(), input.camera_names[camera],
        kMinViews));
  }
  if (views.size() < 2) return OkStatus();
  std::vector<int> both;
  std::set_intersection(views[0].begin(), views[0].end(), views[1].begin(), views[1].end(),
                        std::back_inserter(both));
  if (both.size() >= kMinViews) return OkStatus();
  return FailedPrecondition(fmt::format(
      "both cameras saw the target at once in {} views, at least {} are needed: hold it where both "
      "see all of it",
      both.size(), kMinViews));
}

Result<StartingValues> FindStart(const CalibrationInput& input,
                                 const std::vector<SeenTarget>& seen) {
  StartingValues start;
  std::map<int, RigidTransform> T_rig_board;
  for (int camera = 0; camera < static_cast<int>(input.camera_names.size()); ++camera) {
    Result<CameraStart> one = StartCamera(input, seen, camera);
    if (!one) return Err(one.error());
    if (camera > 0) {
      const std::optional<RigidTransform> pose = MiddlePose(one->T_camera_board, T_rig_board);
      if (!pose) return Err(FailedPrecondition("no view shows the target to both cameras"));
      one->camera.T_camera_rig = *pose;
    }
    const RigidTransform T_rig_camera = one->camera.T_camera_rig.inverse();
    for (const auto& [view, pose] : one->T_camera_board)
      T_rig_board.try_emplace(view, T_rig_camera * pose);
    start.state.cameras.push_back(one->camera);
  }
  start.state.T_rig_board.assign(input.views.size(), RigidTransform::Identity());
  for (const auto& [view, pose] : T_rig_board)
    start.state.T_rig_board[static_cast<std::size_t>(view)] = pose;
  return start;
}

}  // namespace isotherm
