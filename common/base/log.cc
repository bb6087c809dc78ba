#include "common/base/log.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <atomic>
#include <cstdlib>

namespace isotherm {
namespace {

std::atomic<LogLevel> g_level{LogLevel::kInfo};

// systemd sets JOURNAL_STREAM for services whose standard error is the journal (sd-daemon(3)).
bool WritesToJournal() { return std::getenv("JOURNAL_STREAM") != nullptr; }

spdlog::logger& Sink() {
  static spdlog::logger logger = [] {
    spdlog::logger created("isotherm", std::make_shared<spdlog::sinks::stderr_sink_mt>());
    created.set_pattern("%v");
    created.set_level(spdlog::level::trace);
    created.flush_on(spdlog::level::trace);
    return created;
  }();
  return logger;
}

std::string_view Prefix(LogLevel level) {
  static const bool journal = WritesToJournal();
  switch (level) {
    case LogLevel::kDebug:
      return journal ? "<7>" : "debug ";
    case LogLevel::kInfo:
      return journal ? "<6>" : "";
    case LogLevel::kWarning:
      return journal ? "<4>" : "warning: ";
    case LogLevel::kError:
      return journal ? "<3>" : "error: ";
  }
  return "";
}

}  // namespace

void SetLogLevel(LogLevel level) { g_level = level; }

bool IsLogged(LogLevel level) { return level >= g_level.load(std::memory_order_relaxed); }

void WriteLog(LogLevel level, std::string_view category, std::string_view message) {
  Sink().info("{}{}: {}", Prefix(level), category, message);
}

}  // namespace isotherm
