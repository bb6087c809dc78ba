#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace isotherm::lint {

/// A text file of the repository. `path` is relative to the root, with forward slashes.
struct SourceFile {
  std::string path;
  std::vector<std::string> lines;

  /// Folder without the file name: "common/base"; empty at the root.
  std::string folder() const;
  std::string extension() const;
  bool IsHeader() const { return extension() == ".h"; }
  bool IsSource() const { return extension() == ".cc"; }
  bool IsCode() const { return IsHeader() || IsSource(); }
  /// Tests, benchmarks and test helpers may look across borders that programs respect.
  bool IsTest() const;
};

/// A rule that a line breaks. Line 0 means the file as a whole.
struct Violation {
  std::string path;
  int line = 0;
  std::string message;
};

/// "path:line: message" per violation, for a test's failure text.
std::string ToString(const std::vector<Violation>& violations);

/// Reads all text files below `root` except build trees, results and what a tool fetched, sorted by
/// path.
std::vector<SourceFile> ReadSourceTree(const std::filesystem::path& root);

}  // namespace isotherm::lint
