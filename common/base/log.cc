#include "common/base/log.h"

#include <fmt/format.h>

#include <atomic>
#include <cstdlib>

#include "common/base/printable.h"
#include "common/base/standard_error.h"

namespace isotherm {
namespace {

std::atomic<LogLevel> g_level{LogLevel::kInfo};

// systemd sets JOURNAL_STREAM for services whose standard error is the journal (sd-daemon(3)).
bool WritesToJournal() { return std::getenv("JOURNAL_STREAM") != nullptr; }

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
  if (const std::uint64_t left_out = TakeLeftOutOfStandardError(); left_out > 0) {
    WriteStandardError(
        fmt::format("{}Log: nobody read standard error for a while, lines left out={}\n",
                    Prefix(LogLevel::kWarning), left_out));
  }
  WriteStandardError(fmt::format("{}{}: {}\n", Prefix(level), category, PrintableLines(message)));
}

}  // namespace isotherm
