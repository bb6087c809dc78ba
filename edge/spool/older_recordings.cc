#include "edge/spool/older_recordings.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <system_error>
#include <utility>
#include <vector>

#include "common/base/log.h"
#include "common/recording/recording_parts.h"
#include "edge/spool/recording_listing.h"

namespace isotherm {
namespace {

std::filesystem::path MarkOf(const std::filesystem::path& file) {
  return file.string() + ".fetched";
}

/// Returns how many bytes a file has; 0 if nobody can tell.
std::uint64_t SizeOf(const std::filesystem::path& file) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  return error ? 0 : size;
}

/// Returns the recordings that may be deleted, each as its files, the one that was written first
/// first.
std::vector<std::vector<ListedRecording>> FetchedOf(const std::filesystem::path& record,
                                                    const std::filesystem::path& present) {
  std::vector<std::vector<ListedRecording>> recordings;
  for (ListedRecording& file : ListRecordings(record)) {
    if (file.first.filename() == present.filename()) continue;
    const auto known = std::ranges::find_if(
        recordings, [&file](const auto& files) { return files.front().first == file.first; });
    if (known == recordings.end()) {
      recordings.push_back({std::move(file)});
    } else {
      known->push_back(std::move(file));
    }
  }
  std::erase_if(recordings, [](const std::vector<ListedRecording>& files) {
    return !std::ranges::all_of(files, [](const ListedRecording& file) {
      return IsFetched(file.path) && !IsBeingWritten(file.path);
    });
  });
  std::ranges::reverse(recordings);
  return recordings;
}

/// Returns whether it could be deleted.
bool Delete(const std::filesystem::path& file) {
  std::error_code error;
  std::filesystem::remove(file, error);
  if (error) {
    LOG(Spool, Debug) << "cannot delete " << file.string() << ": " << error.message();
    return false;
  }
  std::filesystem::remove(MarkOf(file), error);
  return true;
}

}  // namespace

Status MarkFetched(const std::filesystem::path& file, std::uint64_t size) {
  if (size == 0 || SizeOf(file) != size) {
    return NotFound(fmt::format("there is no {} of {} bytes", file.filename().string(), size));
  }
  const std::filesystem::path mark = MarkOf(file);
  std::ofstream out(mark, std::ios::trunc);
  // The size, so that a file that is completed later counts as another one.
  out << size << '\n';
  out.close();
  return out ? OkStatus() : IoError(fmt::format("cannot write {}", mark.string()));
}

bool IsFetched(const std::filesystem::path& file) {
  std::ifstream in(MarkOf(file));
  std::uint64_t size = 0;
  return (in >> size) && size > 0 && size == SizeOf(file);
}

std::uint64_t RecordingsSize(const std::filesystem::path& record) {
  std::uint64_t bytes = 0;
  for (const ListedRecording& file : ListRecordings(record)) bytes += SizeOf(file.path);
  return bytes;
}

std::uint64_t FetchedSize(const std::filesystem::path& record,
                          const std::filesystem::path& present) {
  std::uint64_t bytes = 0;
  for (const std::vector<ListedRecording>& files : FetchedOf(record, present))
    for (const ListedRecording& file : files) bytes += SizeOf(file.path);
  return bytes;
}

std::optional<DeletedRecording> DeleteOldestFetched(const std::filesystem::path& record,
                                                    const std::filesystem::path& present) {
  for (const std::vector<ListedRecording>& files : FetchedOf(record, present)) {
    DeletedRecording deleted{.name = files.front().first.filename().string()};
    for (const ListedRecording& file : files) {
      const std::uint64_t bytes = SizeOf(file.path);
      if (Delete(file.path)) deleted.bytes += bytes;
    }
    if (deleted.bytes > 0) return deleted;
  }
  return std::nullopt;
}

std::optional<DeletedFile> DeleteOldestFile(const std::filesystem::path& record,
                                            const std::filesystem::path& present) {
  std::vector<ListedRecording> files = ListRecordings(record);
  const auto is_present = [&present](const ListedRecording& file) {
    return file.first.filename() == present.filename();
  };
  const auto own = std::partition(files.begin(), files.end(), std::not_fn(is_present));
  std::sort(files.begin(), own, [](const auto& a, const auto& b) { return a.written < b.written; });
  // Whatever the clock did meanwhile.
  std::sort(own, files.end(), [](const auto& a, const auto& b) { return a.part < b.part; });
  for (const ListedRecording& file : files) {
    if (IsBeingWritten(file.path)) continue;
    const bool was_fetched = IsFetched(file.path);
    if (Delete(file.path)) return DeletedFile{file.path, is_present(file), was_fetched};
  }
  return std::nullopt;
}

}  // namespace isotherm
