#include "ground/cli/command.h"

#include <cstdio>

#include "common/base/printable.h"

namespace isotherm {
namespace {

void Say(std::string_view message) {
  std::fflush(stdout);
  std::fprintf(stderr, "isotherm: %s\n", PrintableLines(message).c_str());
}

}  // namespace

int Fail(const Status& status) {
  Say(status.message());
  return ExitCode(status);
}

int Warn(const std::vector<std::string>& doubts) {
  for (const std::string& doubt : doubts) Say("warning: " + doubt);
  return doubts.empty() ? 0 : ExitCode(FailedPrecondition(""));
}

int FailConfiguration(std::string_view message) {
  Say(message);
  return kExitConfiguration;
}

std::string_view SoftwareName() { return "isotherm " ISOTHERM_VERSION; }

}  // namespace isotherm
