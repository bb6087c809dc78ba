// These tests look at what the programs load before they do anything. The edge runs on a small
// computer, so it loads few libraries and little memory; a library comes back unnoticed by way of
// another one.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "common/testing/sanitizers.h"
#include "common/testing/temporary_directory.h"
#include "tests/support/programs.h"

namespace isotherm::system_test {
namespace {

using ::testing::IsEmpty;
using testing::TemporaryDirectory;

constexpr std::size_t kMaxEdgeLibraries = 40;
constexpr double kMaxEdgeMemory_mb = 25.0;

/// Beginnings of libraries that draw, show windows, calibrate, solve large systems, or read every
/// format there is. Nothing of that is the work of a program that ships.
constexpr std::string_view kUnwanted[] = {"libopencv",  "libgdal",    "libavcodec", "libX11",
                                          "libGL",      "libgtk",     "libQt",      "libvtk",
                                          "libhdf5",    "libblas",    "liblapack",  "libtbb",
                                          "libOpenEXR", "libcurl.so", "libpython",  "libceres"};

std::vector<std::string> Unwanted(const std::set<std::string>& libraries) {
  std::vector<std::string> found;
  for (const std::string& library : libraries) {
    for (const std::string_view start : kUnwanted) {
      if (library.starts_with(start)) found.push_back(library);
    }
  }
  return found;
}

std::string Names(const std::set<std::string>& libraries) {
  std::string text;
  for (const std::string& library : libraries) text += library + '\n';
  return text;
}

/// The names of what the dynamic loader would load for `program`, as ldd lists them.
std::set<std::string> LibrariesOf(const std::filesystem::path& program) {
  const Finished listed = RunToEnd({program, {}, {"LD_TRACE_LOADED_OBJECTS=1"}}, kPatience);
  EXPECT_EQ(listed.status, 0) << listed.output;
  std::set<std::string> libraries;
  std::istringstream lines(listed.output);
  for (std::string line; std::getline(lines, line);) {
    std::string name;
    std::istringstream(line) >> name;
    libraries.insert(std::filesystem::path(name).filename());
  }
  return libraries;
}

/// The names of the libraries that a running program has mapped, with those it has opened by
/// itself.
std::set<std::string> LibrariesOf(pid_t pid) {
  std::set<std::string> libraries;
  std::ifstream maps("/proc/" + std::to_string(pid) + "/maps");
  for (std::string line; std::getline(maps, line);) {
    const std::size_t at = line.rfind('/');
    if (at == std::string::npos) continue;
    const std::string name = line.substr(at + 1);
    if (name.find(".so") != std::string::npos) libraries.insert(name);
  }
  return libraries;
}

TEST(LightEdgeTest, TheEdgeLoadsFewLibrariesAndNoneOfOthersWork) {
  const std::set<std::string> libraries = LibrariesOf(EdgeDaemon());
  EXPECT_TRUE(libraries.contains("libc.so.6")) << Names(libraries);
  EXPECT_LE(libraries.size(), kMaxEdgeLibraries) << Names(libraries);
  EXPECT_THAT(Unwanted(libraries), IsEmpty());
}

/// Letters of renderings are drawn without OpenCV, which would bring X11 and LAPACK with it.
TEST(LightEdgeTest, GroundServiceLoadsNoneOfThemEither) {
  const std::set<std::string> libraries = LibrariesOf(GroundService());
  EXPECT_TRUE(libraries.contains("libc.so.6")) << Names(libraries);
  EXPECT_LE(libraries.size(), kMaxEdgeLibraries) << Names(libraries);
  EXPECT_THAT(Unwanted(libraries), IsEmpty());
}

/// The tool calibrates cameras, with OpenCV and Ceres and what these stand on: linear algebra, and
/// OpenGL and X11, which Debian's opencv_core brings. It reads no formats but its own.
TEST(LightEdgeTest, TheToolLoadsWhatCalibrationNeedsAndNoMore) {
  std::vector<std::string> beyond;
  for (const std::string& library : Unwanted(LibrariesOf(Tool()))) {
    bool needed = false;
    for (const std::string_view start :
         {"libopencv_core", "libopencv_imgproc", "libopencv_calib3d", "libopencv_features2d",
          "libopencv_flann", "libblas", "liblapack", "libtbb", "libceres", "libGL", "libX11"})
      needed = needed || library.starts_with(start);
    if (!needed) beyond.push_back(library);
  }
  EXPECT_THAT(beyond, IsEmpty());
}

TEST(LightEdgeTest, TheRunningEdgeHasOpenedNoMore) {
  const TemporaryDirectory folder;
  SimulateScan(folder.path() / "scan.mcap", 0.3);
  Process edge({EdgeDaemon(),
                {"--recording", folder.path() / "scan.mcap", "--domain",
                 std::to_string(OwnDomain()), "--wait-for-ground"},
                {}});
  ASSERT_TRUE(edge.WaitForOutput("waiting for a ground station", kPatience)) << edge.output();
  const std::set<std::string> libraries = LibrariesOf(edge.pid());
  EXPECT_TRUE(libraries.contains("libc.so.6")) << Names(libraries);
  EXPECT_LE(libraries.size(), kMaxEdgeLibraries) << Names(libraries);
  EXPECT_THAT(Unwanted(libraries), IsEmpty());
  edge.Signal(SIGTERM);
  EXPECT_EQ(edge.WaitForExit(kPatience), 0) << edge.output();
}

/// Without a sanitizer, whose shadow memory counts too.
TEST(LightEdgeTest, TheEdgeNeedsLittleMemoryToStart) {
  if (testing::kAddressSanitizer || testing::kThreadSanitizer)
    GTEST_SKIP() << "a sanitizer's own memory counts too";
  // The largest of all children of this process so far: in a process of its own, only this one.
  EXPECT_EXIT(
      {
        const Finished version = RunToEnd({EdgeDaemon(), {"--version"}, {}}, kPatience);
        rusage usage{};
        getrusage(RUSAGE_CHILDREN, &usage);
        const double memory_mb = static_cast<double>(usage.ru_maxrss) / 1024.0;
        std::fprintf(stderr, "%.1f MB\n", memory_mb);
        std::exit(version.status == 0 && memory_mb <= kMaxEdgeMemory_mb ? 0 : 1);
      },
      ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace isotherm::system_test
