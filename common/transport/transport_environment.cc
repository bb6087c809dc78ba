#include "common/transport/transport_environment.h"

#include <dds/ddsrt/log.h>
#include <malloc.h>

#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>

#include "common/base/log.h"
#include "common/base/mutex.h"
#include "common/time/text_limiter.h"

namespace isotherm {
namespace {

// Blocks below this size come from the heap, which keeps them, instead of from the kernel each
// time.
constexpr int kMmapThresholdBytes = 32 << 20;
// Freed memory at the heap's end goes back to the kernel at once only beyond this, so frames do
// not fault their pages in again. What stays goes back every ten seconds (FreedMemory).
constexpr int kTrimThresholdBytes = 256 << 20;

LogLevel LevelOf(std::uint32_t category) {
  if ((category & (DDS_LC_FATAL | DDS_LC_ERROR)) != 0) return LogLevel::kError;
  if ((category & DDS_LC_WARNING) != 0) return LogLevel::kWarning;
  return LogLevel::kInfo;
}

}  // namespace

/// Userdata of the middleware's log callback, which any of its threads may call.
struct TransportEnvironment::LogSink {
  explicit LogSink(const Clock& the_clock) : clock(the_clock) {}

  static void Write(void* self, const dds_log_data_t* data) {
    static_cast<LogSink*>(self)->Add(*data);
  }

  void Add(const dds_log_data_t& data) {
    std::string_view text(data.message, data.size);
    while (text.ends_with('\n') || text.ends_with('\0')) text.remove_suffix(1);
    std::optional<std::string> line;
    {
      MutexLock lock(mutex);
      if (LevelOf(data.priority) == LogLevel::kError) last_error = text;
      if (is_quiet) return;
      CountRefusal(text);
      line = limiter.Admit(text, clock.SteadyNow());
    }
    if (line) WriteLog(LevelOf(data.priority), "Dds", *line);
  }

  void CountRefusal(std::string_view text) REQUIRES(mutex) {
    const auto says = [text](std::string_view words) {
      return text.find(words) != std::string_view::npos;
    };
    if (says("dropping oversize")) {
      ++refusals.oversize;
    } else if (says("malformed packet") || (says("deserialization") && says("failed"))) {
      ++refusals.malformed;
    }
  }

  void TellWhatWasLeftOut() {
    MutexLock lock(mutex);
    if (const std::uint64_t lines = limiter.untold(); lines > 0) {
      LOG(Dds, Info) << lines << " more lines of these kinds until the end";
    }
  }

  const Clock& clock;
  Mutex mutex;
  MiddlewareRefusals refusals GUARDED_BY(mutex);
  TextLimiter limiter GUARDED_BY(mutex);
  std::string last_error GUARDED_BY(mutex);
  bool is_quiet GUARDED_BY(mutex) = false;
};

TransportEnvironment::Quiet::Quiet(const TransportEnvironment& environment)
    : environment_(environment) {
  MutexLock lock(environment_.sink_->mutex);
  environment_.sink_->is_quiet = true;
}

TransportEnvironment::Quiet::~Quiet() {
  MutexLock lock(environment_.sink_->mutex);
  environment_.sink_->is_quiet = false;
}

TransportEnvironment::TransportEnvironment(const Clock& clock)
    : sink_(std::make_unique<LogSink>(clock)) {
  mallopt(M_MMAP_THRESHOLD, kMmapThresholdBytes);
  mallopt(M_TRIM_THRESHOLD, kTrimThresholdBytes);
  setenv("CYCLONEDDS_URI", DefaultProfile(), /*overwrite=*/0);
  dds_set_log_sink(&LogSink::Write, sink_.get());
}

TransportEnvironment::~TransportEnvironment() {
  dds_set_log_sink(nullptr, nullptr);
  sink_->TellWhatWasLeftOut();
}

std::string TransportEnvironment::last_error() const {
  MutexLock lock(sink_->mutex);
  return sink_->last_error;
}

std::uint64_t TransportEnvironment::suppressed_log_lines() const {
  MutexLock lock(sink_->mutex);
  return sink_->limiter.suppressed();
}

MiddlewareRefusals TransportEnvironment::refused() const {
  MutexLock lock(sink_->mutex);
  return sink_->refusals;
}

}  // namespace isotherm
