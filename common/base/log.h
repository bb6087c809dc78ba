#pragma once

#include <sstream>
#include <string_view>

namespace isotherm {

/// Orders lines by how much they matter; the journal gets them as its levels debug, info, warning
/// and err.
enum class LogLevel { kDebug, kInfo, kWarning, kError };

/// Least severe level that is written. Default: kInfo. Thread-safe.
void SetLogLevel(LogLevel level);
bool IsLogged(LogLevel level);

/// Writes one line to standard error: `category: message`, with the journal's level prefix (`<4>`)
/// if standard error is the journal and with a plain level word otherwise. Thread-safe.
void WriteLog(LogLevel level, std::string_view category, std::string_view message);

/// Collects one line and writes it at the end of the full expression. Use LOG().
class LogLine {
 public:
  LogLine(LogLevel level, std::string_view category) : level_(level), category_(category) {}
  LogLine(const LogLine&) = delete;
  LogLine& operator=(const LogLine&) = delete;
  ~LogLine() { WriteLog(level_, category_, stream_.view()); }
  std::ostream& stream() { return stream_; }

 private:
  LogLevel level_;
  std::string_view category_;
  std::ostringstream stream_;
};

}  // namespace isotherm

/// LOG(Nuc, Warning) << "shutter did not open, closed_for_s=" << s;
/// The category is the folder's name; numbers go into a key=value tail with units in the key.
#define LOG(category, level)                                   \
  if (!::isotherm::IsLogged(::isotherm::LogLevel::k##level)) { \
  } else                                                       \
    ::isotherm::LogLine(::isotherm::LogLevel::k##level, #category).stream()
