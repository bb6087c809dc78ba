#include "edge/spool/recording_listing.h"

#include <algorithm>
#include <charconv>
#include <functional>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

namespace isotherm {
namespace {

/// Returns whether `name` is one that RecordingPath makes.
bool IsOwnName(std::string_view name) {
  constexpr std::string_view kForm = "edge-00000000-000000-ffffffff";
  const auto fits = [](char form, char c) {
    const bool is_digit = c >= '0' && c <= '9';
    if (form == '0') return is_digit;
    return form == 'f' ? is_digit || (c >= 'a' && c <= 'f') : form == c;
  };
  return name.size() == kForm.size() && std::equal(kForm.begin(), kForm.end(), name.begin(), fits);
}

/// Returns the number of the part that a name ends with ("scan-2"), and cuts it off; 1: none.
int TakePart(std::string_view& name, std::size_t max_digits) {
  const std::size_t dash = name.rfind('-');
  if (dash == std::string_view::npos || name.size() - dash - 1 > max_digits) return 1;
  int part = 0;
  const char* const end = name.data() + name.size();
  const auto [at, error] = std::from_chars(name.data() + dash + 1, end, part);
  if (error != std::errc() || at != end || part < 2) return 1;
  name = name.substr(0, dash);
  return part;
}

/// Returns what a file name means; nullopt: none. Of a recording with a name of its own, `stem` is
/// that name; empty: any that RecordingPath makes.
std::optional<ListedRecording> Parse(const std::filesystem::path& path, const std::string& stem) {
  const std::string name = path.stem().string();
  const auto is_base = [&stem](std::string_view base) {
    return stem.empty() ? IsOwnName(base) : base == stem;
  };
  std::string_view base = name;
  // At a file a second, 9 digits last for thirty years; a name that somebody gave may end in a
  // date.
  const int part = is_base(base) ? 1 : TakePart(base, stem.empty() ? 9 : 6);
  if (!is_base(base)) return std::nullopt;
  const std::string first = std::string(base) + path.extension().string();
  return ListedRecording{path, path.parent_path() / first, part, {}};
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
  std::ranges::sort(found, {}, &ListedRecording::path);
  std::ranges::stable_sort(found, std::greater(), &ListedRecording::written);
  return found;
}

}  // namespace isotherm
