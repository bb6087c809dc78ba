#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "common/base/status.h"
#include "common/testing/temporary_directory.h"
#include "ground/link_emulator/emulated_network.h"
#include "tests/support/process.h"

namespace isotherm::system_test {

/// Two computers that are none, joined by a poor radio link; programs run on them with the shipped
/// profile for a radio.
class EmulatedLink {
 public:
  static Result<std::unique_ptr<EmulatedLink>> Create(std::uint64_t seed);

  EmulatedNetwork& network() { return *network_; }
  /// Returns the command that runs a program on one of them.
  Command On(NetworkEnd end, const std::filesystem::path& program,
             const std::vector<std::string>& arguments) const;

 private:
  explicit EmulatedLink(std::unique_ptr<EmulatedNetwork> network);

  const testing::TemporaryDirectory folder_;
  const std::filesystem::path profile_ = folder_.path() / "radio.xml";
  std::unique_ptr<EmulatedNetwork> network_;
};

}  // namespace isotherm::system_test
