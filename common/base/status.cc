#include "common/base/status.h"

namespace isotherm {

std::string_view ToString(StatusCode code) {
  switch (code) {
    case StatusCode::kOk:
      return "ok";
    case StatusCode::kInvalidArgument:
      return "invalid argument";
    case StatusCode::kNotFound:
      return "not found";
    case StatusCode::kDataLoss:
      return "bad data";
    case StatusCode::kFailedPrecondition:
      return "not possible";
    case StatusCode::kResourceExhausted:
      return "limit reached";
    case StatusCode::kUnavailable:
      return "unavailable";
    case StatusCode::kIoError:
      return "input/output error";
    case StatusCode::kInternal:
      return "internal error";
  }
  return "unknown";
}

Status Status::WithContext(std::string_view context) const {
  if (ok()) return *this;
  return {code_, std::string(context) + ": " + message_};
}

Status InvalidArgument(std::string message) {
  return {StatusCode::kInvalidArgument, std::move(message)};
}
Status NotFound(std::string message) { return {StatusCode::kNotFound, std::move(message)}; }
Status DataLoss(std::string message) { return {StatusCode::kDataLoss, std::move(message)}; }
Status FailedPrecondition(std::string message) {
  return {StatusCode::kFailedPrecondition, std::move(message)};
}
Status ResourceExhausted(std::string message) {
  return {StatusCode::kResourceExhausted, std::move(message)};
}
Status Unavailable(std::string message) { return {StatusCode::kUnavailable, std::move(message)}; }
Status IoError(std::string message) { return {StatusCode::kIoError, std::move(message)}; }
Status Internal(std::string message) { return {StatusCode::kInternal, std::move(message)}; }

int ExitCode(const Status& status) {
  switch (status.code()) {
    case StatusCode::kOk:
      return 0;
    case StatusCode::kInvalidArgument:
      // Numbers of sysexits.h; docs/architecture.md lists what they mean here.
      return 64;
    case StatusCode::kNotFound:
      return 66;
    case StatusCode::kDataLoss:
    case StatusCode::kFailedPrecondition:
      return 65;
    case StatusCode::kResourceExhausted:
      return 73;
    case StatusCode::kUnavailable:
      return 69;
    case StatusCode::kIoError:
      return 74;
    case StatusCode::kInternal:
      return 70;
  }
  return 70;
}

}  // namespace isotherm
