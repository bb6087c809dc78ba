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

int FailConfiguration(std::string_view message) {
  Say(message);
  return kExitConfiguration;
}

std::string_view SoftwareName() { return "isotherm " ISOTHERM_VERSION; }

}  // namespace isotherm
