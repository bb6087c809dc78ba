#include "ground/cli/model_export.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "common/concurrency/thread_pool.h"
#include "ground/cli/simulation_files.h"
#include "ground/json/message_json.h"
#include "ground/model/load_model.h"
#include "ground/surface/surface_maps.h"
#include "ground/thermal/thermal_options.h"
#include "ground/tsdf/raycaster.h"

namespace isotherm {
namespace {

/// Returns what the model's depth camera saw last; nullopt if the model knows no pose.
std::optional<SurfaceMaps> CastLastView(const LoadedModel& model, const GroundOptions& options,
                                        ThreadPool& pool) {
  if (!model.rig.depth || model.known_poses.empty()) return std::nullopt;
  SurfaceMaps maps;
  Raycaster().Cast(*model.tsdf, model.rig.depth->WithoutDistortion(), model.known_poses.back(),
                   static_cast<float>(options.raycast().expert().min_weight()), pool, maps);
  return maps;
}

}  // namespace

Result<ResultSummary> ExportModel(const std::filesystem::path& model_path, GroundOptions options,
                                  const Interpretation& interpretation,
                                  const std::filesystem::path& dir,
                                  const ResultProgress& progress) {
  const Result<LoadedModel> model = LoadModel(model_path, options);
  if (!model) return Err(model.error());
  if (Status status = PrepareOutputDir(dir); !status.ok()) return Err(status);
  ThreadPool pool(ChosenThreads(options.threads()));
  const std::optional<SurfaceMaps> view = CastLastView(*model, options, pool);
  Json stats;
  stats["source"]["model"] = model_path.filename().string();
  stats["configuration"] = ToJson(options);
  ResultInputs inputs{.tsdf = *model->tsdf,
                      .thermal = *model->thermal,
                      .trajectory = std::nullopt,
                      .view = view ? &*view : nullptr,
                      .renderer_options = options.renderer(),
                      .thermal_options = WithAnglesOfMaterial(options.thermal()),
                      .export_options = options.export_(),
                      .interpretation = &interpretation,
                      .stats = stats};
  if (view) inputs.p_map_viewer = model->known_poses.back().translation();
  return WriteResults(inputs, dir, pool, progress);
}

}  // namespace isotherm
