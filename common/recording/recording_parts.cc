#include "common/recording/recording_parts.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "common/recording/mcap_repair.h"

namespace isotherm {

std::filesystem::path PartPath(const std::filesystem::path& path, int part) {
  if (part <= 1) return path;
  return path.parent_path() /
         fmt::format("{}-{}{}", path.stem().string(), part, path.extension().string());
}

int NextFreePart(const std::filesystem::path& path, int part) {
  std::error_code ignored;
  do {
    ++part;
  } while (std::filesystem::exists(PartPath(path, part), ignored));
  return part;
}

bool IsDevice(const std::filesystem::path& path) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(path, ignored);
  return std::filesystem::is_character_file(status) || std::filesystem::is_fifo(status);
}

bool IsBeingWritten(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) return false;
  const bool is_locked = ::flock(file, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(file);
  return is_locked;
}

Result<std::optional<std::uint64_t>> CompleteRecording(const std::filesystem::path& path) {
  return mcap::CompleteFile(path);
}

bool EndsFile(const Status& status) {
  return !status.ok() && status.code() != StatusCode::kInvalidArgument &&
         status.code() != StatusCode::kDataLoss;
}

bool RemoveIfWithoutFrames(const std::filesystem::path& path, const RecordingStats& stats) {
  if (stats.depth_frames + stats.thermal_frames + stats.unsynced > 0) return false;
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored) && std::filesystem::remove(path, ignored);
}

}  // namespace isotherm
