#include <algorithm>

#include "common/simulation/scene_builder.h"
#include "ground/experiment/experiment.h"
#include "ground/experiment/experiment_scan.h"
#include "ground/experiment/model_check.h"
#include "ground/experiment/true_conditions.h"
#include "ground/renderer/renderer.h"

namespace isotherm {
namespace {

constexpr double kDuration_s = 3.0;

/// Boards at several distances and slants.
StagedScene SlantedBoards() {
  SceneBuilder scene(23.0);
  scene.UseMaterial({});
  scene.Box("wall", {0.02, 0.02, 0.88}, {0.94, 0.94, 0.94}).temperature = Uniform(28.0);
  scene.Box("floor", {0.02, 0.82, 0.30}, {0.94, 0.88, 0.88}).temperature = Uniform(30.0);
  scene.RotatedBox("near board", {0.34, 0.40, 0.42}, {0.20, 0.20, 0.02}, {0, 0, 0}).temperature =
      Uniform(60.0);
  scene.RotatedBox("turned board", {0.64, 0.36, 0.56}, {0.22, 0.22, 0.02}, {0, 50, 0}).temperature =
      Uniform(50.0);
  scene.RotatedBox("leaning board", {0.36, 0.68, 0.60}, {0.24, 0.20, 0.02}, {-50, 0, 0})
      .temperature = Uniform(45.0);
  scene.RotatedBox("steep board", {0.68, 0.66, 0.66}, {0.20, 0.18, 0.02}, {0, -25, 0}).temperature =
      Uniform(40.0);
  ScanPath path;
  path.target_x_m = {0.48, 0.05, 4.0};
  path.target_y_m = {0.50, 0.03, 3.1};
  path.target_z_m = {0.56};
  path.azimuth_rad = {0.0, 0.10, 3.6};
  path.elevation_rad = {0.10, 0.05, 2.9};
  path.distance_m = {0.58, 0.04, 5.0};
  return {scene.Build("slanted boards"), path, {}};
}

/// Per cent. It was 99 (measured 99.2) as long as the rim of the thermal image was cut off. All but
/// one of the 65 wrong ones of 6272 have a wrong angle: at a board's end and on the wall a metre
/// away, which the rim sees, the model's normals are off by more than the 5 degrees that are
/// allowed for.
constexpr double kMinTrueClasses = 99.0;

/// The thermal frames that lie between depth frames, so that their poses are known.
std::vector<std::size_t> FramesWithPoses(const SimulatedScan& scan) {
  std::vector<std::size_t> frames;
  for (std::size_t i = 0; i < scan.thermal_times().size(); ++i) {
    const CaptureTime time = scan.thermal_times()[i].exposure;
    if (time > scan.depth_times().front().exposure && time < scan.depth_times().back().exposure)
      frames.push_back(i);
  }
  return frames;
}

/// The classes that a point must have; nullopt near a border between classes, in the conditions or
/// on the surface.
std::optional<TrueClasses> ClassesAt(const SimulatedScan& scan,
                                     const std::vector<std::size_t>& frames,
                                     const ThermalOptions& limits, const SurfacePoint& point) {
  // Three voxels: within them the model's surface and classes may be those of the neighbour.
  constexpr double kBorder_m = 0.006;
  constexpr double kAbove_m = 0.008;  // The surface around is met from this high above the plane.
  const auto classes = ExpectClasses(TrueConditions(scan, frames, point), limits);
  if (!classes) return std::nullopt;
  const Eigen::Vector3d right = point.n_world.unitOrthogonal();
  const Eigen::Vector3d down = point.n_world.cross(right);
  for (const Eigen::Vector3d& side :
       {right, Eigen::Vector3d(-right), down, Eigen::Vector3d(-down)}) {
    const auto around = scan.scene().Intersect(
        point.p_world + kBorder_m * side + kAbove_m * point.n_world, -point.n_world);
    if (!around || around->distance > 2.0 * kAbove_m) return std::nullopt;
    if (ExpectClasses(TrueConditions(scan, frames, around->point), limits) != classes)
      return std::nullopt;
  }
  return classes;
}

struct Agreement {
  double all = 0.0;                                ///< Points of the surface.
  double points = 0.0;                             ///< Points that were measured.
  double sure = 0.0;                               ///< Measured points away from borders.
  double distance = 0.0, angle = 0.0, both = 0.0;  ///< Sure points with the true class.
  double by_chance = 0.0;  ///< With the classes that are true of another point.
};

Agreement Compare(const PlayedScan& played, const ThermalOptions& limits, ThreadPool& pool) {
  constexpr std::size_t kEvery = 15;  // Of the points, for time.
  const SimulatedScan& scan = *played.scan;
  const ScanModel model = played.pipelines.front()->model();
  std::vector<CheckedPoint> points;
  const auto all = CheckModel(scan.scene(), scan.band(), model.tsdf(), model.thermal(), pool);
  Agreement agreement;
  for (std::size_t i = 0; i < all.size(); i += kEvery) {
    agreement.all += 1.0;
    if (all[i].point.distance_class != kNeverMeasured) points.push_back(all[i]);
  }
  const std::vector<std::size_t> frames = FramesWithPoses(scan);
  std::vector<std::optional<TrueClasses>> expected(points.size());
  pool.ParallelFor(static_cast<int>(points.size()), [&](int i) {
    const auto index = static_cast<std::size_t>(i);
    expected[index] = ClassesAt(scan, frames, limits, points[index].truth);
  });
  agreement.points = static_cast<double>(points.size());
  std::vector<std::size_t> sure;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (expected[i]) sure.push_back(i);
  }
  agreement.sure = static_cast<double>(sure.size());
  for (std::size_t k = 0; k < sure.size(); ++k) {
    const CloudPoint& point = points[sure[k]].point;
    const auto has_distance = [&](const TrueClasses& classes) {
      return point.distance_class == static_cast<std::uint8_t>(classes.distance);
    };
    const auto has_angle = [&](const TrueClasses& classes) {
      return point.angle_class == static_cast<std::uint8_t>(classes.angle);
    };
    const TrueClasses& own = *expected[sure[k]];
    const TrueClasses& other = *expected[sure[(k + sure.size() / 2) % sure.size()]];
    agreement.distance += has_distance(own) ? 1.0 : 0.0;
    agreement.angle += has_angle(own) ? 1.0 : 0.0;
    agreement.both += has_distance(own) && has_angle(own) ? 1.0 : 0.0;
    agreement.by_chance += has_distance(other) && has_angle(other) ? 1.0 : 0.0;
  }
  return agreement;
}

}  // namespace

Result<ExperimentReport> RunConfidenceExperiment(ThreadPool& pool) {
  // The boards' slants, 0, 25 and 50 degrees, lie in the middle of its classes.
  const GroundOptions options = OptionsForSlantedSurfaces();
  const auto played =
      Play(ExperimentCameras(kDuration_s, kSharpEverywhere), SlantedBoards(), {options}, pool);
  if (!played) return Err(played.error());
  const Agreement agreement = Compare(*played, options.thermal(), pool);
  ExperimentReport report;
  report.table.rows_are = "classes";
  report.table.columns = {"points", "away from class borders", "with the true class",
                          "with the true class [%]", "coverage [% of the surface]"};
  const auto row = [&](const char* label, double right) {
    report.table.rows.push_back(
        {label,
         {agreement.points, agreement.sure, right, 100.0 * right / agreement.sure,
          100.0 * agreement.points / agreement.all}});
  };
  row("distance", agreement.distance);
  row("angle", agreement.angle);
  row("both", agreement.both);
  row("both, of another point", agreement.by_chance);
  const Requirement true_classes = {"points with the true classes, away from class borders",
                                    report.table.rows[2].values[3], Requirement::Sense::kAtLeast,
                                    kMinTrueClasses, "%"};
  report.requirements = {
      true_classes,
      NegativeControl(true_classes, "points with the classes that are true of another point",
                      report.table.rows[3].values[3]),
      {"points that are away from class borders", 100.0 * agreement.sure / agreement.points,
       Requirement::Sense::kAtLeast, 50.0, "%"}};
  const Renderer renderer({}, options.thermal());
  const ScanModel model = played->pipelines.front()->model();
  const ViewMaps view = LookAtModel(model.tsdf(), model.thermal(), *played->scan->rig().depth,
                                    model.trajectory.poses().back().T_world_depth, pool);
  report.renderings = {{"thermal", renderer.Thermal(view)},
                       {"distance", renderer.Distance(view)},
                       {"angle", renderer.Angle(view)}};
  return report;
}

}  // namespace isotherm
