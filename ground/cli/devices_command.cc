#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

#include "common/base/child_process.h"
#include "ground/cli/command.h"

namespace isotherm {
namespace {

constexpr const char* kDevicesFooter =
    R"(Shows each depth and thermal camera of this computer with its driver, serial number, address and modes. Names and
addresses are what edge.textproto takes: source.depth_camera and source.thermal_camera.

The drivers are in isotherm-edge; this is the same as `isotherm-edge --list-devices`. A camera that somebody else uses
may be shown as one that cannot be opened.)";

/// The edge program knows the drivers; it takes the place of this one.
int Run() {
  const auto edge = NeighbourProgram("isotherm-edge");
  if (!edge) return Fail(edge.error());
  std::fflush(stdout);
  std::string program = edge->string();
  std::string option = "--list-devices";
  char* const arguments[] = {program.data(), option.data(), nullptr};
  ::execv(program.c_str(), arguments);
  return Fail(Unavailable(fmt::format("{}: cannot be started: {}", program, std::strerror(errno))));
}

}  // namespace

void AddDevicesCommand(CLI::App& app, CommandBody& body) {
  CLI::App* command = app.add_subcommand("devices", "Lists the cameras of this computer");
  command->footer(kDevicesFooter);
  command->callback([&body] { body = [] { return Run(); }; });
}

}  // namespace isotherm
