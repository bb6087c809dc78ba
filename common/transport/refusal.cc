#include "common/transport/refusal.h"

#include <numeric>
#include <optional>

#include "common/base/log.h"
#include "common/time/clock.h"

namespace isotherm {

std::string_view ToString(RefusalCause cause) {
  switch (cause) {
    case RefusalCause::kIncomplete:
      return "members are missing";
    case RefusalCause::kOversizePayload:
      return "oversize payload";
    case RefusalCause::kEmptyPayload:
      return "empty payload";
    case RefusalCause::kImpossibleSize:
      return "impossible image size";
    case RefusalCause::kUnknownEncoding:
      return "unknown encoding";
    case RefusalCause::kUnknownValue:
      return "unknown enumeration value";
    case RefusalCause::kNotFinite:
      return "number is not finite";
    case RefusalCause::kOutOfRange:
      return "number out of range";
    case RefusalCause::kNegativeTime:
      return "negative time";
    case RefusalCause::kImpossibleNumber:
      return "impossible frame number";
    case RefusalCause::kOtherSession:
      return "session is over";
    case RefusalCause::kUndecodable:
      return "payload does not decode";
    case RefusalCause::kOtherVersion:
      return "other wire version";
    case RefusalCause::kOtherWriter:
      return "another process of the same name";
    case RefusalCause::kUnannounced:
      return "session was not announced";
    case RefusalCause::kImplausibleTime:
      return "implausible capture time";
    case RefusalCause::kNotTheGround:
      return "not from a ground station";
    case RefusalCause::kTooManyNames:
      return "too many names from one sender";
    case RefusalCause::kCount:
      break;
  }
  return "unknown cause";
}

void RefusalCounter::Add(RefusalCause cause, std::string_view detail) {
  const auto index = static_cast<std::size_t>(cause);
  std::optional<std::uint64_t> left_out;
  {
    MutexLock lock(mutex_);
    ++counts_.at(index);
    if (whole_ == nullptr) left_out = limiters_.at(index).Admit(SystemClock().SteadyNow());
  }
  if (whole_ != nullptr) return whole_->Add(cause, detail);
  if (!left_out) return;
  LOG(Transport, Warning) << "sample refused: " << ToString(cause) << " (" << detail << ")"
                          << LeftOutText(*left_out);
}

RefusalCounts RefusalCounter::counts() const {
  MutexLock lock(mutex_);
  return counts_;
}

std::uint64_t RefusalCounter::count(RefusalCause cause) const {
  MutexLock lock(mutex_);
  return counts_.at(static_cast<std::size_t>(cause));
}

std::uint64_t RefusalCounter::total() const {
  MutexLock lock(mutex_);
  return std::accumulate(counts_.begin(), counts_.end(), std::uint64_t{0});
}

}  // namespace isotherm
