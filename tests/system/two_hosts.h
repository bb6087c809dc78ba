#pragma once

#include <gtest/gtest.h>
#include <linux/filter.h>
#include <linux/pkt_cls.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "common/testing/temporary_directory.h"
#include "tests/support/departure.h"
#include "tests/support/programs.h"

namespace isotherm::system_test {

inline constexpr const char* kIp = "/usr/sbin/ip";
inline constexpr const char* kTc = "/usr/sbin/tc";

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
    // Every computer has one; without, the middleware cannot wake its own threads to end.
    for (const Host& host : {edge_, ground_}) ASSERT_TRUE(In(host, {"link", "set", "lo", "up"}));
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

  static bool Tc(const Host& host, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"-n", host.name});
    return std::filesystem::exists(kTc) &&
           RunToEnd({kTc, std::move(arguments), {}, {}}, kPatience).status == 0;
  }
  /// Returns an instruction as tc reads it: what to do, how many to pass over, and with what.
  static std::string Instruction(int code, int over, std::uint32_t with) {
    return std::to_string(code) + " 0 " + std::to_string(over) + " " + std::to_string(with) + ",";
  }
  /// Loses this fraction of the packets that arrive at `host`, of any kind and by chance, before
  /// anything there sees them; its sender is not told. Returns false if this kernel cannot.
  static bool Lose(const Host& host, double fraction) {
    constexpr auto kAll = std::numeric_limits<std::uint32_t>::max();
    const auto limit = static_cast<std::uint32_t>(std::lround(fraction * kAll));
    // A classic packet filter: dropped is what draws a random word below the limit.
    const std::string filter =
        "4," + Instruction(BPF_LD | BPF_W | BPF_ABS, 0, SKF_AD_OFF + SKF_AD_RANDOM) +
        Instruction(BPF_JMP | BPF_JGE | BPF_K, 1, limit) +  // If it is smaller, passes over one.
        Instruction(BPF_RET | BPF_K, 0, TC_ACT_OK) + Instruction(BPF_RET | BPF_K, 0, TC_ACT_SHOT);
    Tc(host, {"qdisc", "add", "dev", host.interface, "clsact"});  // Fails if it is there.
    return Tc(host, {"filter", "replace", "dev", host.interface, "ingress", "prio", "1", "handle",
                     "1", "bpf", "direct-action", "bytecode", filter});
  }
  /// Loses what arrives at `host` for several computers at once. Returns false if this kernel
  /// cannot.
  static bool LoseMulticast(const Host& host) {
    constexpr int kEthernetHeader = 14, kDestination = 16;
    constexpr std::uint32_t kFirstMulticast = 224;  // The first octet of such an address.
    const std::string filter =
        "4," + Instruction(BPF_LD | BPF_B | BPF_ABS, 0, kEthernetHeader + kDestination) +
        Instruction(BPF_JMP | BPF_JGE | BPF_K, 1, kFirstMulticast) +
        Instruction(BPF_RET | BPF_K, 0, TC_ACT_SHOT) + Instruction(BPF_RET | BPF_K, 0, TC_ACT_OK);
    Tc(host, {"qdisc", "add", "dev", host.interface, "clsact"});  // Fails if it is there.
    return Tc(host, {"filter", "replace", "dev", host.interface, "ingress", "protocol", "ip",
                     "prio", "1", "handle", "1", "bpf", "direct-action", "bytecode", filter});
  }
  /// Returns how many packets these have lost at `host`.
  static long Lost(const Host& host) {
    const Finished shown = RunToEnd(
        {kTc, {"-n", host.name, "-s", "qdisc", "show", "dev", host.interface}, {}, {}}, kPatience);
    const std::size_t ingress = shown.output.find("clsact");
    const std::string word = "(dropped ";
    const std::size_t at = shown.output.find(word, ingress);
    if (ingress == std::string::npos || at == std::string::npos) {
      ADD_FAILURE() << "no count of lost packets: " << shown.output;
      return 0;
    }
    return std::stol(shown.output.substr(at + word.size()));
  }
  /// Carries no more than `rate` ("1mbit") of what `host` sends. Returns false if this kernel
  /// cannot.
  static bool Narrow(const Host& host, const std::string& rate) {
    return Tc(host, {"qdisc", "replace", "dev", host.interface, "root", "tbf", "rate", rate,
                     "burst", "8kb", "latency", "100ms"});
  }
  static void Widen(const Host& host) {
    ASSERT_TRUE(Tc(host, {"qdisc", "del", "dev", host.interface, "root"}));
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
