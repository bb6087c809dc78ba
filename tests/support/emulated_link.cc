#include "tests/support/emulated_link.h"

#include <fstream>
#include <utility>

namespace isotherm::system_test {

Result<std::unique_ptr<EmulatedLink>> EmulatedLink::Create(std::uint64_t seed) {
  Result<std::unique_ptr<EmulatedNetwork>> network = EmulatedNetwork::Create(seed);
  if (!network) return Err(network.error());
  return std::unique_ptr<EmulatedLink>(new EmulatedLink(std::move(*network)));
}

EmulatedLink::EmulatedLink(std::unique_ptr<EmulatedNetwork> network)
    : network_(std::move(network)) {
  // Where a program that runs as somebody else can read it.
  std::ofstream(profile_)
      << std::ifstream(ISOTHERM_SOURCE_DIR "/deploy/cyclonedds-radio.xml").rdbuf();
}

Command EmulatedLink::On(NetworkEnd end, const std::filesystem::path& program,
                         const std::vector<std::string>& arguments) const {
  std::vector<std::string> words = network_->host(end).CommandPrefix();
  const std::filesystem::path first = words.front();
  words.erase(words.begin());
  words.push_back(program);
  words.insert(words.end(), arguments.begin(), arguments.end());
  return {first, words, {"CYCLONEDDS_URI=file://" + profile_.string()}, {}};
}

}  // namespace isotherm::system_test
