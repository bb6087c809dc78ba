#include "common/transport/transport_environment.h"

#include <dds/ddsrt/log.h>
#include <malloc.h>

#include <cstdlib>
#include <mutex>
#include <string_view>

#include "common/base/log.h"
#include "common/transport/line_limiter.h"

namespace isotherm {
namespace {

// Blocks below this size come from the heap, which keeps them, instead of from the kernel each
// time.
constexpr int kMmapThresholdBytes = 32 << 20;
constexpr int kTrimThresholdBytes = 256 << 20;

constexpr int kMaxLogLinesPerSecond = 10;

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
    {
      std::scoped_lock lock(mutex);
      if (!limiter.Admit(clock.SteadyNow())) return;
    }
    WriteLog(LevelOf(data.priority), "Dds", text);
  }

  const Clock& clock;
  std::mutex mutex;
  LineLimiter limiter{kMaxLogLinesPerSecond};
};

TransportEnvironment::TransportEnvironment(const Clock& clock)
    : sink_(std::make_unique<LogSink>(clock)) {
  mallopt(M_MMAP_THRESHOLD, kMmapThresholdBytes);
  mallopt(M_TRIM_THRESHOLD, kTrimThresholdBytes);
  setenv("CYCLONEDDS_URI", DefaultProfile(), /*overwrite=*/0);
  dds_set_log_sink(&LogSink::Write, sink_.get());
}

TransportEnvironment::~TransportEnvironment() { dds_set_log_sink(nullptr, nullptr); }

std::uint64_t TransportEnvironment::suppressed_log_lines() const {
  std::scoped_lock lock(sink_->mutex);
  return sink_->limiter.suppressed();
}

}  // namespace isotherm
