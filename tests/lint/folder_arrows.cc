#include "tests/lint/folder_arrows.h"

#include <algorithm>
#include <functional>

namespace isotherm::lint {
namespace {

/// The folders of `common` that every folder of edge and ground may include. Only what is at the
/// end of the link knows the middleware, only what needs scenes the simulation.
const Folders& SharedFolders() {
  static const Folders kShared = {"common/base",        "common/time",     "common/simd",
                                  "common/concurrency", "common/geometry", "common/frame",
                                  "common/radiometry",  "common/stamping", "common/doubts",
                                  "common/messages",    "common/png",      "common/codec",
                                  "common/rig",         "common/options",  "common/recording"};
  return kShared;
}

/// SDK header prefixes, each at home in one folder, in .cc files only.
const std::map<std::string, std::string>& SdkHomes() {
  static const std::map<std::string, std::string> kHomes = {
      {"dds/", "common/transport"},
      {"isotherm_frames.h", "common/transport"},  // Generated from idl/, as is the next.
      {"isotherm_control.h", "common/transport"},
      {"isotherm_pieces.h", "common/transport"},
      {"OpenNI", "edge/openni"},
      {"Driver/Oni", "edge/openni/testing"},
      {"PS1080.h", "edge/openni"},
      {"libusb", "edge/usb"},
      {"umockdev", "edge/usb/testing"},
      {"png.h", "common/png"},
      {"boost/", "ground/console"},
      {"openssl/", "common/security"},
      {"meshoptimizer.h", "ground/console"},
      {"qrencode.h", "ground/console"},
      {"isa-l", "common/pieces"},
      {"systemd/", "common/base"},
      {"ceres/", "ground/camera_calibration"},
  };
  return kHomes;
}

const FolderArrows& Arrows() {
  static const FolderArrows kListed = {
      {"common/base", {}},
      {"common/time", {"common/base"}},
      {"common/simd", {}},
      {"common/security", {"common/base"}},
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
      {"common/pieces", {"common/messages"}},
      {"common/png", {"common/base", "common/frame"}},
      {"common/codec", {"common/base", "common/simd", "common/frame", "common/png"}},
      {"common/recording",
       {"common/base", "common/time", "common/geometry", "common/frame", "common/messages",
        "common/codec", "common/rig"}},
      {"common/dataset",
       {"common/base", "common/time", "common/geometry", "common/frame", "common/doubts",
        "common/png", "common/codec", "common/rig", "common/options", "common/recording"}},
      {"common/simulation",
       {"common/base", "common/time", "common/concurrency", "common/geometry", "common/frame",
        "common/radiometry", "common/simd", "common/codec", "common/rig", "common/options",
        "common/recording"}},
      {"common/transport",
       {"common/base", "common/time", "common/geometry", "common/frame", "common/messages"}},
      // The edge: what a camera is; stamps, shutter, frames; where they go; what joins it.
      {"edge/options", {}},
      {"edge/frame_counters", {}},
      {"edge/timestamper", {"edge/options"}},
      {"edge/source", {"common/simulation", "edge/options"}},
      {"edge/camera_process", {"edge/source"}},
      {"edge/openni", {"edge/options", "edge/source"}},
      {"edge/usb", {}},
      {"edge/thermal_camera", {"edge/options", "edge/source", "edge/usb"}},
      {"edge/nuc", {"edge/options", "edge/source"}},
      {"edge/spool", {"edge/options", "edge/frame_counters"}},
      {"edge/publisher", {"common/pieces", "common/transport"}},
      {"edge/backfill",
       {"common/transport", "edge/frame_counters", "edge/spool", "edge/publisher"}},
      {"edge/recording_server", {"common/transport", "edge/spool"}},
      {"edge/pipeline",
       {"edge/options", "edge/frame_counters", "edge/timestamper", "edge/source", "edge/nuc",
        "edge/spool", "edge/publisher", "edge/backfill"}},
      {"edge/daemon",
       {"common/transport", "edge/options", "edge/frame_counters", "edge/source",
        "edge/timestamper", "edge/camera_process", "edge/openni", "edge/thermal_camera", "edge/nuc",
        "edge/spool", "edge/publisher", "edge/recording_server", "edge/pipeline"}},
      // The ground: frames in; poses; the model; what is made of it; what joins, assesses and runs
      // it.
      {"ground/options", {}},
      {"ground/json", {}},
      {"ground/limits", {}},
      {"ground/subscriber", {"common/pieces", "common/transport"}},
      {"ground/fetch", {"common/transport"}},
      {"ground/link_emulator", {}},
      {"ground/assembler", {}},
      {"ground/surface", {"ground/options"}},
      {"ground/tsdf", {"ground/options", "ground/surface"}},
      {"ground/icp", {"ground/options", "ground/surface"}},
      {"ground/relocaliser", {"ground/options", "ground/surface", "ground/tsdf", "ground/icp"}},
      {"ground/thermal", {"ground/options", "ground/limits", "ground/surface", "ground/tsdf"}},
      {"ground/atlas",
       {"ground/options", "ground/surface", "ground/tsdf", "ground/relocaliser", "ground/thermal"}},
      {"ground/tracker",
       {"ground/options", "ground/surface", "ground/tsdf", "ground/icp", "ground/relocaliser",
        "ground/atlas"}},
      {"ground/model",
       {"ground/options", "ground/surface", "ground/tsdf", "ground/thermal", "ground/atlas"}},
      {"ground/scan",
       {"ground/tsdf", "ground/icp", "ground/thermal", "ground/atlas", "ground/tracker",
        "ground/model"}},
      {"ground/renderer", {"ground/options", "ground/surface", "ground/tsdf", "ground/thermal"}},
      {"ground/mesh", {"ground/tsdf", "ground/thermal"}},
      {"ground/interpretation",
       {"ground/options", "ground/json", "ground/surface", "ground/renderer", "ground/mesh"}},
      {"ground/export",
       {"ground/options", "ground/json", "ground/surface", "ground/tsdf", "ground/thermal",
        "ground/renderer", "ground/mesh", "ground/interpretation"}},
      {"ground/feedback",
       {"ground/options", "ground/surface", "ground/tsdf", "ground/thermal", "ground/renderer",
        "ground/atlas", "ground/scan"}},
      {"ground/calibration",
       {"ground/options", "ground/surface", "ground/tsdf", "ground/thermal", "ground/scan"}},
      {"ground/pipeline",
       {"ground/options", "ground/surface", "ground/tsdf", "ground/icp", "ground/thermal",
        "ground/atlas", "ground/tracker", "ground/model", "ground/scan"}},
      {"ground/measuring",
       {"ground/options", "ground/tsdf", "ground/thermal", "ground/mesh", "ground/interpretation"}},
      {"ground/report",
       {"ground/options", "ground/json", "ground/thermal", "ground/mesh", "ground/measuring"}},
      {"ground/snapshot", {"ground/surface", "ground/tsdf", "ground/thermal", "ground/atlas"}},
      {"ground/console",
       {"common/security", "ground/options", "ground/json", "ground/surface", "ground/thermal",
        "ground/renderer", "ground/mesh", "ground/export", "ground/scan", "ground/measuring",
        "ground/snapshot"}},
      {"ground/camera_calibration", {"common/dataset", "common/simulation", "ground/json"}},
      {"ground/radiometric_calibration",
       {"common/dataset", "ground/thermal", "ground/camera_calibration"}},
      {"ground/results",
       {"common/dataset", "ground/options", "ground/json", "ground/surface", "ground/thermal",
        "ground/renderer", "ground/interpretation", "ground/export", "ground/model", "ground/scan",
        "ground/calibration"}},
      {"ground/evaluation",
       {"common/dataset", "ground/options", "ground/json", "ground/thermal", "ground/results"}},
      {"ground/experiment",
       {"common/simulation", "ground/options", "ground/surface", "ground/tsdf", "ground/thermal",
        "ground/renderer", "ground/json", "ground/mesh", "ground/scan", "ground/feedback",
        "ground/pipeline", "ground/evaluation", "ground/calibration", "ground/camera_calibration",
        "ground/radiometric_calibration", "ground/link_emulator"}},
      {"ground/option_validation",
       {"ground/options", "ground/surface", "ground/tsdf", "ground/icp", "ground/relocaliser",
        "ground/thermal", "ground/renderer", "ground/interpretation", "ground/export",
        "ground/feedback", "ground/calibration", "ground/console"}},
      {"ground/offline",
       {"ground/options", "ground/json", "ground/surface", "ground/tsdf", "ground/thermal",
        "ground/renderer", "ground/assembler", "ground/export", "ground/scan", "ground/calibration",
        "ground/pipeline", "ground/results"}},
      {"ground/conversion", {"common/simulation"}},
      {"ground/service",
       {"common/transport", "ground/options", "ground/json", "ground/subscriber",
        "ground/conversion", "ground/offline", "ground/assembler", "ground/export",
        "ground/thermal", "ground/feedback", "ground/calibration", "ground/pipeline",
        "ground/results", "ground/option_validation", "ground/console"}},
      {"ground/playback", {"ground/options", "ground/console", "ground/offline", "ground/service"}},
      {"ground/cli",
       {"common/transport",
        "common/simulation",
        "common/dataset",
        "common/security",
        "ground/report",
        "ground/measuring",
        "ground/console",
        "ground/playback",
        "ground/options",
        "ground/subscriber",
        "ground/fetch",
        "ground/surface",
        "ground/tsdf",
        "ground/thermal",
        "ground/model",
        "ground/json",
        "ground/limits",
        "ground/mesh",
        "ground/interpretation",
        "ground/renderer",
        "ground/export",
        "ground/evaluation",
        "ground/experiment",
        "ground/calibration",
        "ground/camera_calibration",
        "ground/results",
        "ground/option_validation",
        "ground/offline",
        "ground/conversion",
        "ground/radiometric_calibration"}},
  };
  return kListed;
}

}  // namespace

bool DependencyRule::Allows(std::string_view folder, std::string_view target) const {
  if (!folder.starts_with("common/") && shared.contains(target)) return true;
  const auto listed = arrows.find(folder);
  return listed != arrows.end() && listed->second.contains(target);
}

const DependencyRule& RepositoryRule() {
  static const DependencyRule kRule = {Arrows(), SharedFolders(), SdkHomes()};
  return kRule;
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
