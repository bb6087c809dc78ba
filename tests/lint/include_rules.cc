#include "tests/lint/include_rules.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "tests/lint/folder_arrows.h"

namespace isotherm::lint {
namespace {

/// Tests play peers with the middleware itself.
constexpr std::string_view kTransport = "common/transport";
constexpr std::string_view kPeers = "tests/link/peers";

/// Heavy headers that would slow down everybody who includes one of our shared headers.
constexpr std::string_view kSourceOnly[] = {
    "opencv2/", "google/protobuf/", "zstd.h",           "zlib.h", "hwy/",
    "CLI/",     "boost/",           "nlohmann/json.hpp"};

/// Headers that are templates of one source file, too long for it: only that one includes them.
constexpr std::string_view kPartsOfASource[] = {"ground/console/http_connection.h",
                                                "ground/console/web_socket_connection.h"};
constexpr std::string_view kSourceOfParts = "ground/console/web_server.cc";

/// Headers with no place in this code, and what to take instead.
struct ForbiddenHeader {
  std::string_view header;
  std::string_view reason;
};
constexpr ForbiddenHeader kForbidden[] = {
    {"bits/", "include the standard header"},
    {"opencv2/imgcodecs.hpp", "it opens every format there is; common/png reads and writes images"},
    {"regex", "slow to compile and to run; parse by hand"},
    {"codecvt", "deprecated"},
    {"strstream", "deprecated"},
    {"math.h", "include <cmath>"},
    {"stdint.h", "include <cstdint>"},
    {"stdio.h", "include <cstdio>"},
    {"stdlib.h", "include <cstdlib>"},
    {"string.h", "include <cstring>"},
    {"assert.h", "use CHECK of common/base/check.h"},
    {"cassert", "use CHECK of common/base/check.h"},
};

struct Include {
  std::string header;
  bool quoted = false;
};

std::optional<Include> ParseInclude(std::string_view line) {
  const auto skip_blanks = [&line] {
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
  };
  skip_blanks();
  if (!line.starts_with("#")) return std::nullopt;
  line.remove_prefix(1);
  skip_blanks();
  if (!line.starts_with("include")) return std::nullopt;
  line.remove_prefix(std::string_view("include").size());
  skip_blanks();
  if (line.empty() || (line.front() != '"' && line.front() != '<')) return std::nullopt;
  const bool quoted = line.front() == '"';
  const std::size_t end = line.find(quoted ? '"' : '>', 1);
  if (end == std::string_view::npos) return std::nullopt;
  return Include{std::string(line.substr(1, end - 1)), quoted};
}

bool IsPartOfASource(std::string_view path) {
  return std::ranges::count(kPartsOfASource, path) > 0;
}

std::string_view TopFolder(std::string_view path) { return path.substr(0, path.find('/')); }

/// Why `file` must not include our header `header`; empty if it may.
std::string CheckOwn(const SourceFile& file, std::string_view header) {
  if (header.starts_with(".")) return "include it by its path from the root";
  const std::size_t slash = header.rfind('/');
  if (slash == std::string_view::npos) return "include it by its path from the root";
  if (IsPartOfASource(header) && file.path != kSourceOfParts && !IsPartOfASource(file.path))
    return "it is part of " + std::string(kSourceOfParts);
  const std::string folder = file.folder();
  const std::string_view target = header.substr(0, slash);
  const std::string_view from = TopFolder(folder);
  const std::string_view to = TopFolder(target);
  if (from == "tests") return {};
  if (from == "edge" && to == "ground") return "edge must not include ground";
  if (from == "ground" && to == "edge") return "ground must not include edge";
  if (from == "common" && to != "common") return "common must not include " + std::string(to);
  if (file.IsTest()) return {};
  if (to == "tests" || target.ends_with("/testing")) return "test helpers are for tests only";
  if (target.ends_with("/reference")) return "references of kernels are for tests only";
  if (folder == target) return {};
  const DependencyRule& rule = RepositoryRule();
  if (!rule.arrows.contains(folder)) {
    return "folder " + folder + " has no rule yet: add it to tests/lint/folder_arrows.cc";
  }
  if (rule.Allows(folder, target)) return {};
  return folder + " must not include " + std::string(target);
}

/// A folder, what imitates the device for its tests, and for DDS the peers that tests play.
bool IsHome(std::string_view folder, std::string_view home) {
  return folder == home || folder == std::string(home) + "/testing" ||
         (home == kTransport && folder == kPeers);
}

/// Why `file` must not include a library's header; empty if it may.
std::string CheckLibrary(const SourceFile& file, std::string_view header) {
  for (const ForbiddenHeader& forbidden : kForbidden) {
    const bool is_folder = forbidden.header.ends_with('/');
    if (is_folder ? header.starts_with(forbidden.header) : header == forbidden.header) {
      return "<" + std::string(header) + "> is not used here: " + std::string(forbidden.reason);
    }
  }
  for (const auto& [prefix, home] : RepositoryRule().sdk_homes) {
    if (!header.starts_with(prefix)) continue;
    if (!IsHome(file.folder(), home)) return std::string(header) + " belongs to " + home + " only";
    if (!file.IsSource() && !IsPartOfASource(file.path))
      return std::string(header) + " may be included by .cc files only";
  }
  return {};
}

/// Why `header` is too heavy for a header that other folders include; empty if it is not.
std::string CheckWeight(std::string_view header) {
  for (const std::string_view prefix : kSourceOnly) {
    if (header.starts_with(prefix))
      return std::string(header) + " reaches other folders through this header";
  }
  // Stages keep their options message, and shapes are one message wherever they are measured, kept,
  // shown and reported; every other generated message stays inside its folder.
  if (header.ends_with(".pb.h") && !header.ends_with("_options.pb.h") &&
      header != "ground/measuring/measuring.pb.h") {
    return "generated messages reach other folders through this header";
  }
  return {};
}

/// Headers of ours that files of another folder include.
std::set<std::string> SharedHeaders(const std::vector<SourceFile>& files) {
  std::set<std::string> shared;
  for (const SourceFile& file : files) {
    if (!file.IsCode()) continue;
    for (const std::string& line : file.lines) {
      const std::optional<Include> include = ParseInclude(line);
      if (include && include->header.substr(0, include->header.rfind('/')) != file.folder()) {
        shared.insert(include->header);
      }
    }
  }
  return shared;
}

bool IsOurs(const Include& include) {
  if (!include.quoted) return false;
  const std::string_view top = TopFolder(include.header);
  const bool has_folder = include.header.find('/') != std::string::npos;
  return !has_folder || top == "common" || top == "edge" || top == "ground" || top == "tests" ||
         include.header.starts_with(".");
}

/// Returns which folders the programs' files of each folder include; the folder itself does not
/// count.
FolderArrows ArrowsOf(const std::vector<SourceFile>& files) {
  FolderArrows arrows;
  for (const SourceFile& file : files) {
    if (!file.IsCode() || file.IsTest()) continue;
    for (const std::string& line : file.lines) {
      const std::optional<Include> include = ParseInclude(line);
      if (!include || !IsOurs(*include)) continue;
      const std::size_t slash = include->header.rfind('/');
      if (slash == std::string::npos) continue;
      const std::string target = include->header.substr(0, slash);
      if (target != file.folder()) arrows[file.folder()].insert(target);
    }
  }
  return arrows;
}

Folders FoldersOf(const std::vector<SourceFile>& files) {
  Folders folders;
  for (const SourceFile& file : files) folders.insert(file.folder());
  return folders;
}

/// Says whether `folder` includes a header that begins like this.
bool IncludesAny(const std::vector<SourceFile>& files, std::string_view folder,
                 std::string_view prefix) {
  return std::ranges::any_of(files, [&](const SourceFile& file) {
    return file.folder() == folder && std::ranges::any_of(file.lines, [&](const std::string& line) {
             const std::optional<Include> include = ParseInclude(line);
             return include && include->header.starts_with(prefix);
           });
  });
}

}  // namespace

std::vector<Violation> CheckIncludes(const std::vector<SourceFile>& files) {
  std::vector<Violation> violations;
  const std::set<std::string> shared = SharedHeaders(files);
  for (const SourceFile& file : files) {
    if (!file.IsCode()) continue;
    for (std::size_t i = 0; i < file.lines.size(); ++i) {
      const std::optional<Include> include = ParseInclude(file.lines[i]);
      if (!include) continue;
      std::string message = CheckLibrary(file, include->header);
      // Parts of kernels that several sources share are included once per instruction set.
      const bool part_of_kernel = file.path.ends_with("-inl.h");
      if (message.empty() && shared.contains(file.path) && !file.IsTest() && !part_of_kernel) {
        message = CheckWeight(include->header);
      }
      const bool sdk = std::ranges::any_of(RepositoryRule().sdk_homes, [&](const auto& home) {
        return include->header.starts_with(home.first);
      });
      if (message.empty() && !sdk && IsOurs(*include)) message = CheckOwn(file, include->header);
      if (!message.empty()) {
        violations.push_back({file.path, static_cast<int>(i + 1), std::move(message)});
      }
    }
  }
  return violations;
}

std::vector<Violation> CheckCircles(const std::vector<SourceFile>& files) {
  const std::vector<std::string> circle = FindCircle(ArrowsOf(files));
  if (circle.empty()) return {};
  std::string message = "folders include each other in a circle: " + circle.front();
  for (std::size_t i = 1; i < circle.size(); ++i) message += " -> " + circle[i];
  return {{circle.front(), 0, std::move(message)}};
}

std::vector<Violation> CheckListed(const std::vector<SourceFile>& files,
                                   const DependencyRule& rule) {
  std::vector<Violation> violations;
  const auto report = [&](std::string message) {
    violations.push_back({"tests/lint/folder_arrows.cc", 0, std::move(message)});
  };
  const FolderArrows used = ArrowsOf(files);
  const auto is_used = [&](std::string_view folder, const std::string& target) {
    const auto found = used.find(folder);
    return found != used.end() && found->second.contains(target);
  };
  const Folders folders = FoldersOf(files);
  for (const auto& [folder, targets] : rule.arrows) {
    if (!folders.contains(folder)) report(folder + " is listed, but there is no such folder");
    for (const std::string& target : targets) {
      if (!folder.starts_with("common/") && rule.shared.contains(target)) {
        report(folder + " is listed with " + target + ", which every folder may include");
      } else if (!is_used(folder, target)) {
        report(folder + " is listed with " + target + ", but includes nothing of it");
      }
    }
  }
  for (const std::string& shared : rule.shared) {
    const bool any = std::ranges::any_of(used, [&](const auto& arrows) {
      return !arrows.first.starts_with("common/") && arrows.second.contains(shared);
    });
    if (!any) report("edge and ground may include " + shared + ", but neither does");
  }
  for (const auto& [prefix, home] : rule.sdk_homes) {
    if (!IncludesAny(files, home, prefix))
      report(home + " is the home of <" + prefix + "...>, but does not include it");
  }
  if (!rule.sdk_homes.empty() && !folders.contains(kPeers))
    report(std::string(kPeers) + " may include the middleware, but there is no such folder");
  return violations;
}

}  // namespace isotherm::lint
