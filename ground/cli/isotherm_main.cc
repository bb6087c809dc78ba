// isotherm: the tool. Each subcommand is in a file of its own.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include "common/options/nearest_name.h"
#include "common/options/protobuf_log.h"
#include "common/options/renamed_options.h"
#include "ground/cli/command.h"

namespace isotherm {
namespace {

constexpr const char* kDescription =
    R"(Close-range 3D thermography: recordings of depth and thermal frames in, validated 3D thermograms
out.)";

constexpr const char* kFooter =
    R"(Start here:
  isotherm demo                                     a simulated scan over DDS on this computer
  isotherm import --from tum FOLDER -o scan.mcap    your own images and time stamps
  isotherm inspect scan.mcap                        what is in it
  isotherm convert scan.mcap -o view.mcap           the same for Foxglove and Lichtblick
  isotherm reconstruct scan.mcap -o out             the 3D thermogram: out/cloud.ply, out/mesh.ply, ...
  isotherm render out -o door.png                   images of it, from anywhere
  isotherm evaluate out --groundtruth poses.txt     how far it is from the truth
  isotherm limits --material paint --tolerance 2%   from where a surface can be measured
`isotherm COMMAND --help` explains each of them.

Exit status:
   0  done
   1  an experiment's requirement is not met, or `calibrate check` found that something has moved
   2  `calibrate check`: the scan cannot tell
  64  wrong command line or argument
  65  data is damaged, inconsistent, lacks something or cannot be right (nothing tracked, no
      temperature, wrong units, two clocks): what could be written is, and a warning says why
  66  a file or folder does not exist
  69  a program, device or the network is not available
  70  a defect of this program
  73  the output cannot be created, the disk is full, or a limit is reached
  74  reading or writing failed
  78  wrong configuration (all problems are listed))";

/// Returns " --x is called --y now." for each flag that has another name since.
std::string ExplainRenamed(int argc, char** argv) {
  std::string text;
  for (int i = 1; i < argc; ++i) {
    if (const std::string_view now = FlagSinceRenaming(argv[i]); !now.empty())
      text += fmt::format(" {} is called {} now.", argv[i], now);
  }
  return text;
}

/// A first word that is no command is most likely a misspelt one.
std::string ExplainExtras(const CLI::App& app, int argc, char** argv, const std::string& what) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  const std::string word = argc > 1 ? argv[1] : "";
  if (word.starts_with("-") || std::ranges::count(names, word) > 0)
    return what + " (isotherm --help explains the command line)";
  return fmt::format("there is no command '{}'.{} There are: {} (isotherm --help explains them)",
                     word, DidYouMean(word, names), JoinNames(names));
}

/// Adds all commands in the order in which --help shows them. The one that is named sets `body`.
void AddCommands(CLI::App& app, CommandBody& body) {
  AddDemoCommand(app, body);
  AddDevicesCommand(app, body);
  AddImportCommand(app, body);
  AddInspectCommand(app, body);
  AddConvertCommand(app, body);
  AddMergeRecordingsCommand(app, body);
  AddReconstructCommand(app, body);
  AddRenderCommand(app, body);
  AddEvaluateCommand(app, body);
  AddViewCommand(app, body);
  AddReportCommand(app, body);
  AddExportCommand(app, body);
  AddMeasureCommand(app, body);
  AddSimulateCommand(app, body);
  AddLimitsCommand(app, body);
  AddExperimentCommand(app, body);
  AddTimingCommand(app, body);
  AddCalibrateCommand(app, body);
  AddNucCommand(app, body);
  AddScanCommand(app, body);
  AddFetchCommand(app, body);
  AddOptionsCommand(app, body);
}

/// Runs a command and returns the exit status.
int Run(const CommandBody& body) {
  LimitProtobufLog();
  const int status = body();
  // A full disk behind a redirected output shows only here.
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
    return Fail(IoError("standard output cannot be written"));
  return status;
}

int Main(int argc, char** argv) {
  CLI::App app(kDescription, "isotherm");
  app.set_version_flag("--version", std::string(SoftwareName()));
  app.require_subcommand(0, 1);
  app.footer(kFooter);
  CommandBody body;
  AddCommands(app, body);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ExtrasError& error) {
    return Fail(
        InvalidArgument(ExplainExtras(app, argc, argv, error.what()) + ExplainRenamed(argc, argv)));
  } catch (const CLI::ParseError& error) {
    const bool asked = error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success);
    if (asked) return app.exit(error);  // --help, --version
    return Fail(InvalidArgument(std::string(error.what()) +
                                " (isotherm --help explains the command line)" +
                                ExplainRenamed(argc, argv)));
  }
  if (body) return Run(body);
  std::fputs(app.help().c_str(), stdout);
  return 0;
}

}  // namespace
}  // namespace isotherm

int main(int argc, char** argv) {
  try {
    return isotherm::Main(argc, argv);
  } catch (const std::exception& exception) {
    return isotherm::Fail(isotherm::Internal(std::string("unexpected: ") + exception.what()));
  }
}
