#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "ground/evaluation/surface_evaluation.h"
#include "ground/evaluation/temperature_evaluation.h"
#include "ground/evaluation/thermal_coverage.h"
#include "ground/evaluation/trajectory_evaluation.h"
#include "ground/json/json.h"

namespace isotherm {

/// Holds what `isotherm evaluate` compares.
struct EvaluationRequest {
  std::filesystem::path result_dir;   ///< With trajectory.txt and cloud.ply.
  std::filesystem::path groundtruth;  ///< Trajectory file, or recording with ground truth.
  std::optional<std::filesystem::path> surface;
  std::optional<double> emissivity;        ///< Absent: temperatures are not compared.
  std::optional<double> refractive_index;  ///< Absent: emissivity does not depend on the angle.
  double ambient_celsius = 23.0;
  std::optional<std::filesystem::path> rig;  ///< Absent: coverage is not evaluated.
  std::size_t first = 0;
  std::optional<std::filesystem::path>
      skip_repeats;  ///< Recording whose repeated frames are left out.
  double tolerance_ms = 1.0;
  /// True surface outside this box (truth's world) does not count.
  std::optional<Eigen::AlignedBox3f> volume_box;
  /// Called between the steps with the fraction done, 0..1.
  std::function<void(double fraction)> progress{};
};

/// Holds a coverage and the limits that it was counted under.
struct CoverageUnderLimits {
  WellSeenLimits limits;
  ThermalCoverage coverage;
};

/// Holds how far a result is from the truth.
struct EvaluationReport {
  TrajectoryErrors trajectory;
  std::optional<SurfaceErrors> surface;
  std::size_t cloud_points = 0;
  std::optional<TemperatureReport> temperature;
  /// Coverage of the surface that the true poses showed at least twice in the thermal image, first
  /// under the limits that the result was measured under, then under others that are the same for
  /// all results. Empty: not evaluated.
  std::vector<CoverageUnderLimits> coverage;
};

Result<EvaluationReport> Evaluate(const EvaluationRequest& request);

std::string ToText(const EvaluationReport& report);
Json ToJson(const EvaluationReport& report);

}  // namespace isotherm
