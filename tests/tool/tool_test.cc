// Runs the program `isotherm` as a user does.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/support/tool.h"

namespace isotherm::testing {
namespace {

class ToolTest : public ToolRun {
 protected:
  // A small scan of a corner with a sphere, with truth: scan.mcap and scan.ply.
  void Simulate(const std::string& more = "") const {
    RunWell("simulate --scene corner-sphere --duration 0.4 -o scan.mcap --surface scan.ply " +
            more);
  }

  void PredictHeldOutViews() const {
    const Outcome text = Run("evaluate scan.mcap --held-out-views 4 --voxel 0.004");
    ASSERT_EQ(text.status, 0) << text.err;
    EXPECT_THAT(text.out, AllOf(HasSubstr("thermal frames predicted"), HasSubstr("mean of |error|"),
                                HasSubstr("within sigma")));
    const Outcome json =
        Run("evaluate scan.mcap --held-out-views 4 --voxel 0.004 --emissivity 0.96 "
            "--refractive-index 1.5 --json");
    EXPECT_THAT(json.out, AllOf(HasSubstr("\"mean_absolute_error_kelvin\""),
                                HasSubstr("\"assigned_fraction\"")));
    const Outcome too_few = Run("evaluate scan.mcap --held-out-views 1000000 --voxel 0.004");
    EXPECT_EQ(too_few.status, kData) << too_few.err;
    EXPECT_THAT(too_few.err, HasSubstr("fewer than 1000000 valid thermal frames"));
  }
  // Renderings of the result in `out`.
  void RenderResult() const {
    const Outcome one =
        Run("render out -o one.png --scale 20..60 --unit fahrenheit --size 320x240");
    ASSERT_EQ(one.status, 0) << one.err;
    EXPECT_THAT(one.out, AllOf(HasSubstr("the whole model"), HasSubstr("68.0 to 140.0 \u00B0F"),
                               HasSubstr("one.png")));
    EXPECT_THAT(ReadAll(folder_ / "one.png"), ::testing::StartsWith("\x89PNG"));
    // The pose that it says gives the same rendering again, from the model's file as well.
    const std::size_t pose = one.out.find("--view \"");
    ASSERT_NE(pose, std::string::npos);
    const Outcome again =
        Run("render out/model.iso -o folder/again.png --scale 20..60 --unit F " +
            one.out.substr(pose, one.out.find('\n', pose) - pose) + " --size 320x240");
    ASSERT_EQ(again.status, 0) << again.err;
    EXPECT_TRUE(fs::exists(folder_ / "folder" / "again.png"));
    const Outcome orbit = Run("render out -o orbit --orbit 3 --layer all --size 64x48");
    ASSERT_EQ(orbit.status, 0) << orbit.err;
    for (const char* name :
         {"thermal_000.png", "coverage_001.png", "age_001.png", "disagreement_002.png"})
      EXPECT_TRUE(fs::exists(folder_ / "orbit" / name)) << name;
    EXPECT_THAT(orbit.err, HasSubstr("rendering"));
    EXPECT_THAT(Run("render out -o last.png --view last --size 64x48").out, HasSubstr("last pose"));
    const Outcome away =
        Run("render out -o away.png --view-from \"0 0 -9\" --look-at \"0 0 -10\" --size 64x48");
    EXPECT_EQ(away.status, 0);
    EXPECT_THAT(away.err, HasSubstr("show nothing of the model"));
    RenderObjects();
    RefusedRenders();
  }

  // The same with the temperatures of the objects; without a legend only pixels can differ.
  void RenderObjects() const {
    const auto rendering = [&](const std::string& name, const std::string& arguments) {
      const Outcome outcome = Run("render out -o " + name + ".png --scale 20..60 --size 320x240 " +
                                  "--no-legend " + arguments);
      EXPECT_EQ(outcome.status, 0) << outcome.err;
      EXPECT_EQ(outcome.out.find("emissivity 0.9") != std::string::npos, !arguments.empty());
      return ReadAll(folder_ / (name + ".png"));
    };
    const std::string grey = rendering("grey", "--emissivity 0.9");
    const std::string paint = rendering("paint", "--emissivity 0.9 --material paint");
    EXPECT_NE(grey, rendering("apparent", ""));
    EXPECT_NE(paint, grey) << "the emissivity falls with the angle";
    const std::string uncertainty = "--layer uncertainty --emissivity 0.9 ";
    EXPECT_NE(rendering("a", uncertainty), rendering("b", uncertainty + "--emissivity-sigma 0.1"));
    const Outcome mirror = Run("render out -o mirror.png --emissivity 0.2 --reflected 300");
    EXPECT_EQ(mirror.status, kData);
    EXPECT_THAT(mirror.err, HasSubstr("more would be reflected"));
  }

  void RefusedRenders() const {
    const auto refused = [&](const std::string& arguments, int status, const std::string& says) {
      const Outcome outcome = Run("render " + arguments);
      EXPECT_EQ(outcome.status, status) << arguments << ": " << outcome.err;
      EXPECT_THAT(outcome.err, HasSubstr(says)) << arguments;
    };
    refused("nowhere -o x.png", kNoInput, "no such model or result folder");
    refused(". -o x.png", kNoInput, "has no model.iso");
    refused("scan.mcap -o x.png", kUsage, "not an Isotherm model");
    refused("out -o x.jpg", kUsage, "written as PNG; name x.png");
    refused("out -o x.png --layer all", kUsage, "renderings do not fit into one file");
    refused("out -o x.png --layer heat", kUsage, "there is no layer 'heat'");
    refused("out -o x.png --size 3x4", kUsage, "--size");
    refused("out -o x.png --view \"1 2 3\"", kUsage, "--view");
    refused("out -o x.png --look-at \"1 2 3\"", kUsage, "--view-from");
    refused("out -o x.png --palette jet --scale wide --isotherms warm", kConfiguration, "'jet'");
    refused("out -o x.png --isotherms warm", kConfiguration, "'warm' is no temperature");
    refused("out -o x.png --material paint", kConfiguration,
            "give the emissivity along the normal");
    refused("out -o x.png --emissivity 0.9 --material chalk", kConfiguration, "is not known");
    refused("out -o x.png --emissivity 1.2", kConfiguration, "at most 1, got 1.2");
  }

  // Results of out/model.iso with object temperatures; ASSERT needs a function of its own.
  void ExportResult() const {
    // The simulation's emissivity and surroundings give the objects' own temperatures.
    const Outcome objects = Run("export out/model.iso -o objects --emissivity 0.96 --reflected 23");
    ASSERT_EQ(objects.status, 0) << objects.err;
    EXPECT_THAT(ReadAll(folder_ / "objects/cloud.ply"),
                HasSubstr("float scalar_apparent_temperature"));
    EXPECT_THAT(ReadAll(folder_ / "objects/stats.json"), HasSubstr("\"emissivity\": 0.96"));
    EXPECT_TRUE(fs::exists(folder_ / "objects/renders/thermal.png"));

    const Outcome mirror =
        Run("export out/model.iso -o mirror --emissivity 0.96 "
            "--box '0 0 0 1 1 1: emissivity=0.2 reflected=300 name=mirror' "
            "--box '0 0 0 0.2 1 1: emissivity=0.9'");
    EXPECT_EQ(mirror.status, kData);
    EXPECT_THAT(mirror.err, AllOf(HasSubstr("mirror: "), HasSubstr("more would be reflected")));
    EXPECT_THAT(mirror.out, HasSubstr("overlap"));
    EXPECT_TRUE(fs::exists(folder_ / "mirror/mesh.ply"));
    EXPECT_EQ(Run("export out -o again --set export.expert.mesh=false").status, 0)
        << "a result folder";

    const Outcome wrong =
        Run("export out/model.iso -o wrong --emissivity 1.2 --box '0 0 0 1 1: emissivity=1'");
    EXPECT_EQ(wrong.status, kConfiguration);
    EXPECT_THAT(wrong.err, HasSubstr("--box: expected 6 numbers"));
    EXPECT_FALSE(fs::exists(folder_ / "wrong"));
    EXPECT_THAT(Run("export out/model.iso -o wrong --emissivity 1.2").err,
                HasSubstr("interpretation.emissivity must be above 0 and at most 1, got 1.2"));
    EXPECT_EQ(Run("export nowhere.iso -o wrong").status, kNoInput);
  }
};

TEST_F(ToolTest, HelpTeachesAndVersionNamesTheProgram) {
  const Outcome help = Run("--help");
  EXPECT_EQ(help.status, 0);
  EXPECT_THAT(help.out, AllOf(HasSubstr("isotherm import --from tum"), HasSubstr("Exit status"),
                              HasSubstr("78")));
  EXPECT_EQ(Run("").out, help.out);
  EXPECT_THAT(Run("--version").out, HasSubstr("isotherm 0."));
  for (const std::string name : {"demo", "import", "inspect", "reconstruct", "render", "evaluate",
                                 "export", "simulate", "limits"}) {
    EXPECT_THAT(help.out, HasSubstr(name));
    const Outcome each = Run(name + " --help");
    EXPECT_EQ(each.status, 0);
    EXPECT_THAT(each.out, HasSubstr("Example"));
  }
}

TEST_F(ToolTest, WrongCommandLinesAreOneSentenceAndStatus64) {
  for (const std::string arguments :
       {"dance", "import", "import --nonsense x -o y", "import x -o y --from kitti", "inspect",
        "evaluate x", "evaluate x.mcap --held-out-views 1", "evaluate x.mcap --held-out-views two",
        "evaluate x.mcap --voxel 0.004", "evaluate . --held-out-views 5",
        "evaluate x.mcap --held-out-views 5 --groundtruth y",
        "evaluate x.mcap --held-out-views 5 --emissivity 0.9",
        "reconstruct a.mcap -o b --initial-pose 1 --initial-pose-from c"}) {
    const Outcome outcome = Run(arguments);
    EXPECT_EQ(outcome.status, kUsage) << arguments;
    EXPECT_THAT(outcome.err, HasSubstr("isotherm: ")) << arguments;
    EXPECT_EQ(outcome.out, "") << arguments;
  }
}

TEST_F(ToolTest, AMisspeltCommandOrNameIsSuggested) {
  const Outcome command = Run("reconstuct scan.mcap -o out");
  EXPECT_EQ(command.status, kUsage);
  EXPECT_THAT(command.err, AllOf(HasSubstr("there is no command 'reconstuct'"),
                                 HasSubstr("Did you mean 'reconstruct'?")));
  const Outcome policy = Run("nuc --policy manaul");
  EXPECT_EQ(policy.status, kUsage);
  EXPECT_THAT(policy.err, HasSubstr("'manaul' is none of automatic, camera, manual. Did you mean"));
  EXPECT_THAT(Run("import x -o y --encoding png").err,
              HasSubstr("'png' is none of compact, viewable"));
  EXPECT_THAT(Run("import . -o ''").err, HasSubstr("-o '': names no file"));
}

TEST_F(ToolTest, AFlagThatWasRenamedIsRefusedWithItsPresentName) {
  for (const std::string flag : {"--outside-poses vio.txt", "--outside-poses=vio.txt"}) {
    const Outcome outcome = Run("import x -o y " + flag);
    EXPECT_EQ(outcome.status, kUsage) << flag;
    EXPECT_THAT(outcome.err, HasSubstr("is called --external-odometry now")) << flag;
  }
}

TEST_F(ToolTest, EveryOptionIsListedWithDefaultAndMeaning) {
  const Outcome ground = Run("options --expert");
  EXPECT_EQ(ground.status, 0) << ground.err;
  EXPECT_THAT(
      ground.out,
      AllOf(HasSubstr("\n  tsdf.expert.truncation_distance_m = 0\n      Signed distances"),
            HasSubstr("  tracker.external_odometry.expert.max_gap_s = 0.2\n"),
            HasSubstr("  thermal.expert.policy = BEST_CONDITIONS\n"), HasSubstr("LOWEST_GOOD")));
  const Outcome stage = Run("options ground volume");
  EXPECT_THAT(stage.out, AllOf(HasSubstr("volume.voxel_size_m = 0.002"), Not(HasSubstr("tsdf."))));
  EXPECT_THAT(Run("options edge").out, HasSubstr("\n  source.kind = "));
  EXPECT_THAT(Run("options simulate").out, HasSubstr("\n  duration_s = "));
  const Outcome unknown = Run("options ground tsfd");
  EXPECT_EQ(unknown.status, kUsage);
  EXPECT_THAT(unknown.err, HasSubstr("Did you mean 'tsdf'?"));
}

TEST_F(ToolTest, MissingInputsAreSaidWithStatus66) {
  EXPECT_EQ(Run("import nowhere -o scan.mcap").status, kNoInput);
  EXPECT_EQ(Run("inspect nowhere.mcap").status, kNoInput);
  EXPECT_EQ(Run("reconstruct nowhere.mcap -o out").status, kNoInput);
  EXPECT_FALSE(fs::exists(folder_ / "out"));
  EXPECT_EQ(Run("reconstruct nowhere.mcap -o out --config nowhere.textproto").status, kNoInput);
  fs::create_directory(folder_ / "result");
  const Outcome evaluate = Run("evaluate result --groundtruth nowhere.txt");
  EXPECT_EQ(evaluate.status, kNoInput);
  EXPECT_THAT(evaluate.err, HasSubstr("is 'result' the output folder"));
}

TEST_F(ToolTest, F59AllConfigurationErrorsAreListedAndNothingStarts) {
  Write("bad.textproto", "volume { size_x: 1 }\ntracker { use_thermal: \"far\" }\nvoxel: 2\n");
  const Outcome outcome =
      Run("reconstruct scan.mcap -o out --config bad.textproto --set tsdf.max_wieght=3 --voxel "
          "0.002 --volume big");
  EXPECT_EQ(outcome.status, kConfiguration);
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("bad.textproto:1:10: unknown field 'size_x'"),
                    HasSubstr("bad.textproto:2:24: "),
                    HasSubstr("bad.textproto:3:1: unknown field 'voxel'"),
                    HasSubstr("Did you mean 'expert.max_weight'?"), HasSubstr("--volume: 'big'")));
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(ToolTest, F59OptionsOutOfRangeAreConfigurationErrors) {
  const Outcome outcome =
      Run("reconstruct scan.mcap -o out --voxel -1 --set tsdf.expert.max_weight=0");
  EXPECT_EQ(outcome.status, kConfiguration);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("voxel_size_m"), HasSubstr("max_weight")));
}

TEST_F(ToolTest, F71HugeVolumeIsRefusedWithNumbers) {
  const Outcome outcome = Run("reconstruct scan.mcap -o out --volume 1e9 --voxel 0.001");
  EXPECT_EQ(outcome.status, kConfiguration) << outcome.err;
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(ToolTest, WhatCannotBePredictedIsOneSentence) {
  EXPECT_THAT(Run("evaluate x.mcap --held-out-views 1").err, HasSubstr("K must be at least 2"));
  EXPECT_THAT(Run("evaluate . --held-out-views 5").err, HasSubstr("is a folder"));
  EXPECT_EQ(Run("evaluate nowhere.mcap --held-out-views 5").status, kNoInput);
  EXPECT_EQ(Run("evaluate x.mcap --held-out-views 5 --voxel -1").status, kConfiguration);
  EXPECT_THAT(Run("evaluate x.mcap --held-out-views 5 --refractive-index 1.5").err,
              HasSubstr("give both or none"));
}

TEST_F(ToolTest, ScanGoesThroughTheWholeTool) {
  Simulate();
  const Outcome inspect = Run("inspect scan.mcap");
  EXPECT_EQ(inspect.status, 0) << inspect.err;
  EXPECT_THAT(inspect.out,
              AllOf(HasSubstr("complete"), HasSubstr("640 x 480"), HasSubstr("382 x 288"),
                    HasSubstr("0 missing"), HasSubstr("groundtruth")));
  EXPECT_THAT(Run("inspect scan.mcap --json").out,
              AllOf(HasSubstr("\"complete\": true"), HasSubstr("\"missing\": 0")));
  const Outcome render = Run("inspect scan.mcap --render 3 -o frame.png");
  EXPECT_EQ(render.status, 0) << render.err;
  EXPECT_THAT(ReadAll(folder_ / "frame.png"), ::testing::StartsWith("\x89PNG"));
  EXPECT_EQ(Run("inspect scan.mcap --render 3 --stream depth -o depth.png").status, 0);
  EXPECT_THAT(Run("inspect scan.mcap --render 99999 -o x.png").err,
              HasSubstr("there is no thermal frame 99999"));
  EXPECT_EQ(Run("inspect scan.mcap --render 0").status, kUsage);

  const Outcome reconstruct =
      Run("reconstruct scan.mcap -o out --voxel 0.004 --initial-pose-from scan.mcap");
  ASSERT_EQ(reconstruct.status, 0) << reconstruct.err;
  const Outcome evaluate =
      Run("evaluate out --groundtruth scan.mcap --surface scan.ply --emissivity 0.96 --ambient 23 "
          "--json");
  ASSERT_EQ(evaluate.status, 0) << evaluate.err;
  EXPECT_THAT(evaluate.out, AllOf(HasSubstr("\"aligned_m\""), HasSubstr("\"completeness\""),
                                  HasSubstr("\"good\"")));
  EXPECT_THAT(Run("evaluate out --groundtruth scan.mcap").out, HasSubstr("rigidly aligned"));
  EXPECT_EQ(Run("evaluate out --groundtruth scan.mcap --emissivity 0.9").status, kUsage);
  PredictHeldOutViews();
  RenderResult();
  ExportResult();
}

TEST_F(ToolTest, LimitsComeAsOptionsOrAsOneSentence) {
  const Outcome angles = Run("limits --material aluminium-oxidised --tolerance 2%");
  EXPECT_EQ(angles.status, 0) << angles.err;
  EXPECT_THAT(angles.out, AllOf(HasSubstr("--set thermal.angle.max_deg="), HasSubstr("thermal {")));
  const Outcome distances =
      Run("limits --focal-length 10mm --f-number 1 --focus 0.5m --pitch 25um --detail 2mm");
  EXPECT_EQ(distances.status, 0) << distances.err;
  EXPECT_THAT(distances.out, HasSubstr("--set thermal.distance.min_m=0.446"));
  EXPECT_THAT(Run("limits --list").out, HasSubstr("firebrick"));

  const Outcome unknown = Run("limits --material aluminum");
  EXPECT_EQ(unknown.status, kUsage);
  EXPECT_THAT(unknown.err,
              AllOf(HasSubstr("no material 'aluminum'"), HasSubstr("Did you mean 'aluminium'?")));
  const Outcome blurred =
      Run("limits --focal-length 10mm --f-number 1 --focus 0.5m --pitch 25um --detail 1mm");
  EXPECT_EQ(blurred.status, kData);
  EXPECT_THAT(blurred.err, HasSubstr("contradict each other"));
  EXPECT_EQ(Run("limits --material paint --tolerance 2").status, kUsage);
  EXPECT_EQ(Run("limits --material paint --good-tolerance 5% --tolerance 1%").status, kUsage);
  EXPECT_EQ(Run("limits --near 0.9m --far 0.3m").status, kUsage);
  EXPECT_EQ(Run("limits").status, kUsage);
}

TEST_F(ToolTest, F44TornRecordingIsInspectedUpToItsLastGoodPart) {
  Simulate();
  fs::resize_file(folder_ / "scan.mcap", fs::file_size(folder_ / "scan.mcap") * 2 / 3);
  const Outcome inspect = Run("inspect scan.mcap");
  EXPECT_EQ(inspect.status, 0) << inspect.err;
  EXPECT_THAT(inspect.out, HasSubstr("not complete"));
}

TEST_F(ToolTest, SimulateRefusesToOverwriteUnlessForced) {
  Write("scan.mcap", "precious");
  const Outcome outcome = Run("simulate --scene corner-sphere --duration 0.1 -o scan.mcap");
  EXPECT_EQ(outcome.status, kUsage);
  EXPECT_THAT(outcome.err, HasSubstr("exists already"));
  EXPECT_EQ(ReadAll(folder_ / "scan.mcap"), "precious");
  EXPECT_THAT(Run("simulate --scene furnace-dor -o x.mcap").err,
              HasSubstr("Did you mean 'furnace-door'?"));
  const Outcome empty = Run("simulate --duration 0 -o x.mcap");
  EXPECT_EQ(empty.status, kConfiguration);
  EXPECT_THAT(empty.err, HasSubstr("--duration must be above 0 s"));
}

TEST_F(ToolTest, FullStandardOutputIsAnError) {
  const std::string command =
      "'" ISOTHERM_PROGRAM "' --help >/dev/full 2>'" + (folder_ / "err.txt").string() + "'";
  const int help = std::system(command.c_str());
  EXPECT_NE(WEXITSTATUS(help), 1);
  Simulate();
  const std::string inspect = "cd '" + folder_.string() +
                              "' && '" ISOTHERM_PROGRAM "' inspect scan.mcap >/dev/full 2>err.txt";
  EXPECT_EQ(WEXITSTATUS(std::system(inspect.c_str())), kIo);
}

TEST_F(ToolTest, OutputThatCannotBeWrittenIsSaidBeforeAnyWork) {
  Simulate();
  Write("file", "");
  const Outcome reconstruct = Run("reconstruct scan.mcap -o file/out");
  EXPECT_TRUE(reconstruct.status == kCannotCreate || reconstruct.status == kIo)
      << reconstruct.status;
  EXPECT_THAT(reconstruct.err, HasSubstr("file/out"));
}

TEST_F(ToolTest, F70OutputIsTheSameInAnyLocaleAndForAnyFileName) {
  Simulate();
  const std::string name = "T\xc3\xbcr \xfc 1.mcap";
  fs::rename(folder_ / "scan.mcap", folder_ / name);
  const std::string arguments = "inspect '" + name + "'";
  const Outcome plain = Run(arguments, "LC_ALL=C TZ=UTC");
  EXPECT_EQ(plain.status, 0) << plain.err;
  for (const std::string environment : {"LC_ALL=de_DE.UTF-8 TZ=Asia/Tokyo", "LC_ALL=tr_TR.UTF-8",
                                        "LC_ALL=ar_SA.UTF-8", "LC_ALL=C.UTF-8"}) {
    EXPECT_EQ(Run(arguments, environment).out, plain.out) << environment;
  }
}

// Thermal without depth: what can be done works, the rest is refused in words.
TEST_F(ToolTest, RealThermalOnlyDataIsImportedInspectedAndRendered) {
  const char* set = std::getenv("ISOTHERM_DATA_DIR");
  const fs::path data = set != nullptr ? set : ISOTHERM_SOURCE_DIR "/../shared/data";
  if (!fs::exists(data / "optris_desk")) GTEST_SKIP() << "no test data; set ISOTHERM_DATA_DIR";
  const Outcome import =
      Run("import --from tum '" + (data / "optris_desk").string() + "' -o desk.mcap");
  ASSERT_EQ(import.status, 0) << import.err;
  EXPECT_THAT(import.out, AllOf(HasSubstr("100 thermal frames"), HasSubstr("thermal only")));
  EXPECT_THAT(Run("inspect desk.mcap").out,
              AllOf(HasSubstr("100 frames of 382 x 288"), HasSubstr("25.00 Hz")));
  EXPECT_EQ(Run("inspect desk.mcap --render 50 -o desk.png").status, 0);
  EXPECT_GT(fs::file_size(folder_ / "desk.png"), 10000U);
  const Outcome reconstruct = Run("reconstruct desk.mcap -o out");
  EXPECT_EQ(reconstruct.status, kData);
  EXPECT_THAT(reconstruct.err, HasSubstr("no depth"));
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

}  // namespace
}  // namespace isotherm::testing
