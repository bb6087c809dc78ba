#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <system_error>

#include "common/options/text_proto.h"
#include "common/recording/recording.h"
#include "common/rig/rig_calibration.h"
#include "common/simulation/options.h"
#include "common/simulation/render_recording.h"
#include "common/simulation/simulation_options.pb.h"

namespace isotherm {
namespace {

namespace fs = std::filesystem;

/// Raise when the same options give another recording: scenes, sensors, noise, clocks or the file's
/// layout changed.
constexpr int kRenderVersion = 5;

/// FNV-1a.
std::uint64_t Hash(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : text) {
    hash ^= static_cast<std::uint8_t>(c);
    hash *= 0x100000001b3ULL;
  }
  return hash;
}

bool IsComplete(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return false;
  const auto reader = RecordingReader::Open(path);
  return reader && (*reader)->info().complete;
}

constexpr const char* kUnfinished = ".unfinished";

/// Removes what killed runs left behind. A run that is alive writes at least every few seconds, so
/// ten minutes of silence are the end of it.
void RemoveLeftovers(const fs::path& cache_dir) {
  constexpr auto kAbandoned = std::chrono::minutes(10);
  const auto now = fs::file_time_type::clock::now();
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(cache_dir, error)) {
    if (entry.path().extension() != kUnfinished) continue;
    const auto written = entry.last_write_time(error);
    if (!error && now - written > kAbandoned) fs::remove(entry.path(), error);
  }
}

}  // namespace

fs::path DefaultCacheDir() {
  const char* const cache = std::getenv("XDG_CACHE_HOME");
  if (cache != nullptr && *cache != '\0') return fs::path(cache) / "isotherm";
  const char* const home = std::getenv("HOME");
  if (home != nullptr && *home != '\0') return fs::path(home) / ".cache" / "isotherm";
  return fs::temp_directory_path() / "isotherm";
}

Result<std::string> CacheFileName(const SimulationOptions& options) {
  const Result<Rig> rig = SimulatedRig(options);
  if (!rig) return Err(rig.error());
  SimulationOptions content = Resolved(options);
  content.clear_rig_file();  // What counts is what is in it.
  const std::uint64_t hash =
      Hash(fmt::format("{}\n{}\n{}", kRenderVersion, ToTextProto(content), ToText(*rig)));
  return fmt::format("{}-{:g}s-{:016x}.mcap", SceneName(options), options.duration_s(), hash);
}

Result<fs::path> CachedRecording(const SimulationOptions& options, const fs::path& cache_dir,
                                 ThreadPool& pool, const SimulationProgress& progress,
                                 std::stop_token stop) {
  const Result<std::string> name = CacheFileName(options);
  if (!name) return Err(name.error());
  const fs::path path = cache_dir / *name;
  if (IsComplete(path)) return path;

  std::error_code error;
  fs::create_directories(cache_dir, error);
  if (error) {
    return Err(IoError(
        fmt::format("cannot create the cache folder {}: {}", cache_dir.string(), error.message())));
  }
  const fs::path unfinished =
      cache_dir / fmt::format(".{}.{}{}", *name, static_cast<long>(getpid()), kUnfinished);
  RemoveLeftovers(cache_dir);
  fs::remove(unfinished, error);
  Status status =
      RenderRecording(options, unfinished, pool, progress, stop, ImageStorage::kViewable);
  if (status.ok()) {
    fs::rename(unfinished, path, error);
    if (!error) return path;
    status = IoError(fmt::format("cannot rename {} to {}: {}", unfinished.string(), path.string(),
                                 error.message()));
  }
  fs::remove(unfinished, error);
  return Err(status);
}

}  // namespace isotherm
