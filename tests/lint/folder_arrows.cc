#include "tests/lint/folder_arrows.h"

#include <algorithm>
#include <functional>

namespace isotherm::lint {
namespace {

using Folders = std::set<std::string>;

Folders With(Folders folders, const Folders& more) {
  folders.insert(more.begin(), more.end());
  return folders;
}

}  // namespace

const FolderArrows& AllowedArrows() {
  static const auto with = With;
  // Only what is at the end of the link knows the middleware, only what needs scenes the
  // simulation.
  static const Folders kCommon = {"common/base",        "common/time",     "common/simd",
                                  "common/concurrency", "common/geometry", "common/radiometry",
                                  "common/stamping",    "common/frame",    "common/doubts",
                                  "common/messages",    "common/png",      "common/codec",
                                  "common/rig",         "common/options",  "common/recording"};
  static const FolderArrows kAllowed = {
      {"common/base", {}},
      {"common/time", {"common/base"}},
      {"common/simd", {}},
      {"common/concurrency", {"common/base"}},
      {"common/geometry", {"common/base", "common/time"}},
      {"common/radiometry", {"common/base"}},
      {"common/stamping", {"common/base", "common/time"}},
      {"common/frame", {"common/base", "common/time"}},
      {"common/options", {"common/base", "common/time"}},
      {"common/rig", {"common/base", "common/geometry", "common/frame", "common/options"}},
      {"common/doubts", {"common/base", "common/time", "common/frame", "common/rig"}},
      {"common/messages",
       {"common/base", "common/time", "common/geometry", "common/frame", "common/rig"}},
      {"common/png", {"common/base", "common/frame"}},
      {"common/codec", {"common/base", "common/frame", "common/png"}},
      {"common/recording",
       {"common/base", "common/time", "common/geometry", "common/frame", "common/messages",
        "common/codec", "common/rig"}},
      {"common/dataset",
       {"common/base", "common/time", "common/geometry", "common/frame", "common/doubts",
        "common/png", "common/codec", "common/rig", "common/options", "common/recording"}},
      {"common/simulation",
       {"common/base", "common/time", "common/concurrency", "common/geometry", "common/frame",
        "common/radiometry", "common/codec", "common/rig", "common/options", "common/recording"}},
      {"common/transport",
       {"common/base", "common/time", "common/geometry", "common/frame", "common/messages"}},
      // The edge: what a camera is; stamps, shutter, frames; where they go; what joins it.
      {"edge/options", with(kCommon, {})},
      {"edge/frame_counters", with(kCommon, {})},
      {"edge/timestamper", with(kCommon, {"edge/options"})},
      {"edge/source", with(kCommon, {"common/simulation", "edge/options"})},
      {"edge/camera_process", with(kCommon, {"edge/source"})},
      {"edge/openni", with(kCommon, {"edge/options", "edge/source"})},
      {"edge/usb", with(kCommon, {})},
      {"edge/thermal_camera", with(kCommon, {"edge/options", "edge/source", "edge/usb"})},
      {"edge/nuc", with(kCommon, {"edge/options", "edge/source"})},
      {"edge/spool", with(kCommon, {"edge/options", "edge/frame_counters"})},
      {"edge/publisher", with(kCommon, {"common/transport"})},
      {"edge/pipeline", with(kCommon, {"edge/options", "edge/frame_counters", "edge/timestamper",
                                       "edge/source", "edge/nuc", "edge/spool", "edge/publisher"})},
      {"edge/daemon",
       with(kCommon, {"common/transport", "edge/options", "edge/frame_counters", "edge/source",
                      "edge/camera_process", "edge/openni", "edge/thermal_camera", "edge/spool",
                      "edge/publisher", "edge/pipeline"})},
      // The ground: frames in; poses; the model; what is made of it; what joins, assesses and runs
      // it.
      {"ground/options", with(kCommon, {})},
      {"ground/subscriber", with(kCommon, {"common/transport"})},
      {"ground/assembler", with(kCommon, {})},
      {"ground/surface", with(kCommon, {"ground/options"})},
      {"ground/tsdf", with(kCommon, {"ground/options", "ground/surface"})},
      {"ground/icp", with(kCommon, {"ground/options", "ground/surface"})},
      {"ground/relocaliser",
       with(kCommon, {"ground/options", "ground/surface", "ground/tsdf", "ground/icp"})},
      {"ground/thermal", with(kCommon, {"ground/options", "ground/surface", "ground/tsdf"})},
      {"ground/atlas", with(kCommon, {"ground/options", "ground/surface", "ground/tsdf",
                                      "ground/relocaliser", "ground/thermal"})},
      {"ground/stage_times", with(kCommon, {})},
      {"ground/tracker",
       with(kCommon, {"ground/options", "ground/surface", "ground/tsdf", "ground/icp",
                      "ground/relocaliser", "ground/atlas", "ground/stage_times"})},
      {"ground/model",
       with(kCommon, {"ground/options", "ground/surface", "ground/tsdf", "ground/thermal"})},
      {"ground/renderer",
       with(kCommon, {"ground/options", "ground/surface", "ground/tsdf", "ground/thermal"})},
      {"ground/export", with(kCommon, {"ground/options", "ground/surface", "ground/tsdf",
                                       "ground/thermal", "ground/renderer"})},
      {"ground/feedback", with(kCommon, {"ground/options", "ground/surface", "ground/tsdf",
                                         "ground/thermal", "ground/renderer"})},
      {"ground/pipeline", with(kCommon, {"ground/options", "ground/surface", "ground/tsdf",
                                         "ground/icp", "ground/thermal", "ground/atlas",
                                         "ground/stage_times", "ground/tracker", "ground/model"})},
      {"ground/guidance", with(kCommon, {"ground/options", "ground/renderer", "ground/thermal",
                                         "ground/feedback", "ground/pipeline"})},
      {"ground/evaluation", with(kCommon, {"common/dataset", "ground/thermal"})},
      {"ground/experiment",
       with(kCommon, {"common/simulation", "ground/evaluation", "ground/options", "ground/surface",
                      "ground/tsdf", "ground/thermal", "ground/renderer", "ground/export",
                      "ground/pipeline", "ground/guidance"})},
      {"ground/calibration", with(kCommon, {"ground/options", "ground/tsdf", "ground/pipeline"})},
      {"ground/results",
       with(kCommon, {"ground/options", "ground/surface", "ground/thermal", "ground/renderer",
                      "ground/export", "ground/pipeline", "ground/calibration"})},
      {"ground/option_validation",
       with(kCommon, {"ground/options", "ground/surface", "ground/tsdf", "ground/icp",
                      "ground/relocaliser", "ground/thermal", "ground/renderer", "ground/export",
                      "ground/feedback", "ground/calibration"})},
      {"ground/offline",
       with(kCommon, {"ground/options", "ground/surface", "ground/tsdf", "ground/thermal",
                      "ground/renderer", "ground/assembler", "ground/export", "ground/pipeline",
                      "ground/calibration", "ground/results"})},
      {"ground/service",
       with(kCommon, {"common/transport", "ground/options", "ground/subscriber", "ground/assembler",
                      "ground/export", "ground/thermal", "ground/pipeline", "ground/guidance",
                      "ground/calibration", "ground/results", "ground/option_validation"})},
      {"ground/cli",
       with(kCommon,
            {"common/transport", "common/simulation", "common/dataset", "ground/options",
             "ground/subscriber", "ground/surface", "ground/tsdf", "ground/thermal", "ground/model",
             "ground/renderer", "ground/export", "ground/evaluation", "ground/experiment",
             "ground/calibration", "ground/option_validation", "ground/offline"})},
  };
  return kAllowed;
}

std::vector<std::string> FindCircle(const FolderArrows& arrows) {
  std::vector<std::string> path;
  std::set<std::string> done;
  const std::function<bool(const std::string&)> closes = [&](const std::string& folder) {
    const bool again = std::find(path.begin(), path.end(), folder) != path.end();
    path.push_back(folder);
    if (again) {
      path.erase(path.begin(), std::find(path.begin(), path.end(), folder));
      return true;
    }
    const auto found = arrows.find(folder);
    if (!done.contains(folder) && found != arrows.end()) {
      for (const std::string& next : found->second) {
        if (next != folder && closes(next)) return true;
      }
    }
    done.insert(folder);
    path.pop_back();
    return false;
  };
  for (const auto& [folder, targets] : arrows) {
    if (closes(folder)) return path;
  }
  return {};
}

}  // namespace isotherm::lint
