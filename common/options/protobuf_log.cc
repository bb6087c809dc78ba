#include "common/options/protobuf_log.h"

#include <google/protobuf/stubs/logging.h>

#include <optional>
#include <string>

#include "common/base/log.h"
#include "common/base/mutex.h"
#include "common/time/clock.h"
#include "common/time/line_limiter.h"

namespace isotherm {
namespace {

LogLevel LevelOf(google::protobuf::LogLevel level) {
  if (level == google::protobuf::LOGLEVEL_INFO) return LogLevel::kInfo;
  return level == google::protobuf::LOGLEVEL_WARNING ? LogLevel::kWarning : LogLevel::kError;
}

/// The library's handler is a plain function: what it needs must be static.
void Handle(google::protobuf::LogLevel level, const char* /*filename*/, int /*line*/,
            const std::string& message) {
  static Mutex mutex;
  static LineLimiter limiter GUARDED_BY(mutex);
  std::optional<std::uint64_t> left_out;
  {
    MutexLock lock(mutex);
    left_out = limiter.Admit(SystemClock().SteadyNow());
  }
  if (left_out) WriteLog(LevelOf(level), "Protobuf", message + LeftOutText(*left_out));
}

}  // namespace

void LimitProtobufLog() { google::protobuf::SetLogHandler(&Handle); }

}  // namespace isotherm
