#include "ground/cli/command.h"

#include <cstdio>

namespace isotherm {
namespace {

void Say(std::string_view message) {
  std::fflush(stdout);
  std::fprintf(stderr, "isotherm: %.*s\n", static_cast<int>(message.size()), message.data());
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
