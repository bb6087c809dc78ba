#include "tests/lint/text_rules.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>

namespace isotherm::lint {
namespace {

/// Collects the violations of one file.
class Report {
 public:
  Report(const SourceFile& file, std::vector<Violation>& violations)
      : file_(file), violations_(violations) {}
  void Add(std::size_t line_index, std::string message) {
    violations_.push_back({file_.path, static_cast<int>(line_index + 1), std::move(message)});
  }
  void AddForFile(std::string message) {
    violations_.push_back({file_.path, 0, std::move(message)});
  }

 private:
  const SourceFile& file_;
  std::vector<Violation>& violations_;
};

bool Has(std::string_view line, std::string_view word) {
  return line.find(word) != std::string_view::npos;
}

/// Words looked for are put together from halves, so that this file does not break its own rules.
std::string Joined(std::string_view a, std::string_view b) {
  return std::string(a) + std::string(b);
}

const std::array<std::string, 4>& MachineWords() {
  static const std::array<std::string, 4> kWords = {Joined("/ho", "me/"), Joined("/ro", "ot/"),
                                                    Joined("/Us", "ers/"), Joined("/wo", "rk/")};
  return kWords;
}

void CheckMachineWords(const SourceFile& file, Report& report) {
  for (std::size_t i = 0; i < file.lines.size(); ++i) {
    for (const std::string& word : MachineWords()) {
      const std::size_t at = file.lines[i].find(word);
      // Inside a longer path (a/work/b) it is somebody's folder name, not the root of a machine.
      const bool absolute =
          at != std::string::npos &&
          (at == 0 ||
           std::string_view(" \t\"'`(<=:").find(file.lines[i][at - 1]) != std::string_view::npos);
      if (absolute) report.Add(i, "names a place on one machine: " + word);
    }
  }
}

void CheckHeader(const SourceFile& file, Report& report) {
  const auto& lines = file.lines;
  // Parts of kernels are included once per instruction set and have a guard of their own.
  const bool part_of_kernel = file.path.ends_with("-inl.h");
  if (!part_of_kernel && std::find(lines.begin(), lines.end(), "#pragma once") == lines.end()) {
    report.AddForFile("header without #pragma once");
  }
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (Has(lines[i], "using namespace ")) report.Add(i, "using namespace in a header");
  }
}

void CheckCode(const SourceFile& file, Report& report) {
  static const std::string kDisabled = Joined("DISABLED", "_");
  static const std::string kDetach = Joined(".det", "ach()");
  static const std::string kRecursive = Joined("std::recursive", "_mutex");
  static const std::string kVolatile = Joined("vola", "tile ");
  for (std::size_t i = 0; i < file.lines.size(); ++i) {
    const std::string& line = file.lines[i];
    if (Has(line, "\t")) report.Add(i, "tab");
    if (line.starts_with("TEST") && Has(line, kDisabled)) {
      report.Add(i, "disabled test: use GTEST_SKIP with a reason");
    }
    if (Has(line, kDetach)) report.Add(i, "detached thread: nobody could wait for it");
    if (Has(line, kRecursive)) report.Add(i, "recursive mutex");
    if (line.starts_with(kVolatile) || Has(line, " " + kVolatile)) {
      report.Add(i, "not for threads: use std::atomic; in benchmarks DoNotOptimize");
    }
  }
}

bool IsCMake(const SourceFile& file) {
  return file.path.ends_with("CMakeLists.txt") || file.extension() == ".cmake";
}

void CheckCMake(const SourceFile& file, Report& report) {
  if (file.lines.empty() || !file.lines.front().starts_with("# ")) {
    report.AddForFile("first line must say what the folder is for");
  } else if (Has(file.lines.front(), "placeholder")) {
    report.Add(0, "placeholder: say what the folder is for");
  }
  for (std::size_t i = 0; i < file.lines.size(); ++i) {
    const std::string_view code =
        std::string_view(file.lines[i]).substr(0, file.lines[i].find('#'));
    if (Has(code, "GLOB")) report.Add(i, "globbing: list the sources");
    if (Has(code, "-march=") || Has(code, "-mtune="))
      report.Add(i, "CPU flags belong into presets only");
    if (code.starts_with("include_directories") || code.starts_with("link_libraries")) {
      report.Add(i, "global directory property: use target_*");
    }
  }
}

/// The relative link target that starts behind "](" at `at`; empty for addresses and places on the
/// same page.
std::string LinkTarget(std::string_view line, std::size_t at) {
  const std::size_t begin = at + 2;
  const std::size_t end = line.find(')', begin);
  if (end == std::string_view::npos) return {};
  const std::string_view target = line.substr(begin, end - begin);
  if (Has(target, "://") || target.starts_with("#") || target.starts_with("mailto:")) return {};
  return std::string(target.substr(0, target.find('#')));
}

void CheckLinks(const SourceFile& file, const std::filesystem::path& root, Report& report) {
  bool in_code_block = false;
  for (std::size_t i = 0; i < file.lines.size(); ++i) {
    const std::string_view line = file.lines[i];
    if (line.starts_with("```")) in_code_block = !in_code_block;
    if (in_code_block) continue;
    for (std::size_t at = line.find("]("); at != std::string_view::npos;
         at = line.find("](", at + 2)) {
      const std::string target = LinkTarget(line, at);
      if (!target.empty() && !std::filesystem::exists(root / file.folder() / target)) {
        report.Add(i, "link leads nowhere: " + target);
      }
    }
  }
}

bool IsPathCharacter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || Has("_./-", std::string_view(&c, 1));
}

/// The paths from the root that a line names: "ground/tsdf/x.cc", but not the end of a longer path.
std::vector<std::string> NamedPaths(std::string_view line) {
  std::vector<std::string> paths;
  for (const std::string_view folder : {"cmake/", "common/", "deploy/", "docs/", "edge/", "ground/",
                                        "idl/", "systemd/", "tests/"}) {
    for (std::size_t at = line.find(folder); at != std::string_view::npos;
         at = line.find(folder, at + 1)) {
      // Links are relative, and checked as such.
      if (at > 0 && (IsPathCharacter(line[at - 1]) || Has("$~(", line.substr(at - 1, 1)))) continue;
      std::size_t end = at;
      while (end < line.size() && IsPathCharacter(line[end])) ++end;
      while (Has("./", line.substr(end - 1, 1))) --end;  // The end of a sentence, or of a folder.
      paths.emplace_back(line.substr(at, end - at));
    }
  }
  return paths;
}

void CheckNamedPaths(const SourceFile& file, const std::filesystem::path& root, Report& report) {
  if (file.path == "CHANGELOG.md") return;  // It tells of what was.
  for (std::size_t i = 0; i < file.lines.size(); ++i) {
    for (const std::string& path : NamedPaths(file.lines[i])) {
      // A program is named like its source.
      if (std::filesystem::exists(root / path) || std::filesystem::exists(root / (path + ".cc")))
        continue;
      report.Add(i, "names a file that is not there: " + path);
    }
  }
}

std::set<std::string> TestSuites(const std::vector<SourceFile>& files) {
  std::set<std::string> suites;
  for (const SourceFile& file : files) {
    if (!file.IsSource()) continue;
    for (const std::string& line : file.lines) {
      const std::size_t begin = line.find('(') + 1;
      if (line.starts_with("TEST")) suites.insert(line.substr(begin, line.find(',') - begin));
    }
  }
  return suites;
}

/// A page that says which test shows something names it in backticks.
void CheckNamedTests(const SourceFile& file, const std::set<std::string>& suites, Report& report) {
  for (std::size_t i = 0; i < file.lines.size(); ++i) {
    const std::string& line = file.lines[i];
    for (std::size_t end = line.find("Test`"); end != std::string::npos;
         end = line.find("Test`", end + 1)) {
      const std::size_t begin = line.rfind('`', end) + 1;
      const std::string suite = line.substr(begin, end + 4 - begin);
      if (!suites.contains(suite)) report.Add(i, "names a test that is not there: " + suite);
    }
  }
}

void CheckTrailingBlanks(const SourceFile& file, Report& report) {
  for (std::size_t i = 0; i < file.lines.size(); ++i) {
    const std::string& line = file.lines[i];
    if (!line.empty() && (line.back() == ' ' || line.back() == '\t'))
      report.Add(i, "trailing blank");
    if (!line.empty() && line.back() == '\r') report.Add(i, "carriage return");
  }
}

}  // namespace

std::vector<Violation> CheckText(const std::vector<SourceFile>& files,
                                 const std::filesystem::path& root) {
  std::vector<Violation> violations;
  const std::set<std::string> suites = TestSuites(files);
  for (const SourceFile& file : files) {
    Report report(file, violations);
    CheckMachineWords(file, report);
    CheckTrailingBlanks(file, report);
    if (file.IsHeader()) CheckHeader(file, report);
    if (file.IsCode()) CheckCode(file, report);
    if (IsCMake(file)) CheckCMake(file, report);
    if (file.extension() != ".md") continue;
    CheckLinks(file, root, report);
    CheckNamedPaths(file, root, report);
    CheckNamedTests(file, suites, report);
  }
  return violations;
}

std::vector<Violation> FindLongFiles(const std::vector<SourceFile>& files, std::size_t max_lines) {
  std::vector<Violation> notices;
  for (const SourceFile& file : files) {
    if (!file.IsCode() || file.lines.size() <= max_lines) continue;
    notices.push_back({file.path, 0, std::to_string(file.lines.size()) + " lines"});
  }
  return notices;
}

}  // namespace isotherm::lint
