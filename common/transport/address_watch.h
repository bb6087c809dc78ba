#pragma once

#include <optional>
#include <string>
#include <utility>

#include "common/time/time_types.h"

namespace isotherm {

/// Notices that this computer has moved in its network since it joined that: its addresses are
/// others, and nobody is heard any more, because packets go where it was. Thread-compatible.
class AddressWatch {
 public:
  /// Both must last for so long. Smaller: an interface that is back in a moment costs a link.
  static constexpr Nanoseconds kSilence = std::chrono::seconds(4);

  /// `joined` are the addresses (NetworkAddresses) of before the network was joined.
  explicit AddressWatch(std::string joined) : joined_(std::move(joined)) {}

  /// `addresses` as they are now; the other side has not been heard for `silent_for`.
  bool HasMoved(const std::string& addresses, Nanoseconds silent_for, SteadyTime now) {
    if (addresses == joined_) {
      differs_since_.reset();
      return false;
    }
    if (!differs_since_) differs_since_ = now;
    if (addresses.empty()) return false;  // There is nothing to join.
    return now - *differs_since_ >= kSilence && silent_for >= kSilence;
  }

 private:
  std::string joined_;
  std::optional<SteadyTime> differs_since_;
};

}  // namespace isotherm
