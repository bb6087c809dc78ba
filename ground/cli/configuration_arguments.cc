#include "ground/cli/configuration_arguments.h"

#include <CLI/CLI.hpp>

#include "common/options/override.h"
#include "common/options/text_proto.h"
#include "ground/option_validation/validate_options.h"
#include "ground/options/ground_options.pb.h"

namespace isotherm {

void Problems::Add(const Status& status) {
  if (!status.ok()) text_ += (text_.empty() ? "" : "\n") + status.message();
}

void AddConfigurationArguments(CLI::App& command, ConfigurationArguments& arguments) {
  command.add_option("--config", arguments.file,
                     "Configuration file (text format of isotherm.GroundOptions)");
  command.add_option("--set", arguments.overrides, "Override an option: stage.field=value")
      ->take_all()
      ->type_name("STAGE.FIELD=VALUE");
}

void Apply(const ConfigurationArguments& arguments, GroundOptions& options, Problems& problems) {
  if (!arguments.file.empty()) problems.Add(LoadTextProto(arguments.file, options));
  for (const std::string& assignment : arguments.overrides)
    problems.Add(ApplyOverride(assignment, options).WithContext("--set"));
}

void AddInvalid(const GroundOptions& options, Problems& problems) {
  if (!problems.empty()) return;
  for (const Status& status : ValidateAll(options)) problems.Add(status);
}

}  // namespace isotherm
