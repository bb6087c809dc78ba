#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string_view>

#include "common/base/printable.h"
#include "common/dataset/text_lines.h"
#include "ground/cli/command.h"
#include "ground/cli/rig_order.h"

namespace isotherm {
namespace {

constexpr const char* kScanFooter =
    R"(A scan begins when isotherm-edge starts (with --wait-for-order: by this order) and ends when it leaves, when its recording has been played, or by this order.
When it ends, the rig closes its recording and isotherm-ground writes the results. The next scan is a scan of its own, with
a recording and results of its own.

Talks to a running isotherm-edge, beside isotherm-ground or without it. Without an order it shows the state. Exit status:
0 done, 69 refused or no rig there (the message names the rigs that are), 64 several rigs and no --edge-id.

Examples:
  isotherm scan                      state, frames so far
  isotherm scan --stop               end it, and write everything
  isotherm scan --start              the next one
  isotherm scan --mark "left burner" remember this moment, in both recordings and the results
  isotherm scan --stop --edge-id drone-2

Try it without cameras: isotherm-edge --scene furnace-door)";

struct ScanOrderArguments {
  bool start = false;
  bool stop = false;
  std::string mark;
  RigAddress rig;
};

std::string_view StateText(ScanState state) {
  switch (state) {
    case ScanState::kScanning:
      return "under way";
    case ScanState::kEnded:
      return "ended";
    case ScanState::kIdle:
      break;
  }
  return "none yet";
}

std::string StatusText(const std::string& edge_id, const EdgeStatus& status) {
  std::string text = fmt::format("{:<14}{}\n", "rig", edge_id);
  text += fmt::format("{:<14}{}\n", "scan", StateText(status.scan_state));
  text += fmt::format("{:<14}{}\n", "session", status.session);
  const auto frames = [&text](std::string_view name, const StreamStatus& stream) {
    text += fmt::format("{:<14}captured {}, published {}, {:.1f} frames/s\n", name, stream.captured,
                        stream.published, stream.rate_hz);
  };
  frames("depth", status.depth);
  frames("thermal", status.thermal);
  for (const ScanMark& mark : status.marks)
    text += fmt::format("{:<14}{}  {}\n", "mark", FormatStamp(mark.time), Printable(mark.text));
  return text;
}

/// Says what is wrong with the words of a mark; empty: nothing.
std::string IsMark(const std::string& text) {
  if (text.empty()) return "is empty; a mark needs words to be found by";
  if (text != Printable(text)) return "has characters that cannot be shown, or is no UTF-8";
  if (text.size() <= kMaxMarkBytes) return {};
  return fmt::format("has {} bytes; a mark has {} at most", text.size(), kMaxMarkBytes);
}

Status Run(const ScanOrderArguments& arguments) {
  return WithRig(arguments.rig, [&](RigCommander& rig, const EdgeStatus& status) {
    if (!arguments.start && !arguments.stop && arguments.mark.empty()) {
      std::fputs(StatusText(rig.edge_id(), status).c_str(), stdout);
      return OkStatus();
    }
    Command order;
    order.kind = !arguments.mark.empty() ? CommandKind::kMark
                 : arguments.start       ? CommandKind::kStartScan
                                         : CommandKind::kStopScan;
    order.text = arguments.mark;
    return SendOrder(rig, order, arguments.rig);
  });
}

}  // namespace

void AddScanCommand(CLI::App& app, CommandBody& body) {
  CLI::App* command = app.add_subcommand("scan", "Starts and stops the scan of a running rig");
  auto arguments = std::make_shared<ScanOrderArguments>();
  auto* const orders = command->add_option_group("order", "What to do; nothing: show the state");
  orders->add_flag("--start", arguments->start, "Begin the next scan");
  orders->add_flag("--stop", arguments->stop, "End the scan; recording and results are written");
  orders
      ->add_option("--mark", arguments->mark,
                   "Remember this moment of the scan under these words, of 128 bytes at most")
      ->type_name("TEXT")
      ->check(IsMark);
  orders->require_option(0, 1);
  AddRigAddress(*command, arguments->rig);
  command->footer(kScanFooter);
  command->callback([arguments, &body] {
    body = [arguments] {
      const Status done = Run(*arguments);
      return done.ok() ? 0 : Fail(done);
    };
  });
}

}  // namespace isotherm
