#include "tests/lint/source_tree.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>

namespace isotherm::lint {
namespace {

constexpr std::array<std::string_view, 4> kSkippedFolders = {".git", "build", "out",
                                                             "node_modules"};
constexpr std::array<std::string_view, 14> kTextExtensions = {
    ".h",    ".cc",  ".proto", ".idl", ".txt", ".cmake",     ".md",
    ".json", ".xml", ".sh",    ".in",  ".mjs", ".textproto", ".supp"};

template <std::size_t N>
bool Contains(const std::array<std::string_view, N>& values, std::string_view value) {
  return std::find(values.begin(), values.end(), value) != values.end();
}

SourceFile Read(const std::filesystem::path& root, const std::filesystem::path& path) {
  SourceFile file{std::filesystem::relative(path, root).generic_string(), {}};
  std::ifstream stream(path);
  for (std::string line; std::getline(stream, line);) file.lines.push_back(std::move(line));
  return file;
}

}  // namespace

std::string SourceFile::folder() const {
  return std::filesystem::path(path).parent_path().generic_string();
}

std::string SourceFile::extension() const {
  return std::filesystem::path(path).extension().string();
}

bool SourceFile::IsTest() const {
  return path.starts_with("tests/") || path.ends_with("_test.cc") ||
         path.find("/testing/") != std::string::npos ||
         path.find("/reference/") != std::string::npos;
}

std::string ToString(const std::vector<Violation>& violations) {
  std::string text;
  for (const Violation& violation : violations) {
    text += violation.path + ":" + std::to_string(violation.line) + ": " + violation.message + "\n";
  }
  return text;
}

std::vector<SourceFile> ReadSourceTree(const std::filesystem::path& root) {
  std::vector<SourceFile> files;
  auto entry = std::filesystem::recursive_directory_iterator(root);
  for (; entry != std::filesystem::recursive_directory_iterator(); ++entry) {
    if (entry->is_directory() && Contains(kSkippedFolders, entry->path().filename().string())) {
      entry.disable_recursion_pending();
    } else if (entry->is_regular_file() &&
               Contains(kTextExtensions, entry->path().extension().string())) {
      files.push_back(Read(root, entry->path()));
    }
  }
  std::sort(files.begin(), files.end(),
            [](const SourceFile& a, const SourceFile& b) { return a.path < b.path; });
  return files;
}

}  // namespace isotherm::lint
