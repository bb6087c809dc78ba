#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace isotherm::testing {

// What every test of the tool uses.
namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
/// Exit statuses, as in sysexits.h.
inline constexpr int kUsage = 64, kData = 65, kNoInput = 66, kCannotCreate = 73, kIo = 74,
                     kConfiguration = 78;

inline std::string ReadAll(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// Holds how a program ended and what it wrote.
struct Outcome {
  int status = -1;
  std::string out;
  std::string err;
};

/// Runs the program ISOTHERM_PROGRAM as a user does, in an empty folder that disappears afterwards.
class ToolRun : public ::testing::Test {
 protected:
  ToolRun() {
    std::string pattern =
        (std::filesystem::temp_directory_path() / "isotherm-tool-XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~ToolRun() override {
    std::error_code error;
    std::filesystem::remove_all(folder_, error);
  }

  // `arguments` are words for the shell; the program runs in the test's folder.
  Outcome Run(const std::string& arguments, const std::string& environment = "") const {
    const std::string command = "cd '" + folder_.string() + "' && " + environment +
                                " '" ISOTHERM_PROGRAM "' " + arguments +
                                " >out.txt 2>err.txt </dev/null";
    const int raw = std::system(command.c_str());
    return {WIFEXITED(raw) ? WEXITSTATUS(raw) : -1, ReadAll(folder_ / "out.txt"),
            ReadAll(folder_ / "err.txt")};
  }

  /// Runs it where nothing may fail.
  void RunWell(const std::string& arguments) const {
    const Outcome outcome = Run(arguments);
    ASSERT_EQ(outcome.status, 0) << arguments << ": " << outcome.err;
  }

  void Write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }

  std::filesystem::path folder_;
};

}  // namespace isotherm::testing
