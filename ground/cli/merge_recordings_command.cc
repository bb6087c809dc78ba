#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "ground/cli/command.h"
#include "ground/cli/conversion.h"

namespace isotherm {
namespace {

constexpr const char* kMergeFooter =
    R"(Rig and ground both record a scan. After an outage of the link the ground's recording has a hole; the rig's has
everything but the ground's feedback. Merged, they are one recording that has each frame and message once, frames
from the first of them that has it whole. Parts of a long recording become one, too.

Recordings of different scans are refused.

A single recording that is torn or damaged is made whole: everything that can be read, with an index and an end.

Examples:
  isotherm merge-recordings out/scan/scan.mcap rig/scan.mcap -o whole.mcap
  isotherm merge-recordings scan.mcap scan-2.mcap scan-3.mcap -o all.mcap
  isotherm merge-recordings torn.mcap -o whole.mcap)";

struct MergeArguments {
  std::vector<std::string> recordings;
  std::string output;
  ImageStorage storage = ImageStorage::kCompact;
  bool force = false;
};

void Print(const ConvertSummary& summary, const std::string& output) {
  fmt::print("{}: {} depth and {} thermal frames\n", output, summary.depth_frames,
             summary.thermal_frames);
  for (const MergedPart& part : summary.parts) {
    fmt::print("from     {}: {} depth and {} thermal frames{}\n", part.path.string(),
               part.depth_frames, part.thermal_frames,
               part.damaged > 0 ? fmt::format("; {} damaged messages", part.damaged) : "");
  }
  if (summary.missing > 0)
    fmt::print("missing  {} frames, which none of these recordings has\n", summary.missing);
  if (summary.left_out > 0)
    fmt::print("note: {} damaged messages were left out\n", summary.left_out);
}

int Run(const MergeArguments& arguments) {
  ConvertRequest request;
  request.recording = arguments.recordings.front();
  request.others.assign(arguments.recordings.begin() + 1, arguments.recordings.end());
  request.storage = arguments.storage;
  const Result<ConvertSummary> summary = ConvertInto(
      {.output = arguments.output, .force = arguments.force, .verb = "merging"}, request);
  if (!summary) return Fail(summary.error());
  Print(*summary, arguments.output);
  return 0;
}

}  // namespace

void AddMergeRecordingsCommand(CLI::App& app, CommandBody& body) {
  CLI::App* command =
      app.add_subcommand("merge-recordings",
                         "Makes one whole recording of several of the same scan, or of a torn one");
  auto arguments = std::make_shared<MergeArguments>();
  command->add_option("recordings", arguments->recordings, "Recordings of one scan (.mcap)")
      ->required()
      ->expected(1, -1);
  command->add_option("-o,--output", arguments->output, "Recording to write (.mcap)")->required();
  AddEncodingOption(*command, arguments->storage,
                    "compact (default) or viewable (Foxglove and Lichtblick show it)");
  command->add_flag("--force", arguments->force, "Replace an existing recording");
  command->footer(kMergeFooter);
  command->callback([arguments, &body] { body = [arguments] { return Run(*arguments); }; });
}

}  // namespace isotherm
