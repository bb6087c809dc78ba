#include <fmt/chrono.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "common/base/printable.h"
#include "common/dataset/text_lines.h"
#include "common/recording/recording_parts.h"
#include "ground/cli/command.h"
#include "ground/cli/frame_rendering.h"
#include "ground/cli/recording_report.h"

namespace isotherm {
namespace {

constexpr const char* kInspectFooter =
    R"(Shows what is in a recording: streams with rates, missing frames and gaps, shutter events,
calibration, size, and whether the file is complete. A torn file is read up to its last good
part; --repair first makes it whole up to there, in place, for programs that need an index.
Stamps, units and temperatures that cannot be right are said, with exit status 65.

Examples:
  isotherm inspect scan.mcap
  isotherm inspect scan.mcap --repair
  isotherm inspect scan.mcap --render 120 -o frame.png
  isotherm inspect scan.mcap --render 0 --stream depth -o depth.png)";

struct InspectArguments {
  std::string recording, output, stream;
  bool json = false, repair = false;
  std::optional<std::uint64_t> render;
};

Sensor ChosenStream(const InspectArguments& arguments, const RecordingInfo& info) {
  if (arguments.stream == "depth") return Sensor::kDepth;
  if (arguments.stream == "thermal") return Sensor::kThermal;
  const auto thermal = info.messages_by_topic.find("/thermal");
  return thermal != info.messages_by_topic.end() && thermal->second > 0 ? Sensor::kThermal
                                                                        : Sensor::kDepth;
}

/// Says on standard error what it did, so that JSON stays alone.
Status Repair(const std::string& recording) {
  const auto cut = CompleteRecording(recording);
  if (!cut) return cut.error();
  const std::string done = *cut ? fmt::format("completed, {} bytes cut off at its end", **cut)
                                : std::string("is complete, nothing to repair");
  std::fputs(fmt::format("{}: {}\n", recording, done).c_str(), stderr);
  return OkStatus();
}

int Run(const InspectArguments& arguments) {
  if (arguments.repair) {
    if (const Status repaired = Repair(arguments.recording); !repaired.ok()) return Fail(repaired);
  }
  const auto reader = RecordingReader::Open(arguments.recording);
  if (!reader) return Fail(reader.error());
  if (arguments.render) {
    if (arguments.output.empty()) return Fail(InvalidArgument("--render needs -o FILE.png"));
    const Status status = RenderFrame(**reader, ChosenStream(arguments, (*reader)->info()),
                                      *arguments.render, arguments.output);
    return status.ok() ? 0 : Fail(status);
  }
  const RecordingReport report = MakeReport(**reader, arguments.recording);
  const std::string text =
      arguments.json ? JsonText(ToJson(report)) : PrintableLines(ToText(report));
  std::fwrite(text.data(), 1, text.size(), stdout);
  return Warn(report.doubts);
}

}  // namespace

void AddInspectCommand(CLI::App& app, CommandBody& body) {
  CLI::App* command = app.add_subcommand("inspect", "Shows what is in a recording");
  auto arguments = std::make_shared<InspectArguments>();
  command->add_option("recording", arguments->recording, "Recording (.mcap)")->required();
  command->add_flag("--json", arguments->json, "Machine-readable output");
  command->add_flag("--repair", arguments->repair,
                    "First complete a file that breaks off, in place");
  command->add_option("--render", arguments->render, "Draw frame N (from 0) as an image instead");
  command
      ->add_option("--stream", arguments->stream,
                   "Stream to draw: depth or thermal (default, if there is one)")
      ->check(CLI::IsMember({"depth", "thermal"}));
  command->add_option("-o,--output", arguments->output, "Image to write (.png)");
  command->footer(kInspectFooter);
  command->callback([arguments, &body] { body = [arguments] { return Run(*arguments); }; });
}

}  // namespace isotherm
