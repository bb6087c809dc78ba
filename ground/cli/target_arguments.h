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
  std::string lens = "brown-conrady";        ///< In a rig the thermal camera's.
  std::string depth_lens = "brown-conrady";  ///< The depth camera's in a rig.
  std::string rig;                           ///< File to write or update.
  std::string report;  ///< Folder for report.txt, report.json and report.html.
  int bootstrap = 2000;
  int threads = 0;
  double depth_scale = 1000.0;  ///< Units per metre of depth images in a folder.
  bool live = false;            ///< From a running rig, which `address` names.
  bool infrared = false;        ///< The depth camera's images are infrared images.
  std::vector<double> infrared_shift_px = {5.0, 4.0};  ///< In images 640 pixels wide.
  RigAddress address;
};

void AddTargetArguments(CLI::App& command, TargetArguments& arguments);
/// Adds what commands that calibrate a depth camera have, too.
void AddDepthArguments(CLI::App& command, TargetArguments& arguments);

/// Adds what tells the depth camera's lens from the thermal camera's.
void AddDepthLens(CLI::App& command, TargetArguments& arguments);

/// Returns what a depth camera is calibrated on.
CalibratedStream DepthStream(const TargetArguments& arguments);

/// Reads cameras' images: from the folder, the recording, or a running rig; of depth, images of the
/// target's holes. By stream.
Result<std::vector<ImageSeries>> ReadSeries(const TargetArguments& arguments,
                                            const std::vector<CalibratedStream>& streams);

/// Calibrates, prints the report, and writes what was asked for. `serials` by camera, empty if not
/// known.
Status CalibrateAndReport(const TargetArguments& arguments,
                          const std::vector<std::string>& camera_names,
                          std::vector<CalibrationView> views,
                          const std::vector<std::string>& serials);

}  // namespace isotherm
