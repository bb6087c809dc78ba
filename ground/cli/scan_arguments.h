#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ground/cli/configuration_arguments.h"
#include "ground/offline/reconstruct.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace isotherm {

/// Holds what a command line says of a recording that is to be reconstructed.
struct ScanArguments {
  std::string recording, rig;
  std::string volume, volume_min, initial_pose, initial_pose_from;
  ConfigurationArguments configuration;
  std::optional<double> voxel;
  std::optional<int> threads;
};

/// Adds the options of all but `recording` and `rig`, whose `arguments` must live as long as the
/// command; returns them, --initial-pose-from first.
std::vector<CLI::Option*> AddScanOptions(CLI::App& command, ScanArguments& arguments);

/// Sets the options of `request`. Says all that is wrong with them and returns the exit status, or
/// 0 if they are fine.
int CollectScanOptions(const ScanArguments& arguments, ReconstructRequest& request);

/// Sets recording, calibration and first pose, reading what files it needs for them.
Status FindScan(const ScanArguments& arguments, ReconstructRequest& request);

}  // namespace isotherm
