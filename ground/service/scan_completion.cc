#include "ground/service/scan_completion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "common/base/log.h"
#include "common/base/partial_file.h"
#include "common/base/processor_time.h"
#include "ground/conversion/convert_recording.h"
#include "ground/offline/reconstruct.h"

namespace isotherm {
namespace {

namespace fs = std::filesystem;

/// A model that lacks fewer of its frames is as good as one with them. Not tuned.
constexpr double kNegligible = 0.01;
/// Left free beside the new recording, for results and for a scan that is recorded meanwhile: three
/// minutes of it.
constexpr std::uintmax_t kReserveBytes = 1U << 30;
/// Whatever is live goes first.
constexpr int kNiceness = 10;

/// Both copies are on the disk for a moment.
Status CheckSpace(const std::vector<fs::path>& files) {
  std::uintmax_t needed = kReserveBytes;
  std::error_code error;
  for (const fs::path& file : files) {
    const std::uintmax_t size = fs::file_size(file, error);
    if (error) return NotFound(fmt::format("{}: {}", file.string(), error.message()));
    needed += size;
  }
  const fs::space_info space = fs::space(files.front().parent_path(), error);
  if (error || space.available >= needed) return OkStatus();
  return ResourceExhausted(
      fmt::format("{} MB are free on the disk, {} MB would be needed for a while",
                  space.available >> 20U, needed >> 20U));
}

/// Makes the first of the files one that has all; the others are gone then.
Status MergeFiles(const CompletionRequest& request, const std::vector<fs::path>& files) {
  ISOTHERM_RETURN_IF_ERROR(CheckSpace(files));
  const Result<PartialFile> whole = PartialFile::Create(files.front(), /*overwrite=*/true);
  if (!whole) return whole.error();
  ConvertRequest merge;
  merge.recording = files.front();
  merge.others.assign(files.begin() + 1, files.end());
  merge.output = whole->path();
  merge.storage = request.options.live().expert().record_viewable() ? ImageStorage::kViewable
                                                                    : ImageStorage::kCompact;
  merge.progress = [&request](double) { request.go_on(); };
  merge.stop = request.stop;
  merge.sync = true;
  const Result<ConvertSummary> merged = ConvertRecording(merge);
  if (!merged) return merged.error();
  const std::uint64_t depth = std::max(request.depth_frames, request.recording.depth_frames);
  const std::uint64_t thermal = std::max(request.thermal_frames, request.recording.thermal_frames);
  if (merged->depth_frames < depth || merged->thermal_frames < thermal) {
    return DataLoss(fmt::format("{}: only {} of {} frames can be read back", files.front().string(),
                                merged->depth_frames + merged->thermal_frames, depth + thermal));
  }
  ISOTHERM_RETURN_IF_ERROR(whole->Commit());
  // On the disk, under its name: the parts are superfluous from here on.
  for (const fs::path& file : merge.others) {
    std::error_code ignored;  // One that stays is no harm.
    fs::remove(file, ignored);
  }
  return OkStatus();
}

Result<ReconstructSummary> MakeResultsAnew(const CompletionRequest& request,
                                           const fs::path& recording) {
  ReconstructRequest reconstruct;
  reconstruct.recording = recording;
  reconstruct.output_dir = request.folder;
  reconstruct.options = request.options;
  reconstruct.describe = request.describe;
  reconstruct.stop = request.stop;
  reconstruct.progress = [&request](double, std::string_view) { request.go_on(); };
  return Reconstruct(reconstruct);
}

Result<std::string> Complete(const CompletionRequest& request) {
  const std::vector<fs::path> files = request.recording.AllFiles();
  if (files.size() > 1) {
    if (Status merged = MergeFiles(request, files); !merged.ok()) return Err(std::move(merged));
  }
  const std::uint64_t late = request.recording.late_frames;
  const auto frames =
      static_cast<double>(request.recording.depth_frames + request.recording.thermal_frames);
  if (request.recording.earlier_files.empty() &&
      static_cast<double>(late) <= kNegligible * frames) {
    return fmt::format("complete {} frames came late; {} has them, the results do without\n", late,
                       files.front().string());
  }
  const Result<ReconstructSummary> made = MakeResultsAnew(request, files.front());
  if (!made) {
    return Err(made.error().WithContext(
        fmt::format("{} is complete, the results are not made anew (isotherm reconstruct does it)",
                    files.front().string())));
  }
  const char* parts = request.recording.earlier_files.empty()
                          ? ""
                          : ", and others were recorded before this program was started";
  return made->text +
         fmt::format("complete {} frames came late{}: {} and these results have them\n", late,
                     parts, files.front().string());
}

}  // namespace

bool NeedsCompletion(const GroundOptions& options, const RecordingProgress& recording) {
  if (!options.live().expert().complete() || !recording.closed || !recording.is_in_parts())
    return false;
  const std::size_t files = recording.AllFiles().size();
  return files > 1 || (files == 1 && !recording.is_earlier_in_model && recording.late_frames == 0);
}

Result<std::string> CompleteScan(const CompletionRequest& request) {
  std::optional<Result<std::string>> completed;
  // On a thread of its own: a priority that was lowered cannot be raised again, and the threads of
  // the reconstruction inherit it.
  std::jthread([&] {
    NameThread("complete");
    LowerThreadPriority(kNiceness);
    completed = Complete(request);
  }).join();
  return std::move(*completed);
}

}  // namespace isotherm
