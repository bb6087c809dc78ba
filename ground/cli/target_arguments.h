#pragma once

#include <string>
#include <vector>

#include "common/base/status.h"
#include "ground/camera_calibration/calibration_images.h"
#include "ground/camera_calibration/calibration_report.h"
#include "ground/cli/rig_order.h"

namespace CLI {
class App;
}

namespace isotherm {

/// Holds what all calibrations with a target are told.
struct TargetArguments {
  std::string recording, images;
  std::string target = "thesis-board";
  std::string lens = "brown-conrady";
  std::string rig;     ///< File to write or update.
  std::string report;  ///< Folder for report.txt, report.json and report.html.
  int bootstrap = 2000;
  int threads = 0;
  bool live = false;  ///< From a running rig, which `address` names.
  RigAddress address;
};

void AddTargetArguments(CLI::App& command, TargetArguments& arguments);

/// Reads cameras' images: from the folder, the recording, or a running rig. By stream.
Result<std::vector<ImageSeries>> ReadSeries(const TargetArguments& arguments,
                                            const std::vector<CalibratedStream>& streams);

/// Calibrates, prints the report, and writes what was asked for. `serials` by camera, empty if not
/// known.
Status CalibrateAndReport(const TargetArguments& arguments,
                          const std::vector<std::string>& camera_names,
                          std::vector<CalibrationView> views,
                          const std::vector<std::string>& serials);

}  // namespace isotherm
