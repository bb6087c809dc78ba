// The programs are given something that cannot work. They say one sentence that names the file,
// return the exit status of --help, and lose nothing that was good.

#include "tests/system/bad_input.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <fstream>

namespace isotherm::system_test {
namespace {

using ::testing::HasSubstr;

// A calibration that cannot be right is said when a daemon starts with it.
TEST_F(BadInputTest, F57TheEdgeWarnsOfACalibrationThatCannotBeRight) {
  ImportGood();
  WriteRig(dataset_, "1000", "50");
  const Finished edge = RunToEnd(
      {EdgeDaemon(),
       {"--domain", std::to_string(OwnDomain()), "--recording", Recording(), "--rate", "0", "--set",
        "source.loops=1", "--exit-at-end", "--rig", dataset_.path() / "rig.textproto"},
       {}},
      kPatience);
  EXPECT_THAT(edge.output, HasSubstr("as millimetres they would be 0.05 m"));
}

TEST_F(BadInputTest, ThermalWithoutDepthIsImportedAndInspectedButNotReconstructed) {
  dataset_.Remove("depth.txt");
  dataset_.Remove("depth");
  dataset_.Write("rig.textproto", "thermal { width: 20 height: 15 fx: 20 fy: 20 cx: 9.5 cy: 7 }\n");
  ImportGood();
  const Finished inspect = RunTool({"inspect", Recording()});
  EXPECT_EQ(inspect.status, 0) << inspect.output;
  EXPECT_THAT(inspect.output, HasSubstr("thermal"));
  ExpectOneSentence(RunTool({"reconstruct", Recording(), "-o", Results()}), kBadData, "depth");
}

TEST_F(BadInputTest, AnInterruptedSimulationLeavesNothingBehind) {
  Process simulate(
      {Tool(),
       {"simulate", "--scene", "corner-sphere", "--duration", "3000", "-o", Recording()},
       {}});
  ASSERT_TRUE(simulate.WaitForOutput("simulating", kPatience)) << simulate.output();
  simulate.Signal(SIGTERM);
  ASSERT_TRUE(simulate.WaitForExit(kPatience).has_value());
  EXPECT_THAT(simulate.output(), HasSubstr("interrupted"));
  for (const auto& entry : std::filesystem::directory_iterator(dataset_.root()))
    EXPECT_TRUE(entry.is_directory()) << entry.path();
}

TEST_F(BadInputTest, MissingRecordingIsNamed) {
  const std::string nowhere = dataset_.root() / "nowhere.mcap";
  ExpectOneSentence(RunTool({"inspect", nowhere}), kNoInput, "nowhere.mcap");
  ExpectOneSentence(RunTool({"reconstruct", nowhere, "-o", Results()}), kNoInput, "nowhere.mcap");
}

TEST_F(BadInputTest, AFileThatIsNoRecordingIsNamed) {
  WriteFile(Recording(),
            "this is not MCAP at all, only text that is long enough to have been one\n");
  ExpectOneSentence(RunTool({"inspect", Recording()}), kBadData, "scan.mcap");
  ExpectOneSentence(RunTool({"reconstruct", Recording(), "-o", Results()}), kBadData, "scan.mcap");
}

TEST_F(BadInputTest, F44ATruncatedRecordingIsReadUpToItsLastGoodChunk) {
  SimulateScan(Recording(), 1.5);
  const auto whole = ReadRecording(Recording());
  std::filesystem::resize_file(Recording(), std::filesystem::file_size(Recording()) * 2 / 3);
  const auto rest = ReadRecording(Recording());
  EXPECT_FALSE(rest.complete);
  EXPECT_GT(rest.depth.size(), 0U);
  EXPECT_LT(rest.depth.size(), whole.depth.size());
  const Finished inspect = RunTool({"inspect", Recording()});
  EXPECT_EQ(inspect.status, 0) << inspect.output;
  EXPECT_THAT(inspect.output, HasSubstr("not complete (the recorder was interrupted)"));
  EXPECT_THAT(inspect.output, Not(HasSubstr("DAMAGED"))) << "nothing rots in it";
  std::vector<std::string> arguments = {"reconstruct", Recording(), "-o", Results()};
  for (const std::string& option : QuickModel()) arguments.push_back(option);
  const Finished reconstruct = RunTool(arguments);
  EXPECT_EQ(reconstruct.status, 0) << reconstruct.output;
  EXPECT_EQ(NumberAt(ReadStats(Results()), {"frames", "depth", "in"}),
            static_cast<double>(rest.depth.size()));
}

TEST_F(BadInputTest, F59AllConfigurationErrorsAreListedWithTheirPlace) {
  ImportGood();
  const std::filesystem::path config = dataset_.root() / "ground.textproto";
  WriteFile(config, "volume {\n  voxel_sice_m: 0.002 }\ntracker { colour: 1 }\n");
  const Finished reconstruct =
      RunTool({"reconstruct", Recording(), "-o", Results(), "--config", config});
  EXPECT_EQ(reconstruct.status, kConfiguration) << reconstruct.output;
  EXPECT_THAT(reconstruct.output, HasSubstr("ground.textproto:2:"));
  EXPECT_THAT(reconstruct.output, HasSubstr("voxel_sice_m"));
  EXPECT_THAT(reconstruct.output, HasSubstr("colour"));
  EXPECT_FALSE(std::filesystem::exists(Results()));
  for (const std::filesystem::path& daemon : {EdgeDaemon(), GroundService()}) {
    const Finished started = RunToEnd({daemon, {"--config", config}, {}}, kPatience);
    EXPECT_EQ(started.status, kConfiguration) << started.output;
    EXPECT_THAT(started.output, HasSubstr("ground.textproto:"));
  }
}

TEST_F(BadInputTest, F71AHugeVolumeIsRefusedWithNumbers) {
  ImportGood();
  const Finished reconstruct =
      RunTool({"reconstruct", Recording(), "-o", Results(), "--volume", "100", "--voxel", "0.001"});
  EXPECT_EQ(reconstruct.status, kConfiguration) << reconstruct.output;
  EXPECT_THAT(reconstruct.output, HasSubstr("volume"));
}

TEST_F(BadInputTest, WrongOptionsAreConfigurationErrors) {
  ImportGood();
  for (const char* assignment :
       {"tsdf.no_such_field=1", "nowhere.field=1", "tsdf.expert.max_weight=many",
        "volume.voxel_size_m=-1", "tracker.expert.min_inlier_ratio=nan"}) {
    const Finished reconstruct =
        RunTool({"reconstruct", Recording(), "-o", Results(), "--set", assignment});
    EXPECT_EQ(reconstruct.status, kConfiguration) << assignment << ": " << reconstruct.output;
  }
}

TEST_F(BadInputTest, WrongCommandLinesAreUsageErrors) {
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"no-such-command"}, {"import"}, {"reconstruct"}, {"inspect", "--no-such-option"}}) {
    EXPECT_EQ(RunTool(arguments).status, kUsage) << arguments.front();
  }
  for (const std::filesystem::path& daemon : {EdgeDaemon(), GroundService()}) {
    EXPECT_EQ(RunToEnd({daemon, {"--no-such-option"}, {}}, kPatience).status, kUsage) << daemon;
    const Finished level = RunToEnd({daemon, {"--log-level", "foo"}, {}}, kPatience);
    EXPECT_EQ(level.status, kUsage) << level.output;
    EXPECT_THAT(level.output, HasSubstr("'foo' is none of debug, error, info, warning"));
  }
}

TEST_F(BadInputTest, OutputThatCannotBeCreatedIsNamed) {
  ImportGood();
  WriteFile(dataset_.root() / "file", "a file where a folder should be");
  const std::string below = dataset_.root() / "file/results";
  const auto cannot_create = ::testing::AnyOf(kCannotCreate, kIoError);
  ExpectOneSentence(RunTool({"reconstruct", Recording(), "-o", below}), cannot_create, "file");
  ExpectOneSentence(RunTool({"import", dataset_.path(), "-o", below + ".mcap"}), cannot_create,
                    "file");
  const std::string domain = std::to_string(OwnDomain());
  // As a service it waits for the folder.
  ExpectOneSentence(
      RunToEnd({GroundService(), {"--domain", domain, "--output", below, "--once"}, {}}, kPatience),
      cannot_create, "file");
  const Finished edge =
      RunToEnd({EdgeDaemon(),
                {"--domain", domain, "--recording", Recording(), "--record", below + ".mcap",
                 "--exit-at-end"},  // As a service it waits for the disk.
                {}},
               kPatience);
  EXPECT_THAT(edge.status, cannot_create) << edge.output;
  EXPECT_THAT(edge.output, HasSubstr("file"));
}

TEST_F(BadInputTest, AFullStandardOutputIsAnError) {
  ImportGood();
  EXPECT_EQ(RunTool({"inspect", Recording()}, "/dev/full").status, kIoError);
}

/// Runs the tool with a small file system mounted on `folder`; nullopt if this computer does not
/// allow that.
std::optional<Finished> RunWithSmallDisk(const std::filesystem::path& folder,
                                         const std::string& size, const std::string& command) {
  std::filesystem::create_directories(folder);
  const std::string mount =
      "mount -t tmpfs -o size=" + size + " none '" + folder.string() + "' && ";
  const auto run = [&](const std::string& script) {
    return RunToEnd(
        {"/usr/bin/unshare", {"--map-root-user", "--mount", "/bin/sh", "-c", script}, {}},
        kPatience);
  };
  if (!std::filesystem::exists("/usr/bin/unshare") || run(mount + "true").status != 0)
    return std::nullopt;
  return run(mount + command);
}

TEST_F(BadInputTest, AFullDiskEndsAnImportAndNamesTheFile) {
  const std::filesystem::path disk = dataset_.root() / "disk";
  const auto finished =
      RunWithSmallDisk(disk, "4k",
                       "exec '" + Tool().string() + "' import '" + dataset_.path().string() +
                           "' -o '" + disk.string() + "/scan.mcap'");
  if (!finished) GTEST_SKIP() << "mounting a small file system is not allowed here";
  ExpectOneSentence(*finished, kCannotCreate, "scan.mcap");
}

TEST_F(BadInputTest, AFullDiskEndsAReconstructionAndNamesTheFile) {
  SimulateScan(Recording(), 0.5);
  const std::filesystem::path disk = dataset_.root() / "disk";
  const auto finished = RunWithSmallDisk(disk, "64k",
                                         "exec '" + Tool().string() + "' reconstruct '" +
                                             Recording().string() + "' -o '" + disk.string() +
                                             "/results' --set volume.voxel_size_m=0.006 --set " +
                                             "tsdf.expert.truncation_distance_m=0.024");
  if (!finished) GTEST_SKIP() << "mounting a small file system is not allowed here";
  EXPECT_EQ(finished->status, kCannotCreate) << finished->output;
  EXPECT_THAT(finished->output, HasSubstr("results"));
}

TEST_F(BadInputTest, ABadCalibrationHasOneExitStatusEverywhere) {
  ImportGood();
  dataset_.Write("rig.textproto", "depth { width: 32 height: 24 fx: 0 fy: 30 cx: 15 cy: 11 }\n");
  const std::string rig = dataset_.path() / "rig.textproto";
  const Finished import =
      RunTool({"import", dataset_.path(), "-o", dataset_.root() / "other.mcap"});
  EXPECT_EQ(import.status, kBadData) << import.output;
  const Finished edge =
      RunToEnd({EdgeDaemon(),
                {"--domain", std::to_string(OwnDomain()), "--recording", Recording(), "--rig", rig},
                {}},
               kPatience);
  EXPECT_EQ(edge.status, kBadData) << edge.output;
}

/// The decimal comma and other alphabets of a locale do not reach what is written. (A locale that
/// is not installed acts like C; the programs never ask for one.)
TEST_F(BadInputTest, F70OutputDoesNotDependOnTheLocale) {
  ImportGood();
  const Finished plain = RunToEnd({Tool(), {"inspect", Recording()}, {"LC_ALL=C"}}, kPatience);
  for (const char* locale : {"LC_ALL=de_DE.UTF-8", "LC_ALL=tr_TR.UTF-8", "LC_ALL=ar_EG.UTF-8"}) {
    const Finished other =
        RunToEnd({Tool(), {"inspect", Recording()}, {locale, "TZ=Asia/Kolkata"}}, kPatience);
    EXPECT_EQ(other.output, plain.output) << locale;
  }
}

TEST_F(BadInputTest, F70NamesThatAreNoUtf8Work) {
  const DatasetFolder odd("caf\xe9 \xff");
  const std::filesystem::path recording = odd.root() / "ofen \xfc.mcap";
  const Finished import = RunTool({"import", odd.path(), "-o", recording});
  EXPECT_EQ(import.status, 0) << import.output;
  const Finished inspect = RunTool({"inspect", recording});
  EXPECT_EQ(inspect.status, 0) << inspect.output;
}

}  // namespace
}  // namespace isotherm::system_test
