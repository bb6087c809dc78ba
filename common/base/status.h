#pragma once

#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>

namespace isotherm {

/// Says what kind of failure it was. The message says what failed, with which numbers, and what to
/// do about it.
enum class StatusCode {
  kOk,
  kInvalidArgument,     ///< An argument, option or configuration is wrong.
  kNotFound,            ///< A file, stream or device does not exist.
  kDataLoss,            ///< Content is corrupt, truncated or inconsistent.
  kFailedPrecondition,  ///< The operation needs something that is not there (calibration, tracking,
                        ///< ...).
  kResourceExhausted,   ///< Memory, disk or a configured limit.
  kUnavailable,         ///< A device, peer or service does not answer; trying again may help.
  kIoError,             ///< Reading or writing failed.
  kInternal,            ///< A library failed in a way that should not happen.
};

/// Name of the code as it is shown to users, e.g. "not found".
std::string_view ToString(StatusCode code);

/// The result of an operation without a value. Thread-compatible.
class [[nodiscard]] Status {
 public:
  Status() = default;
  Status(StatusCode code, std::string message) : code_(code), message_(std::move(message)) {}

  bool ok() const { return code_ == StatusCode::kOk; }
  StatusCode code() const { return code_; }
  const std::string& message() const { return message_; }

  /// The same failure with `context` in front: "context: message".
  Status WithContext(std::string_view context) const;

 private:
  StatusCode code_ = StatusCode::kOk;
  std::string message_;
};

inline Status OkStatus() { return {}; }
Status InvalidArgument(std::string message);
Status NotFound(std::string message);
Status DataLoss(std::string message);
Status FailedPrecondition(std::string message);
Status ResourceExhausted(std::string message);
Status Unavailable(std::string message);
Status IoError(std::string message);
Status Internal(std::string message);

/// A value or the reason why there is none.
template <typename T>
using Result = tl::expected<T, Status>;

/// Turns a Status into the error side of a Result: `return Err(NotFound("..."));`.
inline tl::unexpected<Status> Err(Status status) {
  return tl::unexpected<Status>(std::move(status));
}

/// Process exit status for `status`, following sysexits.h: 0 ok, 64 usage, 65 bad data, 66 no
/// input, 69 unavailable, 70 internal, 73 cannot create output, 74 I/O error, 78 configuration.
int ExitCode(const Status& status);

/// Exit statuses used directly by the programs.
inline constexpr int kExitUsage = 64;
inline constexpr int kExitConfiguration = 78;

}  // namespace isotherm

/// Returns the failure of a Status expression to the caller (function returns Status).
#define ISOTHERM_RETURN_IF_ERROR(expression)                                      \
  do {                                                                            \
    if (::isotherm::Status status_ = (expression); !status_.ok()) return status_; \
  } while (false)
