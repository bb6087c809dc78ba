#include <CLI/CLI.hpp>

#include "ground/cli/command.h"

namespace isotherm {

void AddDemoCommand(CLI::App& app, CommandBody& body) {
  CLI::App* command =
      app.add_subcommand("demo", "Scans a simulated furnace door over DDS on this computer");
  command->callback([&body] { body = [] { return Fail(Unavailable("demo: not there yet")); }; });
}

}  // namespace isotherm
