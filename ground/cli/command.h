#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/status.h"

namespace CLI {
class App;
}

namespace isotherm {

/// Does what the chosen subcommand is for, after its options were read; returns the process's exit
/// status.
using CommandBody = std::function<int()>;

/// Says the failure in one sentence on standard error and returns its exit status.
int Fail(const Status& status);

/// Says each doubt as a warning on standard error. The exit status for data that cannot be right,
/// or 0 without any.
int Warn(const std::vector<std::string>& doubts);

/// Says what is wrong with the configuration and returns the exit status for that.
int FailConfiguration(std::string_view message);

/// Name and version of this program, for files that it writes.
std::string_view SoftwareName();

// One function per subcommand, in a file of the same name: adds it to the parser; when it is
// chosen, `body` is set.
void AddImportCommand(CLI::App& app, CommandBody& body);
void AddInspectCommand(CLI::App& app, CommandBody& body);
void AddConvertCommand(CLI::App& app, CommandBody& body);
void AddMergeRecordingsCommand(CLI::App& app, CommandBody& body);
void AddOptionsCommand(CLI::App& app, CommandBody& body);
void AddReconstructCommand(CLI::App& app, CommandBody& body);
void AddRenderCommand(CLI::App& app, CommandBody& body);
void AddEvaluateCommand(CLI::App& app, CommandBody& body);
void AddExportCommand(CLI::App& app, CommandBody& body);
void AddSimulateCommand(CLI::App& app, CommandBody& body);
void AddLimitsCommand(CLI::App& app, CommandBody& body);
void AddCalibrateCommand(CLI::App& app, CommandBody& body);
void AddTimingCommand(CLI::App& app, CommandBody& body);
void AddDevicesCommand(CLI::App& app, CommandBody& body);
void AddDemoCommand(CLI::App& app, CommandBody& body);
void AddExperimentCommand(CLI::App& app, CommandBody& body);
void AddMeasureCommand(CLI::App& app, CommandBody& body);
void AddViewCommand(CLI::App& app, CommandBody& body);
void AddReportCommand(CLI::App& app, CommandBody& body);
void AddNucCommand(CLI::App& app, CommandBody& body);
void AddScanCommand(CLI::App& app, CommandBody& body);
void AddFetchCommand(CLI::App& app, CommandBody& body);

// Those of `isotherm calibrate`.
void AddCalibrateTimeCommand(CLI::App& calibrate, CommandBody& body);
void AddCalibrateRefineCommand(CLI::App& calibrate, CommandBody& body);
void AddCalibrateCheckCommand(CLI::App& calibrate, CommandBody& body);
void AddCalibrateCameraCommands(CLI::App& calibrate, CommandBody& body);
void AddCalibrateDepthBiasCommand(CLI::App& calibrate, CommandBody& body);
void AddCalibrateRadiometricCommand(CLI::App& calibrate, CommandBody& body);
void AddCalibrateRigCommand(CLI::App& calibrate, CommandBody& body);

}  // namespace isotherm
