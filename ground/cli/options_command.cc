#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "ground/cli/command.h"
#include "ground/cli/option_list.h"

namespace isotherm {
namespace {

constexpr const char* kOptionsFooter =
    R"(Names are those that --set takes. In a configuration file (--config, protobuf text format) dots are braces:
tsdf.expert.max_weight=100 is  tsdf { expert { max_weight: 100 } }.

Examples:
  isotherm options ground            of isotherm-ground, reconstruct, render, export and calibrate
  isotherm options ground --expert   with those that are rarely set
  isotherm options ground tsdf       one stage
  isotherm options edge | less       of isotherm-edge
  isotherm options simulate          of isotherm simulate)";

struct OptionsArguments {
  std::string program = "ground", stage;
  bool with_expert = false, as_page = false;
};

int Run(const OptionsArguments& arguments) {
  const Result<std::string> text =
      arguments.as_page ? OptionsPage()
                        : ListOptions(arguments.program, arguments.stage, arguments.with_expert);
  if (!text) return Fail(text.error());
  std::fwrite(text->data(), 1, text->size(), stdout);
  return 0;
}

}  // namespace

void AddOptionsCommand(CLI::App& app, CommandBody& body) {
  CLI::App* command =
      app.add_subcommand("options", "Lists the options of --set and --config, with their defaults");
  auto arguments = std::make_shared<OptionsArguments>();
  command->add_option("program", arguments->program, "ground, edge or simulate")
      ->capture_default_str();
  command->add_option("stage", arguments->stage, "One group of them, e.g. tsdf");
  command->add_flag("--expert", arguments->with_expert,
                    "Also what is rarely set, in the expert block of each stage");
  command->add_flag("--markdown", arguments->as_page,
                    "All options of all programs as a page (docs/options.md)");
  command->footer(kOptionsFooter);
  command->callback([arguments, &body] { body = [arguments] { return Run(*arguments); }; });
}

}  // namespace isotherm
