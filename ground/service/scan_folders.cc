#include "ground/service/scan_folders.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <ctime>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "common/base/log.h"
#include "common/recording/recording_parts.h"
#include "ground/json/json.h"

namespace isotherm {
namespace {

namespace fs = std::filesystem;

/// So many of a session's number; two sessions with the same digits are next to impossible.
constexpr std::size_t kDigits = 8;
constexpr int kHexadecimal = 16;

std::uint32_t EndOfName(std::uint64_t session) { return static_cast<std::uint32_t>(session); }

/// "scan-20260101T120000Z-0123abcd": the number at its end.
std::optional<std::uint32_t> NumberIn(std::string_view name) {
  if (!name.starts_with("scan-") || name.size() <= kDigits ||
      name[name.size() - kDigits - 1] != '-')
    return std::nullopt;
  const std::string_view digits = name.substr(name.size() - kDigits);
  std::uint32_t number = 0;
  const auto [end, error] =
      std::from_chars(digits.data(), digits.data() + digits.size(), number, kHexadecimal);
  if (error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
  return number;
}

/// The place of "scan.mcap", "scan-2.mcap", "scan-late.mcap", "scan-late-2.mcap" among these: if it
/// has what came late, and its part.
using PlaceInScan = std::pair<bool, int>;

std::optional<PlaceInScan> PlaceOf(const fs::path& file) {
  if (file.extension() != ".mcap") return std::nullopt;
  const std::string stem = file.stem().string();
  std::string_view rest = stem;
  if (!rest.starts_with("scan")) return std::nullopt;
  rest.remove_prefix(std::string_view("scan").size());
  PlaceInScan place(false, 1);
  auto& [is_late, part] = place;
  if (constexpr std::string_view kLate = "-late"; rest.starts_with(kLate)) {
    is_late = true;
    rest.remove_prefix(kLate.size());
  }
  if (rest.empty()) return place;
  if (!rest.starts_with('-')) return std::nullopt;
  rest.remove_prefix(1);
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), part);
  if (error != std::errc() || end != rest.data() + rest.size() || part < 2) return std::nullopt;
  return place;
}

std::vector<fs::path> RecordingsIn(const fs::path& folder) {
  std::vector<std::pair<PlaceInScan, fs::path>> found;
  std::error_code error;
  fs::directory_iterator entry(folder, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    std::error_code ignored;
    if (!entry->is_regular_file(ignored)) continue;
    if (const auto place = PlaceOf(entry->path())) found.emplace_back(*place, entry->path());
  }
  std::ranges::sort(found);
  std::vector<fs::path> files;
  for (auto& [place, file] : found) files.push_back(std::move(file));
  return files;
}

/// Removes what a process that was killed has left of putting recordings together.
void RemovePartialFiles(const fs::path& folder) {
  std::vector<fs::path> partial;
  std::error_code error;
  fs::directory_iterator entry(folder, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.starts_with(".scan") && name.ends_with(".partial")) partial.push_back(entry->path());
  }
  for (const fs::path& file : partial) {
    std::error_code ignored;  // One that stays is no harm.
    fs::remove(file, ignored);
  }
}

/// Says whether results tell that this session has ended, and all of it is in one recording.
bool IsComplete(const fs::path& folder, const std::vector<fs::path>& files, std::uint64_t session) {
  if (files.size() != 1) return false;
  const Json stats = Json::parse(std::ifstream(folder / "stats.json"), nullptr, false);
  if (!stats.is_object()) return false;
  const auto is_set = [&stats](const char* name) {
    const Json::json_pointer at(std::string("/link/") + name);
    return stats.contains(at) && stats[at] == true;
  };
  const Json::json_pointer number("/link/session");
  return is_set("final") && is_set("closed") && stats.contains(number) && stats[number] == session;
}

/// Takes a folder of an earlier process, if it has recordings and no other process has it.
std::optional<ScanFolder> TakeUp(const fs::path& path, std::uint64_t session) {
  ScanFolder folder{
      .path = path, .earlier_files = RecordingsIn(path), .lock = std::make_shared<FolderLock>()};
  if (folder.earlier_files.empty()) return std::nullopt;
  if (!folder.lock->Take(path) || std::ranges::any_of(folder.earlier_files, IsBeingWritten)) {
    LOG(Ground, Warning) << "another process has " << path.string()
                         << ": this one does not go on with the scan there";
    return std::nullopt;
  }
  RemovePartialFiles(path);
  folder.is_complete = IsComplete(path, folder.earlier_files, session);
  return folder;
}

}  // namespace

ScanFolders::ScanFolders(const GroundOptions& options, bool single_scan)
    : base_(options.live().output_dir()),
      single_scan_(single_scan),
      resumes_(options.live().record() && options.live().expert().resume()) {}

void ScanFolders::Look() {
  std::error_code error;
  fs::directory_iterator entry(base_, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    std::error_code ignored;
    if (!entry->is_directory(ignored)) continue;
    if (const auto number = NumberIn(entry->path().filename().string()))
      earlier_[*number].push_back(entry->path());
  }
  // Names begin with the time.
  for (auto& [number, folders] : earlier_) std::ranges::sort(folders, std::greater());
}

std::optional<ScanFolder> ScanFolders::FindEarlier(std::uint64_t session) {
  const bool is_first = !std::exchange(has_looked_, true);
  if (!resumes_) return std::nullopt;
  if (single_scan_) return is_first ? TakeUp(base_, session) : std::nullopt;
  if (is_first) Look();
  const auto folders = earlier_.extract(EndOfName(session));
  if (!folders) return std::nullopt;
  for (const fs::path& path : folders.mapped()) {
    if (std::optional<ScanFolder> folder = TakeUp(path, session)) return folder;
  }
  return std::nullopt;
}

ScanFolder ScanFolders::Begin(std::uint64_t session, CaptureTime now) {
  if (std::optional<ScanFolder> earlier = FindEarlier(session)) return std::move(*earlier);
  ScanFolder folder{.path = base_, .lock = std::make_shared<FolderLock>()};
  if (single_scan_) return folder;
  const std::time_t seconds = ToNanoseconds(now) / 1'000'000'000;
  folder.path = base_ / fmt::format("scan-{:%Y%m%dT%H%M%SZ}-{:08x}", fmt::gmtime(seconds),
                                    EndOfName(session));
  return folder;
}

}  // namespace isotherm
