#include "edge/spool/recording_listing.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <regex>
#include <system_error>
#include <utility>

namespace isotherm {
namespace {

/// Returns what a file name means; nullopt: none. Of a recording with a name of its
/// own, `stem` is that name; empty: any that RecordingPath makes.
std::optional<ListedRecording> Parse(const std::filesystem::path& path, const std::string& stem) {
  static const std::regex kOwn(R"((edge-\d{8}-\d{6}-[0-9a-f]{8})(?:-(\d{1,6}))?)");
  static const std::regex kNumbered(R"((.*)-(\d{1,6}))");
  const std::string name = path.stem().string();
  std::smatch match;
  std::string base = name;
  int part = 1;
  if (stem.empty()) {
    if (!std::regex_match(name, match, kOwn)) return std::nullopt;
  } else if (name != stem && (!std::regex_match(name, match, kNumbered) || match[1] != stem)) {
    return std::nullopt;
  }
  if (!match.empty()) {
    base = match[1];
    if (match[2].matched) part = std::stoi(match[2]);
  }
  return ListedRecording{path, path.parent_path() / (base + path.extension().string()), part, {}};
}

}  // namespace

std::vector<ListedRecording> ListRecordings(const std::filesystem::path& record) {
  if (record == "off") return {};
  std::error_code error;
  const bool is_file = record.has_filename() && !std::filesystem::is_directory(record, error);
  std::filesystem::path folder = is_file ? record.parent_path() : record;
  if (folder.empty()) folder = ".";
  const std::string stem = is_file ? record.stem().string() : "";
  const std::string extension = is_file ? record.extension().string() : ".mcap";
  std::vector<ListedRecording> found;
  std::filesystem::directory_iterator entry(folder, error);
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    std::error_code ignored;
    if (entry->path().extension() != extension || !entry->is_regular_file(ignored) ||
        entry->is_symlink(ignored)) {
      continue;
    }
    std::optional<ListedRecording> listed = Parse(entry->path(), stem);
    if (!listed) continue;
    listed->written = entry->last_write_time(ignored);
    if (!ignored) found.push_back(std::move(*listed));
  }
  std::ranges::sort(found, std::greater(), &ListedRecording::written);
  return found;
}

}  // namespace isotherm
