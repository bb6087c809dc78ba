#include "ground/export/result_files.h"

#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <system_error>
#include <vector>

#include "common/base/output_file.h"
#include "common/base/quantile.h"
#include "common/concurrency/thread_pool.h"
#include "ground/export/ply.h"
#include "ground/export/png_file.h"
#include "ground/export/trajectory_text.h"
#include "ground/mesh/surface.h"
#include "ground/options/ground_options.pb.h"
#include "ground/renderer/renderer.h"

namespace isotherm {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSoftware = "Isotherm " ISOTHERM_VERSION;

/// Keeps the first failure and lets the rest go on.
class FirstFailure {
 public:
  void Add(Status status) {
    if (first_.ok()) first_ = std::move(status);
  }
  const Status& status() const { return first_; }

 private:
  Status first_;
};

ResultSummary SummarizeSurface(const Surface& surface, const RendererOptions& options) {
  ResultSummary summary;
  summary.points = surface.points.size();
  summary.triangles = surface.triangles.size();
  std::vector<float> celsius;
  std::vector<double> sigmas_k;
  celsius.reserve(surface.points.size());
  for (const CloudPoint& point : surface.points) {
    celsius.push_back(point.celsius);
    if (std::isnan(point.celsius)) continue;
    if (!std::isnan(point.sigma_k)) sigmas_k.push_back(static_cast<double>(point.sigma_k));
    ++summary.measured_points;
    if (QualityOf(point.distance_class, point.angle_class, point.motion_class) ==
        MeasurementQuality::kGood)
      ++summary.good_points;
  }
  if (!sigmas_k.empty()) {
    constexpr double kNearlyAll = 0.95;
    summary.sigma = {sigmas_k.size(), TakeMedian(sigmas_k), TakeQuantile(sigmas_k, kNearlyAll)};
  }
  summary.temperatures = Summarize(celsius);
  summary.scale = ChooseScale(options, celsius);
  return summary;
}

Json SurfaceStats(const ResultSummary& summary) {
  const auto fraction = [&](std::size_t part) {
    return summary.points == 0
               ? Json()
               : Json(static_cast<double>(part) / static_cast<double>(summary.points));
  };
  Json stats;
  stats["points"] = summary.points;
  stats["triangles"] = summary.triangles;
  stats["measured_fraction"] = fraction(summary.measured_points);
  stats["good_fraction"] = fraction(summary.good_points);
  if (summary.temperatures.count > 0) {
    stats["min_celsius"] = summary.temperatures.min_celsius;
    stats["mean_celsius"] = summary.temperatures.mean_celsius;
    stats["max_celsius"] = summary.temperatures.max_celsius;
  }
  if (summary.sigma.points > 0) {
    stats["temperature_sigma_k"]["p50"] = summary.sigma.median_k;
    stats["temperature_sigma_k"]["p95"] = summary.sigma.p95_k;
  }
  if (summary.scale) {
    stats["palette_min_celsius"] = summary.scale->min_celsius;
    stats["palette_max_celsius"] = summary.scale->max_celsius;
  }
  return stats;
}

void WriteRenders(const ResultInputs& inputs, const std::optional<TemperatureScale>& scale,
                  const fs::path& folder, ThreadPool& threads, FirstFailure& failure) {
  std::error_code ignored;  // A folder that is not there shows when files cannot be written.
  fs::create_directories(folder, ignored);
  ViewMaps view;
  SampleView(*inputs.view, inputs.p_map_viewer, inputs.tsdf, inputs.thermal, threads, view);
  SampleRecords(*inputs.view, inputs.tsdf, inputs.thermal, threads, view);
  if (inputs.interpretation != nullptr) {
    inputs.interpretation->Apply(*inputs.view, view);
    view.celsius_meaning = "object temperature";
  }
  const Renderer renderer(inputs.renderer_options, inputs.thermal_options);
  std::optional<ContourField> contours;
  if (renderer.draws_lines()) {
    contours = SampleContours(*inputs.view, inputs.tsdf, inputs.thermal,
                              inputs.renderer_options.expert().isotherm_smoothing_px(), threads);
    if (inputs.interpretation != nullptr)
      inputs.interpretation->Apply(*inputs.view, view, contours->celsius);
  }
  for (const RenderLayer layer : AllLayers()) {
    const RgbImage rendering = renderer.Draw(layer, view, scale, contours ? &*contours : nullptr);
    failure.Add(WritePng(rendering, folder / fmt::format("{}.png", LayerName(layer))));
  }
}

Json CompleteStats(const ResultInputs& inputs, const ResultSummary& summary) {
  Json stats = inputs.stats;
  stats["software"] = kSoftware;
  stats["surface"] = SurfaceStats(summary);
  if (inputs.interpretation != nullptr)
    stats["interpretation"] = inputs.interpretation->Describe(summary.interpretation);
  if (inputs.warnings) {
    for (const std::string& warning : inputs.warnings(summary))
      stats["warnings"].push_back(warning);
  }
  return stats;
}

/// trajectory.txt, stats.json, cloud.ply, mesh.ply, model.iso, model-2.iso and so on.
bool IsResultName(const std::string& name) {
  if (name.starts_with("model-") && name.ends_with(".iso")) return true;
  constexpr std::string_view kNames[] = {"trajectory.txt", "stats.json", "cloud.ply", "mesh.ply",
                                         "model.iso"};
  return std::ranges::count(kNames, name) > 0;
}

/// Calls `use` for each file of a result, and of its renderings those that the results draw.
void ForEachResult(const fs::path& dir, const std::function<void(const fs::path&)>& use) {
  std::error_code error;
  for (fs::directory_iterator entry(dir, error), end; !error && entry != end;
       entry.increment(error)) {
    if (IsResultName(entry->path().filename().string())) use(entry->path());
  }
  for (const RenderLayer layer : AllLayers()) {
    const fs::path rendering = dir / "renders" / fmt::format("{}.png", LayerName(layer));
    if (fs::exists(rendering, error)) use(rendering);
  }
}

}  // namespace

Status Validate(const ExportOptions& options) {
  constexpr double kMax = 1000.0;  // As tsdf.expert.max_weight.
  if (!(options.expert().min_weight() > 0.0 && options.expert().min_weight() <= kMax)) {
    return InvalidArgument(
        fmt::format("export.expert.min_weight is {}, must be above 0 and at most {}",
                    options.expert().min_weight(), kMax));
  }
  return OkStatus();
}

Status PrepareOutputDir(const fs::path& dir) {
  std::error_code error;
  fs::create_directories(dir, error);
  if (error) {
    return IoError("creating the output folder " + dir.string() + ": " + error.message() +
                   "; choose a folder that can be written with -o");
  }
  // Permissions, quotas and read-only mounts show only when something is written. It is tried now
  // rather than after an hour of reconstruction.
  // The service may look at a folder from two threads at once.
  static std::atomic<int> looks = 0;
  const fs::path probe = dir / fmt::format(".isotherm-write-test-{}-{}", ::getpid(), ++looks);
  if (Status status = WriteFile(probe, "x"); !status.ok()) {
    return status.WithContext("the output folder cannot be written");
  }
  fs::remove(probe, error);
  return OkStatus();
}

std::vector<fs::path> ResultFilesIn(const fs::path& dir) {
  std::vector<fs::path> files;
  ForEachResult(dir, [&](const fs::path& file) { files.push_back(file); });
  std::ranges::sort(files);
  return files;
}

bool HoldsResults(const fs::path& dir) { return !ResultFilesIn(dir).empty(); }

void RemoveOtherResults(const fs::path& dir, const std::set<std::string>& written) {
  for (const fs::path& file : ResultFilesIn(dir)) {
    std::error_code ignored;
    if (!written.contains(file.lexically_relative(dir).string())) fs::remove(file, ignored);
  }
}

Result<ResultSummary> WriteResults(const ResultInputs& inputs, const fs::path& dir,
                                   ThreadPool& threads, const ResultProgress& progress) {
  const auto announce = [&](std::string_view what, double fraction) {
    if (progress) progress(what, fraction);
  };
  const ExportOptions& options = inputs.export_options;
  // A full disk may refuse the cloud and still take the trajectory: all files are tried.
  FirstFailure failure;
  announce("trajectory.txt", 0.0);
  if (inputs.trajectory) failure.Add(WriteTrajectory(*inputs.trajectory, dir / "trajectory.txt"));
  announce("surface", 0.05);
  ResultSummary summary;
  {
    Surface surface =
        ExtractSurface(inputs.tsdf, inputs.thermal,
                       {.min_weight = static_cast<float>(options.expert().min_weight()),
                        .triangles = options.expert().mesh()},
                       threads);
    std::vector<PartReport> reports;
    // Before the summary, which must describe the temperatures that are written.
    if (inputs.interpretation != nullptr) reports = inputs.interpretation->Apply(surface);
    summary = SummarizeSurface(surface, inputs.renderer_options);
    summary.interpretation = std::move(reports);
    announce("stats.json", 0.4);
    failure.Add(WriteFile(dir / "stats.json", JsonText(CompleteStats(inputs, summary))));
    const ColourTable colours(inputs.renderer_options);
    const PlyStyle style{.colours = colours,
                         .scale = summary.scale,
                         .palette_name = PaletteName(inputs.renderer_options.palette()),
                         .software = kSoftware,
                         .interpreted = inputs.interpretation != nullptr};
    if (options.expert().cloud()) {
      announce("cloud.ply", 0.4);
      failure.Add(WriteCloudPly(surface, style, dir / "cloud.ply"));
    }
    if (options.expert().mesh()) {
      announce("mesh.ply", 0.65);
      failure.Add(WriteMeshPly(surface, style, dir / "mesh.ply"));
    }
  }  // Renderings need the memory that the surface took.
  if (options.expert().renders() && inputs.view != nullptr) {
    announce("renders", 0.9);
    WriteRenders(inputs, summary.scale, dir / "renders", threads, failure);
  }
  announce("done", 1.0);
  if (!failure.status().ok()) return Err(failure.status());
  return summary;
}

}  // namespace isotherm
