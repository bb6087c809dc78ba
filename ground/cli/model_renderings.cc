#include "ground/cli/model_renderings.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "common/geometry/map_pose.h"
#include "ground/export/png_file.h"
#include "ground/mesh/surface.h"
#include "ground/renderer/renderer.h"
#include "ground/surface/surface_maps.h"
#include "ground/thermal/thermal_options.h"
#include "ground/tsdf/raycaster.h"

namespace isotherm {
namespace {

namespace fs = std::filesystem;

bool IsPng(const fs::path& path) { return path.extension() == ".png"; }

}  // namespace

ModelSurface SurfaceOf(const LoadedModel& model, const GroundOptions& options,
                       const Interpretation* interpretation, ThreadPool& pool) {
  Surface surface =
      ExtractSurface(*model.tsdf, *model.thermal,
                     {.min_weight = static_cast<float>(options.export_().expert().min_weight()),
                      // Views and scales need points only.
                      .triangles = false},
                     pool);
  ModelSurface result;
  if (interpretation != nullptr) result.interpretation = interpretation->Apply(surface);
  result.points_m.reserve(surface.points.size());
  result.celsius.reserve(surface.points.size());
  for (const CloudPoint& point : surface.points) {
    result.points_m.push_back(point.position_m);
    result.celsius.push_back(point.celsius);
  }
  return result;
}

std::vector<fs::path> RenderingFiles(const RenderingRequest& request) {
  if (IsPng(request.output)) return {request.output};
  std::vector<fs::path> files;
  for (std::size_t view = 0; view < request.views.size(); ++view) {
    for (const RenderLayer layer : request.layers) {
      files.push_back(request.output / (request.views.size() == 1
                                            ? fmt::format("{}.png", LayerName(layer))
                                            : fmt::format("{}_{:03}.png", LayerName(layer), view)));
    }
  }
  return files;
}

Status PrepareRenderings(const RenderingRequest& request) {
  constexpr std::string_view kOtherFormats[] = {".jpg",  ".jpeg", ".gif", ".bmp", ".tif",
                                                ".tiff", ".webp", ".svg", ".pdf"};
  if (std::ranges::count(kOtherFormats, request.output.extension().string()) > 0) {
    return InvalidArgument(fmt::format(
        "-o {}: renderings are written as PNG; name {} or, for several, a folder",
        request.output.string(), fs::path(request.output).replace_extension(".png").string()));
  }
  const std::size_t count = request.views.size() * request.layers.size();
  if (IsPng(request.output) && count != 1) {
    return InvalidArgument(
        fmt::format("-o {}: {} renderings do not fit into one file; name a folder",
                    request.output.string(), count));
  }
  const fs::path folder = IsPng(request.output) ? request.output.parent_path() : request.output;
  if (folder.empty()) return OkStatus();
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder, error)) {
    return IoError(fmt::format("creating the folder {}: {}; choose another place with -o",
                               folder.string(), error ? error.message() : "a file is in the way"));
  }
  return OkStatus();
}

namespace {

bool ShowsRecords(const std::vector<RenderLayer>& layers) {
  return std::ranges::any_of(layers, [](RenderLayer layer) {
    return layer == RenderLayer::kAge || layer == RenderLayer::kUncertainty;
  });
}

}  // namespace

Result<int> WriteRenderings(const LoadedModel& model, const GroundOptions& options,
                            const std::optional<TemperatureScale>& scale,
                            const RenderingRequest& request, ThreadPool& pool,
                            const std::function<void(double fraction)>& progress) {
  const Renderer renderer(options.renderer(), WithAnglesOfMaterial(options.thermal()));
  const bool thermal = std::ranges::count(request.layers, RenderLayer::kThermal) > 0;
  const std::vector<fs::path> files = RenderingFiles(request);
  auto file = files.begin();
  Raycaster raycaster;
  SurfaceMaps maps;
  ViewMaps view;
  int empty = 0;
  for (const RigidTransform& T_world_camera : request.views) {
    raycaster.Cast(*model.tsdf, request.camera, InFirstMap(T_world_camera),
                   static_cast<float>(options.export_().expert().min_weight()), pool, maps);
    SampleView(maps, T_world_camera.translation(), *model.tsdf, *model.thermal, pool, view);
    empty += std::ranges::all_of(view.cos_view.pixels(), [](float c) { return std::isnan(c); });
    // The angle of each measurement is in its record.
    if (ShowsRecords(request.layers) || request.interpretation != nullptr)
      SampleRecords(maps, *model.tsdf, *model.thermal, pool, view);
    std::optional<ContourField> contours;
    if (thermal && renderer.draws_lines()) {
      contours = SampleContours(maps, *model.tsdf, *model.thermal,
                                options.renderer().expert().isotherm_smoothing_px(), pool);
    }
    if (request.interpretation != nullptr) {
      // Contours first: they need the view's angles and parts as they were measured.
      if (contours) request.interpretation->Apply(maps, view, contours->celsius);
      request.interpretation->Apply(maps, view);
      view.celsius_meaning = "object temperature";
    }
    for (const RenderLayer layer : request.layers) {
      const RgbImage rendering = renderer.Draw(layer, view, scale, contours ? &*contours : nullptr);
      if (Status status = WritePng(rendering, *file); !status.ok()) return Err(status);
      ++file;
      progress(static_cast<double>(file - files.begin()) / static_cast<double>(files.size()));
    }
  }
  return empty;
}

}  // namespace isotherm
