#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string_view>
#include <vector>

#include "common/base/status.h"
#include "common/recording/recording.h"
#include "ground/interpretation/interpretation.h"
#include "ground/json/json.h"
#include "ground/renderer/temperature_scale.h"
#include "ground/surface/surface_maps.h"
#include "ground/thermal/thermal_volume.h"
#include "ground/tsdf/tsdf_volume.h"

namespace isotherm {

class ExportOptions;
class RendererOptions;
class ThermalOptions;
class ThreadPool;

Status Validate(const ExportOptions& options);

/// Creates the folder and proves, by writing and removing a small file, that
/// results can be written there. To be called before a scan, so that no scan is lost for want of a
/// place.
Status PrepareOutputDir(const std::filesystem::path& dir);

/// Returns the files of the results that are in the folder, in the order of their names; empty if
/// there are none, or no such folder.
std::vector<std::filesystem::path> ResultFilesIn(const std::filesystem::path& dir);
/// Returns whether results of a scan are in the folder.
bool HoldsResults(const std::filesystem::path& dir);

/// Removes files that bear names of results and are not among `written` (relative to `dir`): what
/// an earlier scan left must not pass for part of this one's.
void RemoveOtherResults(const std::filesystem::path& dir, const std::set<std::string>& written);

struct ResultSummary;

/// All that a finished scan leaves behind.
struct ResultInputs {
  const TsdfVolume& tsdf;
  const ThermalVolume& thermal;
  std::optional<std::span<const StampedPose>> trajectory;  ///< nullopt: no trajectory.txt.
  /// Shows the model as it looks from `p_map_viewer`, ray-cast, in `map`; nullptr: no renderings.
  const SurfaceMaps* view = nullptr;
  Eigen::Vector3d p_map_viewer = Eigen::Vector3d::Zero();
  const RendererOptions& renderer_options;
  const ThermalOptions& thermal_options;
  const ExportOptions& export_options;
  const Interpretation* interpretation = nullptr;  ///< nullptr: temperatures stay apparent.
  const Json& stats;  ///< Becomes stats.json, with `software`, `surface`, `interpretation` added.
  /// Returns the warnings that the surface gives reason for; they go into stats.json as `warnings`.
  /// May be empty.
  std::function<std::vector<std::string>(const ResultSummary&)> warnings{};
};

/// Holds what was written, for a summary on the screen.
struct ResultSummary {
  std::size_t points = 0;
  std::size_t measured_points = 0;  ///< Points with a temperature.
  std::size_t good_points =
      0;  ///< Points with a temperature that is measured well (MeasurementQuality).
  std::size_t triangles = 0;
  std::optional<TemperatureScale> scale;  ///< The scale of renderings and colours alike.
  TemperatureStatistics temperatures;
  /// Standard uncertainties of the temperatures, as far as they are known, kelvin.
  struct {
    std::size_t points = 0;
    double median_k = 0.0, p95_k = 0.0;
  } sigma;
  std::vector<PartReport> interpretation;  ///< One per part; may be empty.
};

/// Called before each step with what is about to be written and the fraction done, 0..1.
using ResultProgress = std::function<void(std::string_view what, double fraction)>;

/// Writes trajectory.txt, renders/*.png, stats.json, cloud.ply and mesh.ply into `dir` (which must
/// exist), small and irreplaceable ones first. Colours use one scale, derived from the whole
/// surface. A file that fails does not stop the others; the first failure is returned. The same
/// inputs give the same bytes.
Result<ResultSummary> WriteResults(const ResultInputs& inputs, const std::filesystem::path& dir,
                                   ThreadPool& threads, const ResultProgress& progress = {});

}  // namespace isotherm
