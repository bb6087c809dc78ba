#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "common/testing/temporary_directory.h"
#include "tests/support/departure.h"
#include "tests/support/programs.h"

namespace isotherm::system_test {

inline constexpr const char* kIp = "/usr/sbin/ip";

/// A computer: a network namespace that is connected to the other one by one interface.
struct Host {
  std::string name;       ///< Name of the namespace.
  std::string interface;  ///< Its end of the cable.
  std::string address;
};

/// Two computers with a cable between them, which come late, go down, or carry nothing. Takes root,
/// for network namespaces. The addresses are those of the shipped profile for a radio.
class TwoHostsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const bool may = geteuid() == 0 && std::filesystem::exists(kIp) &&
                     Ip({"netns", "add", edge_.name}) && Ip({"netns", "add", ground_.name});
    if (!may) GTEST_SKIP() << "no network of its own: network namespaces take root and iproute2";
  }
  ~TwoHostsTest() override {
    for (const Host& host : {edge_, ground_}) Ip({"netns", "del", host.name});
  }

  static bool Ip(std::vector<std::string> arguments) {
    return RunToEnd({kIp, std::move(arguments), {}, {}}, kPatience).status == 0;
  }
  static bool In(const Host& host, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"-n", host.name});
    return Ip(std::move(arguments));
  }
  /// Puts the cable in, which is what makes the interfaces appear.
  void Connect() const {
    ASSERT_TRUE(Ip({"link", "add", edge_.interface, "netns", edge_.name, "type", "veth", "peer",
                    "name", ground_.interface, "netns", ground_.name}));
    for (const Host& host : {edge_, ground_}) {
      ASSERT_TRUE(In(host, {"addr", "add", host.address + "/24", "dev", host.interface}));
      ASSERT_TRUE(In(host, {"link", "set", host.interface, "up"}));
    }
  }
  static void Set(const Host& host, const char* state) {
    ASSERT_TRUE(In(host, {"link", "set", host.interface, state}));
  }
  /// The cable is there, but nothing that one sends reaches the other.
  void CarryNothing() const {
    for (const auto& [from, to] : {std::pair(edge_, ground_), std::pair(ground_, edge_)}) {
      ASSERT_TRUE(In(from, {"neigh", "replace", to.address, "lladdr", "02:00:00:00:00:01", "dev",
                            from.interface, "nud", "permanent"}));
    }
  }
  void CarryAgain() const {
    for (const auto& [from, to] : {std::pair(edge_, ground_), std::pair(ground_, edge_)})
      ASSERT_TRUE(In(from, {"neigh", "del", to.address, "dev", from.interface}));
  }

  static std::string Shipped(const std::string& profile) {
    std::ostringstream text;
    text << std::ifstream(ISOTHERM_SOURCE_DIR "/deploy/" + profile).rdbuf();
    return text.str();
  }
  /// A profile with `with` instead of `what`, or as it is if there is no `what`.
  static std::string Replaced(std::string profile, const std::string& what,
                              const std::string& with) {
    const std::size_t at = profile.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return at == std::string::npos ? profile : profile.replace(at, what.size(), with);
  }
  /// The shipped profile for a local network with the interface chosen.
  static std::string LanProfile(const Host& host) {
    return Replaced(Shipped("cyclonedds-lan.xml"), "autodetermine=\"true\"",
                    "name=\"" + host.interface + "\"");
  }
  Command On(const Host& host, const std::string& profile, const std::filesystem::path& program,
             const std::vector<std::string>& more) const {
    const std::filesystem::path file = folder_.path() / (host.name + ".xml");
    std::ofstream(file) << profile;
    std::vector<std::string> arguments = {"netns", "exec", host.name, program.string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return {kIp, std::move(arguments), {"CYCLONEDDS_URI=file://" + file.string()}, {}};
  }

  const std::string id_ = std::to_string(getpid());
  const Host edge_{"iso-edge-" + id_, "ie" + id_, "192.168.50.1"};
  const Host ground_{"iso-ground-" + id_, "ig" + id_, "192.168.50.2"};
  const ::isotherm::testing::TemporaryDirectory folder_;
  const std::filesystem::path scan_ = folder_.path() / "scan.mcap";
  const std::filesystem::path copy_ = folder_.path() / "copy.mcap";
};

}  // namespace isotherm::system_test
