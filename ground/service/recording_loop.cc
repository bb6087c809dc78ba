#include "ground/service/recording_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

#include "common/base/log.h"
#include "ground/export/result_files.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;

// Frames that have stopped coming must not wait in an open chunk: half a second is the most that a
// crash may cost anyway (RecordingOptions::flush_interval).
constexpr Nanoseconds kFlushAfter = 500ms;
// At 5 MB/s a recording grows by 1 MB between two looks, far less than the reserve.
constexpr Nanoseconds kLookInterval = 200ms;
// An open chunk, the index and the footer take no more.
constexpr std::uint64_t kClosingBytes = 5U << 20;
// Kept free in any case: this much, but of a small disk no more than a tenth. The results of a
// large scan take tens of megabytes. Smaller: a scan's results may not fit; larger: recordings end
// early.
constexpr std::uint64_t kMaxReserveBytes = 100U << 20;
constexpr std::uint64_t kReservePart = 10;
constexpr double kMegabyte = 1 << 20;
// As the rig does (spool.expert.warn_s).
constexpr double kWarnBefore_s = 600.0;

void AddCounts(const ScanRecorder& recorder, RecordingProgress& progress) {
  const auto add = [](const RecorderCounts& counts, std::uint64_t& frames,
                      NotRecordedCounts& left_out) {
    frames += counts.recorded;
    left_out[NotRecorded::kDiskFailed] += counts.lost;
    left_out[NotRecorded::kUnwritable] += counts.unwritable;
  };
  add(recorder.counts(Sensor::kDepth), progress.depth_frames, progress.depth_left_out);
  add(recorder.counts(Sensor::kThermal), progress.thermal_frames, progress.thermal_left_out);
}

/// Sets the counts that a recorder keeps; others keep the rest.
void EnterCounts(const ScanRecorder& recorder, RecordingProgress& progress) {
  progress.depth_frames = progress.thermal_frames = 0;
  for (const NotRecorded reason : {NotRecorded::kDiskFailed, NotRecorded::kUnwritable}) {
    progress.depth_left_out[reason] = progress.thermal_left_out[reason] = 0;
  }
  AddCounts(recorder, progress);
}

}  // namespace

void RecordingLoop::Run(RecordingQueue& queue, const std::stop_token& stop) {
  for (;;) {
    std::optional<SessionItem> item;
    const RecordingQueue::Outcome outcome = queue.Pop(kFlushAfter, stop, item);
    progress_.Busy(clock_.SteadyNow());
    if (outcome == RecordingQueue::Outcome::kEnd) break;
    if (outcome == RecordingQueue::Outcome::kItem) {
      std::visit([this](const auto& value) { Handle(value); }, *item);
    } else if (recorder_ && !flushed_) {
      recorder_->Flush();
      if (late_recorder_) late_recorder_->Flush();
      flushed_ = true;
      Enter();
    }
    progress_.Idle();
  }
  End();
  progress_.Idle();
}

void RecordingLoop::Handle(const SessionStart& start) {
  End();
  start_ = start;
  nearly_full_ = has_warned_ = false;
  quota_.emplace(options_.live().quota_gb(),
                 [this] { return FolderSize(options_.live().output_dir()); });
  if (const Status prepared = PrepareOutputDir(start.folder); !prepared.ok()) {
    LOG(Ground, Error) << "this scan's folder cannot be used: " << prepared.message();
  }
  // A folder that another process has taken meanwhile has its files all the same: parts beside.
  if (start.lock) static_cast<void>(start.lock->Take(start.folder));
  if (!options_.live().record() || start.is_complete) return;
  const std::filesystem::path path = start.folder / "scan.mcap";
  start_.recording->Update([&](auto& progress) { progress.path = path; });
  opened_ = clock_.SteadyNow();
  next_look_ = opened_;
  recorder_ = std::make_unique<ScanRecorder>(path, options_, start.rig, clock_);
  LookAtDisk();
  if (!nearly_full_) recorder_->Tend();
  Enter();
}

void RecordingLoop::Handle(const RigDescription& rig) {
  start_.rig = rig;
  if (recorder_) recorder_->Write(rig);
  if (late_recorder_) late_recorder_->Write(rig);
}

template <typename Frame>
void RecordingLoop::HandleFrame(const Frame& frame, Sensor sensor) {
  if (!recorder_) return;
  LookAtDisk();
  if (nearly_full_) {
    start_.recording->CountLeftOut(sensor, NotRecorded::kDiskNearlyFull);
  } else {
    RecorderOf(frame.is_late).Write(frame);
    flushed_ = false;
  }
  Enter();
}

ScanRecorder& RecordingLoop::RecorderOf(bool is_late) {
  if (!is_late) return *recorder_;
  if (!late_recorder_) {
    late_recorder_ = std::make_unique<ScanRecorder>(start_.folder / "scan-late.mcap", options_,
                                                    start_.rig, clock_);
  }
  return *late_recorder_;
}

void RecordingLoop::Handle(const Feedback& feedback) {
  // The reconstruction may be behind, and still speak of the session before.
  if (recorder_ && feedback.session == start_.rig.session) recorder_->Write(feedback);
}

void RecordingLoop::Handle(const SessionClock& clock) {
  if (recorder_ && clock.session == start_.rig.session) recorder_->Write(clock);
}

void RecordingLoop::Handle(const SessionMark& mark) {
  if (recorder_ && mark.session == start_.rig.session) recorder_->Write(mark.mark);
}

void RecordingLoop::Handle(const ExternalOdometrySample& sample) {
  if (recorder_) recorder_->Write(sample);
}

std::uint64_t RecordingLoop::QuotaReserveBytes() const {
  // The estimate is rough, and the model grows on.
  const std::uint64_t expected = board_.result_bytes;
  return kClosingBytes + expected + expected / 2;
}

std::uint64_t RecordingLoop::ReserveBytes(std::uint64_t capacity) const {
  return std::max(QuotaReserveBytes(),
                  kClosingBytes + std::min(kMaxReserveBytes, capacity / kReservePart));
}

std::optional<std::filesystem::space_info> RecordingLoop::SpaceOfDisk(
    const std::filesystem::path& folder) {
  std::error_code error;
  const std::filesystem::space_info space = std::filesystem::space(folder, error);
  return error ? std::nullopt : std::optional(space);
}

void RecordingLoop::LookAtDisk() {
  const SteadyTime now = clock_.SteadyNow();
  if (now < next_look_) return;
  next_look_ = now + kLookInterval;
  const std::optional<std::filesystem::space_info> space = look_at_space_(start_.folder);
  if (!space) return;  // Writing will say what is wrong.
  const std::uint64_t of_quota = quota_->Left(now, start_.recording->Get().bytes);
  const auto above = [](std::uint64_t bytes, std::uint64_t reserve) {
    return bytes - std::min(bytes, reserve);
  };
  is_quota_first_ =
      above(of_quota, QuotaReserveBytes()) < above(space->available, ReserveBytes(space->capacity));
  const std::uint64_t free_bytes = is_quota_first_ ? of_quota : space->available;
  const std::uint64_t reserve =
      is_quota_first_ ? QuotaReserveBytes() : ReserveBytes(space->capacity);
  const double elapsed_s = ToSeconds(now - opened_);
  start_.recording->Update([&](auto& progress) {
    progress.free_bytes = free_bytes;
    progress.reserve_bytes = reserve;
    // The first seconds hold metadata and half-filled chunks: their rate would tell a wrong time
    // until the disk is full.
    constexpr double kTooShort_s = 3.0;
    if (elapsed_s > kTooShort_s)
      progress.bytes_per_s = static_cast<double>(progress.bytes) / elapsed_s;
  });
  const bool before =
      // Twice the reserve must be free before it goes on, so that it does not begin and end at the
      // limit.
      std::exchange(nearly_full_, free_bytes <= (nearly_full_ ? 2 * reserve : reserve));
  WarnInTime();
  if (nearly_full_ && !before) StopForReserve(space->available, reserve);
  if (before && !nearly_full_) {
    LOG(Ground, Warning) << "there is room on the disk again, the recording goes on; "
                            "frames not recorded="
                         << start_.recording->Get().left_out(NotRecorded::kDiskNearlyFull);
  }
}

std::optional<std::uint64_t> RecordingLoop::FolderSize(const std::filesystem::path& folder) {
  using std::filesystem::recursive_directory_iterator;
  std::uint64_t bytes = 0;
  std::error_code error;
  recursive_directory_iterator entry(
      folder, std::filesystem::directory_options::skip_permission_denied, error);
  for (; !error && entry != recursive_directory_iterator(); entry.increment(error)) {
    std::error_code ignored;
    if (!entry->is_regular_file(ignored) || entry->is_symlink(ignored)) continue;
    const std::uintmax_t size = entry->file_size(ignored);
    if (!ignored) bytes += size;
  }
  return error ? std::nullopt : std::optional(bytes);
}

void RecordingLoop::WarnInTime() {
  const double left_s = start_.recording->Get().left_s();
  if (has_warned_ || nearly_full_ || !(left_s < kWarnBefore_s)) return;
  has_warned_ = true;
  LOG(Ground, Warning) << (is_quota_first_ ? "the quota (live.quota_gb) is used up in "
                                           : "the disk is full in ")
                       << std::lround(left_s / 60.0)
                       << " min, then the recording ends: free some space, or end the scan in time";
}

void RecordingLoop::StopForReserve(std::uint64_t free_bytes, std::uint64_t reserve_bytes) {
  const auto& files = recorder_->files();
  const std::string cause =
      is_quota_first_
          ? fmt::format("all that is in {} takes its {:g} GB (live.quota_gb) with the results",
                        options_.live().output_dir(), options_.live().quota_gb())
          : fmt::format(
                "only {:.0f} MB are free on the disk and {:.0f} MB are kept for the results",
                static_cast<double>(free_bytes) / kMegabyte,
                static_cast<double>(reserve_bytes) / kMegabyte);
  const Status why = ResourceExhausted(
      fmt::format("the recording {} stops here, because {}; the scan goes on. Free some space",
                  (files.empty() ? start_.folder / "scan.mcap" : files.back()).string(), cause));
  recorder_->EndFile(why);
  if (late_recorder_) late_recorder_->EndFile(why);
  LOG(Ground, Warning) << why.message();
}

void RecordingLoop::Enter() {
  start_.recording->Update([&](auto& progress) {
    progress.files = recorder_->files();
    progress.bytes = recorder_->bytes();
    EnterCounts(*recorder_, progress);
    progress.paused = !recorder_->is_recording();
    progress.status = recorder_->status();
    progress.disk_error = recorder_->disk_error();
    if (!late_recorder_) return;
    const std::uint64_t in_order = progress.depth_frames + progress.thermal_frames;
    progress.late_files = late_recorder_->files();
    progress.bytes += late_recorder_->bytes();
    AddCounts(*late_recorder_, progress);
    progress.late_frames = progress.depth_frames + progress.thermal_frames - in_order;
    if (progress.status.ok()) progress.status = late_recorder_->status();
    if (progress.disk_error.ok()) progress.disk_error = late_recorder_->disk_error();
  });
}

void RecordingLoop::End() {
  if (recorder_) {
    if (late_recorder_) {
      if (const Status closed = late_recorder_->Close(); !closed.ok()) status_ = closed;
    }
    if (const Status closed = recorder_->Close(); !closed.ok()) status_ = closed;
    Enter();
    recorder_.reset();
    late_recorder_.reset();
  }
  if (start_.recording) {
    start_.recording->Update([](auto& progress) {
      progress.closed = true;
      progress.paused = false;
    });
  }
  start_.recording.reset();
}

}  // namespace isotherm
