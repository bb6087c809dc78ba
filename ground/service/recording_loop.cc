#include "ground/service/recording_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "common/base/log.h"
#include "ground/export/results.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;

// Frames that have stopped coming must not wait in an open chunk.
constexpr Nanoseconds kFlushAfter = 500ms;
constexpr Nanoseconds kLookInterval = 200ms;
// What is in an open chunk, the index and the footer.
constexpr std::uint64_t kClosingBytes = 5U << 20;
// Kept free in any case: so much, but of a small disk no more than this part.
constexpr std::uint64_t kMaxReserveBytes = 100U << 20;
constexpr std::uint64_t kReservePart = 10;
constexpr double kMegabyte = 1 << 20;

}  // namespace

void RecordingLoop::Run(RecordingQueue& queue, const std::stop_token& stop) {
  for (;;) {
    std::optional<Item> item;
    const RecordingQueue::Outcome outcome = queue.Pop(kFlushAfter, stop, item);
    progress_.Busy(clock_.SteadyNow());
    if (outcome == RecordingQueue::Outcome::kEnd) break;
    if (outcome == RecordingQueue::Outcome::kItem) {
      std::visit([this](const auto& value) { Handle(value); }, *item);
    } else if (recorder_ && !flushed_) {
      recorder_->Flush();
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
  nearly_full_ = false;
  if (const Status prepared = PrepareOutputDir(start.folder); !prepared.ok()) {
    LOG(Ground, Error) << "this scan's folder cannot be used: " << prepared.message();
  }
  if (!options_.live().record()) return;
  start_.recording->Update([&](auto& progress) { progress.path = start.folder / "scan.mcap"; });
  opened_ = clock_.SteadyNow();
  next_look_ = opened_;
  if (HasRoom()) Open();
}

void RecordingLoop::Open() {
  Result<std::unique_ptr<ScanRecorder>> recorder =
      ScanRecorder::Create(start_.folder / "scan.mcap", options_);
  if (!recorder) {
    LOG(Ground, Error) << "not recording: " << recorder.error().message();
    Fail(recorder.error());
    return;
  }
  recorder_ = std::move(*recorder);
  recorder_->Write(start_.rig);
}

template <typename Frame>
void RecordingLoop::HandleFrame(const Frame& frame, Sensor sensor) {
  if (!start_.recording) return;
  if (recorder_ && !HasRoom()) StopForReserve();
  if (!recorder_) {
    if (nearly_full_) {
      start_.recording->CountLeftOut(sensor, NotRecorded::kDiskNearlyFull);
    } else {
      start_.recording->Update([](auto& progress) { ++progress.stats.failed; });
    }
    return;
  }
  recorder_->Write(frame);
  flushed_ = false;
  Enter();
}

void RecordingLoop::Handle(const Feedback& feedback) {
  // The reconstruction may be behind, and still speak of the session before.
  if (recorder_ && feedback.session == start_.rig.session) recorder_->Write(feedback);
}

void RecordingLoop::Handle(const SessionClock& clock) {
  if (recorder_ && clock.session == start_.rig.session) recorder_->Write(clock);
}

void RecordingLoop::Handle(const ExternalOdometrySample& sample) {
  if (recorder_) recorder_->Write(sample);
}

std::uint64_t RecordingLoop::ReserveBytes(std::uint64_t capacity) const {
  // The estimate is rough, and the model grows on.
  const std::uint64_t expected = board_.result_bytes;
  return kClosingBytes +
         std::max(expected + expected / 2, std::min(kMaxReserveBytes, capacity / kReservePart));
}

bool RecordingLoop::HasRoom() {
  const SteadyTime now = clock_.SteadyNow();
  if (now < next_look_) return true;
  next_look_ = now + kLookInterval;
  std::error_code error;
  const auto space = std::filesystem::space(start_.folder, error);
  if (error) return true;  // Writing will say what is wrong.
  const std::uint64_t reserve = ReserveBytes(space.capacity);
  const double elapsed_s = ToSeconds(now - opened_);
  start_.recording->Update([&](auto& progress) {
    progress.free_bytes = space.available;
    progress.reserve_bytes = reserve;
    constexpr double kTooShort_s = 3.0;
    if (elapsed_s > kTooShort_s)
      progress.bytes_per_s = static_cast<double>(progress.stats.bytes) / elapsed_s;
  });
  nearly_full_ = space.available <= reserve;
  if (!nearly_full_) return true;
  Fail(ResourceExhausted(fmt::format(
      "the recording {} ends here, because only {:.0f} MB are free on the disk and {:.0f} MB are "
      "kept for the results; the scan goes on. Free some space",
      (start_.folder / "scan.mcap").string(), static_cast<double>(space.available) / kMegabyte,
      static_cast<double>(reserve) / kMegabyte)));
  LOG(Ground, Warning) << status_.message();
  return false;
}

void RecordingLoop::StopForReserve() {
  static_cast<void>(recorder_->Close());
  Enter();
  recorder_.reset();  // What still waits is counted as left out until End().
}

void RecordingLoop::Fail(const Status& status) {
  status_ = status;
  start_.recording->Update([&](auto& progress) {
    if (progress.status.ok()) progress.status = status;
  });
}

void RecordingLoop::Enter() {
  const RecordingStats stats = recorder_->stats();
  start_.recording->Update([&](auto& progress) {
    progress.stats = stats;
    if (progress.status.ok()) progress.status = recorder_->status();
  });
}

void RecordingLoop::End() {
  if (recorder_) {
    if (const Status closed = recorder_->Close(); !closed.ok()) Fail(closed);
    Enter();
    recorder_.reset();
  }
  if (start_.recording) start_.recording->Update([](auto& progress) { progress.closed = true; });
  start_.recording.reset();
}

}  // namespace isotherm
