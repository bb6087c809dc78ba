#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/base/log.h"
#include "common/base/status.h"

namespace CLI {
class App;
}
namespace google::protobuf {
class Message;
}

namespace isotherm {

/// Holds the arguments that the command lines of both daemons have in common.
struct DaemonArguments {
  std::optional<std::string> config;
  std::vector<std::string> overrides;
  LogLevel log_level = LogLevel::kInfo;
};

/// Adds --config and --set. `arguments` must outlive `app`.
void DeclareConfiguration(CLI::App& app, DaemonArguments& arguments);
/// Adds --log-level. `arguments` must outlive `app`.
void DeclareLogLevel(CLI::App& app, DaemonArguments& arguments);

/// Reads the command line, sets the log's level and keeps Protobuf from writing a log of its own.
/// Returns the exit status if the program is to end now: after --help, or because of a wrong
/// argument.
std::optional<int> Parse(CLI::App& app, int argc, char** argv, const DaemonArguments& arguments);

/// Reads the configuration into `options`, then what overrides it; returns the first problem.
Status Apply(const DaemonArguments& arguments, google::protobuf::Message& options);

/// Returns the exit status for a problem with options: a missing file keeps its own, anything else
/// is a configuration error.
int ConfigurationExitCode(const Status& status);

}  // namespace isotherm
