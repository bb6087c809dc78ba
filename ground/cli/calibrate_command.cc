#include <CLI/CLI.hpp>

#include "ground/cli/command.h"

namespace isotherm {

void AddCalibrateCommand(CLI::App& app, CommandBody& body) {
  CLI::App* calibrate = app.add_subcommand(
      "calibrate", "Finds calibration values from images of a target or from a recording");
  calibrate->require_subcommand(1);
  AddCalibrateCameraCommands(*calibrate, body);
  AddCalibrateRigCommand(*calibrate, body);
  AddCalibrateTimeCommand(*calibrate, body);
  AddCalibrateRefineCommand(*calibrate, body);
  AddCalibrateDepthBiasCommand(*calibrate, body);
  AddCalibrateRadiometricCommand(*calibrate, body);
  AddCalibrateCheckCommand(*calibrate, body);
}

}  // namespace isotherm
