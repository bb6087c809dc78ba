#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/process.h"

namespace isotherm::system_test {
namespace {

using ::testing::HasSubstr;

constexpr Seconds kPatience{60};

std::string ReadAll(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

std::filesystem::path FindProgram(const std::string& name) {
  for (const char* folder : {"/usr/bin", "/bin", "/usr/sbin", "/usr/local/bin"}) {
    if (std::filesystem::exists(std::filesystem::path(folder) / name)) {
      return std::filesystem::path(folder) / name;
    }
  }
  return {};
}

/// `cmake --install` into a folder of our own.
class InstallTest : public ::testing::Test {
 protected:
  void SetUp() override {
    prefix_ = std::filesystem::path(::testing::TempDir()) / "isotherm_install";
    std::filesystem::remove_all(prefix_);
  }
  void TearDown() override { std::filesystem::remove_all(prefix_); }

  Finished Install() {
    return RunToEnd({ISOTHERM_CMAKE, {"--install", ISOTHERM_BINARY_DIR, "--prefix", prefix_}, {}},
                    kPatience);
  }
  std::filesystem::path Unit(const std::string& name) const {
    return prefix_ / "lib/systemd/system" / name;
  }

  std::filesystem::path prefix_;
};

TEST_F(InstallTest, ProgramsConfigurationsAndUnitsAreInPlace) {
  const Finished install = Install();
  ASSERT_EQ(install.status, 0) << install.output;
  for (const char* path :
       {"bin/isotherm", "bin/isotherm-edge", "bin/isotherm-ground", "etc/isotherm/edge.textproto",
        "etc/isotherm/ground.textproto", "etc/isotherm/cyclonedds-loopback.xml",
        "etc/isotherm/cyclonedds-lan.xml", "etc/isotherm/cyclonedds-radio.xml",
        "etc/isotherm/network.env", "etc/isotherm/chrony-rig.conf",
        "etc/isotherm/chrony-ground.conf", "lib/systemd/system/isotherm-edge.service",
        "lib/systemd/system/isotherm-ground.service", "lib/systemd/system/isotherm-ground@.service",
        "lib/udev/rules.d/60-isotherm-thermal.rules", "lib/sysusers.d/isotherm.conf",
        "lib/sysctl.d/60-isotherm.conf", "share/doc/isotherm/README.md"}) {
    EXPECT_TRUE(std::filesystem::exists(prefix_ / path)) << path;
  }
}

TEST_F(InstallTest, UnitsNameTheInstalledFiles) {
  ASSERT_EQ(Install().status, 0);
  for (const std::string name : {"edge", "ground"}) {
    const std::string unit = ReadAll(Unit("isotherm-" + name + ".service"));
    EXPECT_THAT(unit, HasSubstr("Type=notify\n"));
    EXPECT_THAT(unit, HasSubstr("Restart=always\n"));
    EXPECT_THAT(unit, HasSubstr("StartLimitIntervalSec=0\n"));
    EXPECT_THAT(unit, HasSubstr("EnvironmentFile=-" +
                                (prefix_ / "etc/isotherm/network.env").string() + '\n'));
    EXPECT_THAT(
        unit, HasSubstr("ExecStart=" + (prefix_ / "bin/isotherm-").string() + name + " --config " +
                        (prefix_ / "etc/isotherm/").string() + name + ".textproto\n"));
    EXPECT_EQ(unit.find('@' + std::string("INSTALL")), std::string::npos) << unit;
  }
}

TEST(ShippedChronyTest, F18ChronyAcceptsTheConfigurations) {
  const std::filesystem::path chronyd = FindProgram("chronyd");
  if (chronyd.empty()) GTEST_SKIP() << "chrony is not installed";
  for (const char* name : {"chrony-rig.conf", "chrony-ground.conf"}) {
    const std::string file = ISOTHERM_SOURCE_DIR "/deploy/chrony/" + std::string(name);
    const Finished printed = RunToEnd({chronyd, {"-p", "-f", file}, {}}, kPatience);
    EXPECT_EQ(printed.status, 0) << printed.output;
    for (const char* setting : {"authselectmode require", "maxchange 1 3 -1", "makestep"})
      EXPECT_THAT(printed.output, HasSubstr(setting)) << name;
  }
}

TEST_F(InstallTest, InstalledProgramsRun) {
  ASSERT_EQ(Install().status, 0);
  for (const char* name : {"isotherm", "isotherm-edge", "isotherm-ground"}) {
    const Finished help = RunToEnd({prefix_ / "bin" / name, {"--help"}, {}}, kPatience);
    EXPECT_EQ(help.status, 0) << name << ": " << help.output;
  }
}

TEST_F(InstallTest, AnEditedConfigurationIsKept) {
  ASSERT_EQ(Install().status, 0);
  const std::filesystem::path config = prefix_ / "etc/isotherm/ground.textproto";
  std::ofstream(config) << "threads: 1\n";
  const Finished again = Install();
  ASSERT_EQ(again.status, 0) << again.output;
  EXPECT_EQ(ReadAll(config), "threads: 1\n");
  EXPECT_TRUE(std::filesystem::exists(config.string() + ".new"));
  EXPECT_THAT(again.output, HasSubstr("was edited"));
}

TEST_F(InstallTest, TheServiceManagerAcceptsTheUnits) {
  const std::filesystem::path analyze = FindProgram("systemd-analyze");
  if (analyze.empty()) GTEST_SKIP() << "systemd-analyze is not installed";
  ASSERT_EQ(Install().status, 0);
  const Finished verify =
      RunToEnd({analyze,
                {"verify", "--man=no", Unit("isotherm-edge.service"),
                 Unit("isotherm-ground.service"), Unit("isotherm-ground@.service")},
                {}},
               kPatience);
  EXPECT_EQ(verify.status, 0) << verify.output;
  EXPECT_EQ(verify.output.find("isotherm-"), std::string::npos) << verify.output;
}

TEST_F(InstallTest, TheNetworkIsChosenInOneFile) {
  ASSERT_EQ(Install().status, 0);
  std::vector<std::string> chosen, offered;
  std::istringstream lines(ReadAll(prefix_ / "etc/isotherm/network.env"));
  for (std::string line; std::getline(lines, line);) {
    const std::size_t uri = line.find("CYCLONEDDS_URI=file://");
    if (uri == std::string::npos) continue;
    const std::string profile = line.substr(line.find("//") + 2);
    EXPECT_TRUE(std::filesystem::exists(profile)) << profile;
    (uri == 0 ? chosen : offered).push_back(std::filesystem::path(profile).filename());
  }
  EXPECT_THAT(chosen, ::testing::ElementsAre("cyclonedds-loopback.xml"));
  EXPECT_THAT(offered, ::testing::ElementsAre("cyclonedds-lan.xml", "cyclonedds-radio.xml"));
}

/// systemd-analyze may find this much to criticise, 0 (nothing) to 10. Without the network (1.1 of
/// it), reading the state of the clock (0.6) and, on the edge, devices, neither would be of use.
TEST_F(InstallTest, TheUnitsAreClosedAsFarAsTheyCanBe) {
  const std::filesystem::path analyze = FindProgram("systemd-analyze");
  if (analyze.empty()) GTEST_SKIP() << "systemd-analyze is not installed";
  ASSERT_EQ(Install().status, 0);
  for (const auto& [name, limit] :
       {std::pair{"edge", "16"}, std::pair{"ground", "14"}, std::pair{"ground@", "14"}}) {
    const Finished assessed =
        RunToEnd({analyze,
                  {"security", "--offline=yes", "--no-pager", "--threshold=" + std::string(limit),
                   Unit("isotherm-" + std::string(name) + ".service")},
                  {}},
                 kPatience);
    EXPECT_EQ(assessed.status, 0) << assessed.output;
  }
}

}  // namespace
}  // namespace isotherm::system_test
