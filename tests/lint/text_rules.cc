#include "tests/lint/text_rules.h"

#include <algorithm>
#include <array>
#include <filesystem>
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
  for (const SourceFile& file : files) {
    Report report(file, violations);
    CheckMachineWords(file, report);
    CheckTrailingBlanks(file, report);
    if (file.IsHeader()) CheckHeader(file, report);
    if (file.IsCode()) CheckCode(file, report);
    if (IsCMake(file)) CheckCMake(file, report);
    if (file.extension() == ".md") CheckLinks(file, root, report);
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
