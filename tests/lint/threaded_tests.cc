#include "tests/lint/threaded_tests.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <string_view>

namespace isotherm::lint {
namespace {

constexpr const char* kListFile = "cmake/Isotherm.cmake";
constexpr const char* kReason = "not watched by the thread sanitizer: ";

using Files = std::map<std::string, const SourceFile*>;

std::string TextOf(const SourceFile& file) {
  std::string text;
  for (const std::string& line : file.lines) text += line.substr(0, line.find('#')) + '\n';
  return text;
}

std::vector<std::string> Words(const std::string& text) {
  std::istringstream stream(text);
  return {std::istream_iterator<std::string>(stream), {}};
}

/// Returns what stands between `call` and the next bracket that closes, from `at` on, which is
/// moved behind it; nullopt if there is no such call any more.
std::optional<std::string> NextArguments(const std::string& text, std::string_view call,
                                         std::size_t& at) {
  const std::size_t begin = text.find(call, at);
  if (begin == std::string::npos) return std::nullopt;
  const std::size_t end = text.find(')', begin);
  if (end == std::string::npos) return std::nullopt;
  at = end + 1;
  return text.substr(begin + call.size(), end - begin - call.size());
}

std::set<std::string> Listed(const Files& files) {
  const auto list = files.find(kListFile);
  if (list == files.end()) return {};
  std::size_t at = 0;
  const std::optional<std::string> names =
      NextArguments(TextOf(*list->second), "set(isotherm_threaded_tests", at);
  if (!names) return {};
  const std::vector<std::string> words = Words(*names);
  return {words.begin(), words.end()};
}

bool Contains(const SourceFile& file, const char* words) {
  return std::any_of(file.lines.begin(), file.lines.end(), [words](const std::string& line) {
    return line.find(words) != std::string::npos;
  });
}

/// Returns the first of the words by which a file starts or joins threads.
std::optional<std::string> ThreadWordIn(const SourceFile& file) {
  for (const char* word : {"std::jthread", "std::thread ", "std::thread(", "std::async",
                           "BoundedQueue<", "Participant::Create("}) {
    if (Contains(file, word)) return word;
  }
  return std::nullopt;
}

/// A test as a CMakeLists.txt declares it.
struct DeclaredTest {
  std::string name;
  std::vector<std::string> sources;  ///< Paths from the root.
};

std::vector<DeclaredTest> TestsIn(const SourceFile& cmake) {
  std::vector<DeclaredTest> tests;
  const std::string text = TextOf(cmake);
  std::size_t at = 0;
  while (const std::optional<std::string> arguments = NextArguments(text, "isotherm_test(", at)) {
    const std::vector<std::string> words = Words(*arguments);
    if (words.size() < 2 || words[0] != "NAME") continue;
    if (std::find(words.begin(), words.end(), "system") != words.end()) continue;
    DeclaredTest declared{words[1], {}};
    for (const std::string& word : words) {
      if (word.ends_with(".cc")) declared.sources.push_back(cmake.folder() + "/" + word);
    }
    tests.push_back(std::move(declared));
  }
  return tests;
}

/// The source and, of one that is named for what it tests, that too.
std::vector<const SourceFile*> Around(const std::string& source, const Files& files) {
  std::vector<std::string> paths = {source};
  const std::string ending = "_test.cc";
  if (source.ends_with(ending)) {
    const std::string stem = source.substr(0, source.size() - ending.size());
    paths.insert(paths.end(), {stem + ".h", stem + ".cc"});
  }
  std::vector<const SourceFile*> found;
  for (const std::string& path : paths) {
    if (const auto file = files.find(path); file != files.end()) found.push_back(file->second);
  }
  return found;
}

std::optional<Violation> Unwatched(const DeclaredTest& test, const Files& files) {
  std::optional<Violation> violation;
  for (const std::string& source : test.sources) {
    for (const SourceFile* file : Around(source, files)) {
      if (Contains(*file, kReason)) return std::nullopt;
      const std::optional<std::string> word = ThreadWordIn(*file);
      if (!word || violation) continue;
      violation = {file->path, 0,
                   test.name + " has several threads (" + *word + ") and is not in " + kListFile +
                       ", isotherm_threaded_tests; or say why it is \"" + kReason + "...\""};
    }
  }
  return violation;
}

}  // namespace

std::vector<Violation> CheckThreadedTests(const std::vector<SourceFile>& files) {
  Files by_path;
  for (const SourceFile& file : files) by_path[file.path] = &file;
  std::set<std::string> listed = Listed(by_path);
  std::vector<Violation> violations;
  for (const SourceFile& file : files) {
    if (!file.path.ends_with("CMakeLists.txt")) continue;
    for (const DeclaredTest& test : TestsIn(file)) {
      if (listed.erase(test.name) > 0) continue;
      if (auto violation = Unwatched(test, by_path)) violations.push_back(std::move(*violation));
    }
  }
  for (const std::string& name : listed)
    violations.push_back({kListFile, 0, "isotherm_threaded_tests names no test: " + name});
  return violations;
}

}  // namespace isotherm::lint
