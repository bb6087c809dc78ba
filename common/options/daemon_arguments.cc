#include "common/options/daemon_arguments.h"

#include <CLI/CLI.hpp>
#include <map>

#include "common/options/nearest_name.h"
#include "common/options/override.h"
#include "common/options/protobuf_log.h"
#include "common/options/text_proto.h"

namespace isotherm {

void DeclareConfiguration(CLI::App& app, DaemonArguments& arguments) {
  app.add_option("--config", arguments.config, "Configuration file (protobuf text format)")
      ->type_name("FILE");
  app.add_option("--set", arguments.overrides,
                 "Override an option of the configuration; repeatable")
      ->type_name("STAGE.FIELD=VALUE")
      ->allow_extra_args(false);
}

void DeclareLogLevel(CLI::App& app, DaemonArguments& arguments) {
  const std::map<std::string, int> levels = {{"debug", static_cast<int>(LogLevel::kDebug)},
                                             {"info", static_cast<int>(LogLevel::kInfo)},
                                             {"warning", static_cast<int>(LogLevel::kWarning)},
                                             {"error", static_cast<int>(LogLevel::kError)}};
  app.add_option("--log-level", arguments.log_level, "debug, info, warning or error")
      ->transform(CLI::Validator(NumberOfName(levels), ""))
      ->type_name("LEVEL");
}

std::optional<int> Parse(CLI::App& app, int argc, char** argv, const DaemonArguments& arguments) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kExitUsage;
  }
  SetLogLevel(arguments.log_level);
  LimitProtobufLog();
  return std::nullopt;
}

Status Apply(const DaemonArguments& arguments, google::protobuf::Message& options) {
  if (arguments.config) ISOTHERM_RETURN_IF_ERROR(LoadTextProto(*arguments.config, options));
  for (const std::string& assignment : arguments.overrides)
    ISOTHERM_RETURN_IF_ERROR(ApplyOverride(assignment, options));
  return OkStatus();
}

int ConfigurationExitCode(const Status& status) {
  return status.code() == StatusCode::kNotFound ? ExitCode(status) : kExitConfiguration;
}

}  // namespace isotherm
