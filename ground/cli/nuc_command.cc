#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>

#include "common/options/nearest_name.h"
#include "ground/cli/command.h"
#include "ground/cli/rig_order.h"

namespace isotherm {
namespace {

constexpr const char* kNucFooter =
    R"(A correction (NUC): the camera looks at its closed shutter and takes its own warmth out of the image. Meanwhile, and
half a second after, no temperatures are taken; geometry goes on.

Talks to a running isotherm-edge, beside isotherm-ground or without it. Without an order it shows the state. With one, the
answer is the camera's own: done, or refused with its reason. Exit status: 0 done, 69 refused or no rig there (the message
names the rigs that are), 64 several rigs and no --edge-id.

States: idle (all is well), desired (due, and put off), imminent (ordered), in progress (shutter closed), settling,
blocked (the camera does not follow), error (shutter stays closed, or frozen images), unknown (first one still to come).

Examples:
  isotherm nuc                       state, age, temperatures of the camera
  isotherm nuc --now                 a correction before measuring something important
  isotherm nuc --hold 20             none in the next 20 seconds, because it would disturb
  isotherm nuc --hold 0              that is over
  isotherm nuc --policy manual       only when asked for
  isotherm nuc --policy automatic    the edge decides: before a scan, by drift and by age
  isotherm nuc --policy camera       the camera decides, the edge follows
  isotherm nuc --edge-id drone-2     of several rigs in this domain

Try it without cameras: isotherm-edge --scene furnace-door --set source.loops=0)";

struct NucArguments {
  bool now = false;
  std::optional<double> hold_s;
  std::optional<int> policy;  ///< A NucPolicy.
  RigAddress rig;
};

std::string CelsiusText(double celsius) {
  return std::isfinite(celsius) ? fmt::format("{:.2f} C", celsius) : "unknown";
}

std::string StatusText(const std::string& edge_id, const NucReport& nuc) {
  std::string text = fmt::format("{:<14}{}\n", "rig", edge_id);
  text += fmt::format("{:<14}{}{}\n", "correction", ToString(nuc.state),
                      nuc.reason.empty() ? "" : fmt::format(": {}", nuc.reason));
  text += fmt::format("{:<14}{}\n", "known by", ToString(nuc.source));
  text +=
      fmt::format("{:<14}{}\n", "last one",
                  std::isfinite(nuc.seconds_since) ? fmt::format("{:.1f} s ago", nuc.seconds_since)
                                                   : "none seen yet");
  text += fmt::format(
      "{:<14}corrections {}, shutter closed for {}{}\n", "last minute", nuc.closings_per_minute,
      std::isfinite(nuc.closed_fraction) ? fmt::format("{:.1f} %", 100.0 * nuc.closed_fraction)
                                         : "an unknown fraction",
      nuc.storm ? " (storm)" : "");
  text += fmt::format("{:<14}{}\n", "policy", ToString(nuc.policy));
  text += fmt::format("{:<14}detector {}, housing {}{}\n", "camera", CelsiusText(nuc.fpa_celsius),
                      CelsiusText(nuc.housing_celsius), nuc.warming_up ? ", warming up" : "");
  return text;
}

std::optional<Command> OrderOf(const NucArguments& arguments) {
  Command command;
  if (arguments.now) command.kind = CommandKind::kTriggerNuc;
  if (arguments.hold_s) {
    command.kind = CommandKind::kHoldNuc;
    command.hold_s = *arguments.hold_s;
  }
  if (arguments.policy) {
    command.kind = CommandKind::kSetNucPolicy;
    command.nuc_policy = static_cast<NucPolicy>(*arguments.policy);
  }
  if (!arguments.now && !arguments.hold_s && !arguments.policy) return std::nullopt;
  return command;
}

Status Run(const NucArguments& arguments) {
  return WithRig(arguments.rig, [&](RigCommander& rig, const EdgeStatus& status) {
    if (const std::optional<Command> order = OrderOf(arguments)) {
      return SendOrder(rig, *order, arguments.rig);
    }
    std::fputs(StatusText(rig.edge_id(), status.nuc).c_str(), stdout);
    return OkStatus();
  });
}

}  // namespace

void AddNucCommand(CLI::App& app, CommandBody& body) {
  CLI::App* command = app.add_subcommand(
      "nuc", "Corrections of a running rig's thermal camera: state, now, hold, policy");
  auto arguments = std::make_shared<NucArguments>();
  const std::map<std::string, int> policies = {
      {"automatic", static_cast<int>(NucPolicy::kAutomatic)},
      {"manual", static_cast<int>(NucPolicy::kManual)},
      {"camera", static_cast<int>(NucPolicy::kCamera)}};
  auto* const orders = command->add_option_group("order", "What to do; nothing: show the state");
  orders->add_flag("--now", arguments->now, "Correct as soon as it is allowed");
  orders
      ->add_option("--hold", arguments->hold_s,
                   "No correction for this long (nuc.expert.max_hold_s at most); 0 ends a hold")
      ->check(CLI::Range(0.0, 86400.0))
      ->type_name("SECONDS");
  orders
      ->add_option("--policy", arguments->policy, "automatic, manual or camera")
      // The validator's empty description keeps CLI11 from listing numbers in the help.
      ->transform(CLI::Validator(NumberOfName(policies), ""))
      ->type_name("POLICY");
  orders->require_option(0, 1);
  AddRigAddress(*command, arguments->rig);
  command->footer(kNucFooter);
  command->callback([arguments, &body] {
    body = [arguments] {
      const Status done = Run(*arguments);
      return done.ok() ? 0 : Fail(done);
    };
  });
}

}  // namespace isotherm
