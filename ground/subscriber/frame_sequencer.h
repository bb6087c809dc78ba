#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>

#include "common/messages/frame_number_set.h"
#include "common/time/time_types.h"

namespace isotherm {

/// Puts the frames of one stream of one session into the order of their numbers, drops duplicates
/// and waits for a missing frame no longer than the reorder window. Pure: time enters through
/// arguments. Memory is bounded by kMaxWaiting. Thread-compatible.
template <typename T>
class FrameSequencer {
 public:
  /// Says how an arriving frame lies to those before it.
  enum class ArrivalOrder {
    kInOrder,    ///< Goes (or went) into the line.
    kLate,       ///< New, but the line has passed its place.
    kDuplicate,  ///< Was here before.
  };

  /// Frames that may wait for a missing one; beyond, the missing one is given up at once.
  static constexpr std::size_t kMaxWaiting = 64;

  explicit FrameSequencer(Nanoseconds window) : window_(window) {}

  /// Returns what would become of `number`.
  ArrivalOrder Check(std::uint64_t number) const {
    if (!receipts_.IsNew(number)) return ArrivalOrder::kDuplicate;
    if (number < handled_) return ArrivalOrder::kLate;
    return ArrivalOrder::kInOrder;
  }

  /// Takes `item` if the order is kInOrder; leaves it to the caller otherwise.
  ArrivalOrder Add(std::uint64_t number, T&& item, SteadyTime now) {
    const ArrivalOrder order = Check(number);
    if (order == ArrivalOrder::kInOrder || order == ArrivalOrder::kLate) receipts_.Add(number);
    if (order == ArrivalOrder::kInOrder) waiting_.emplace(number, Waiting{std::move(item), now});
    return order;
  }

  /// Enters a frame that is here already: another copy is a duplicate, and those before it are
  /// late. Returns whether it is new.
  bool AddKnown(std::uint64_t number) {
    if (waiting_.empty()) handled_ = std::max(handled_, number + 1);
    return receipts_.Add(number);
  }

  /// The next frame in line, if it is time for it. Call until nullopt.
  std::optional<T> Next(SteadyTime now) {
    if (waiting_.empty()) return std::nullopt;
    const bool is_next = waiting_.begin()->first == handled_;
    if (!is_next && waiting_.size() <= kMaxWaiting && now < *deadline()) return std::nullopt;
    return Pop();
  }
  /// The next frame in line, whatever is missing before it.
  std::optional<T> Flush() {
    if (waiting_.empty()) return std::nullopt;
    return Pop();
  }

  /// The numbers go on at `number`, above or below. What waits must have been flushed.
  void Resync(std::uint64_t number) { handled_ = number; }

  /// Returns when the first missing frame is given up; nullopt if nothing waits.
  std::optional<SteadyTime> deadline() const {
    if (waiting_.empty()) return std::nullopt;
    const auto first = std::ranges::min_element(
        waiting_, {}, [](const auto& item) { return item.second.arrival; });
    return first->second.arrival + window_;
  }
  /// All numbers below are delivered or given up.
  std::uint64_t handled() const { return handled_; }
  const FrameNumberSet& receipts() const { return receipts_; }
  /// Returns how many frames wait.
  std::size_t waiting() const { return waiting_.size(); }

 private:
  /// Holds a frame that came before an earlier one.
  struct Waiting {
    T item;
    SteadyTime arrival;
  };

  T Pop() {
    auto first = waiting_.begin();
    handled_ = first->first + 1;
    T item = std::move(first->second.item);
    waiting_.erase(first);
    return item;
  }

  const Nanoseconds window_;
  FrameNumberSet receipts_;
  std::map<std::uint64_t, Waiting> waiting_;
  std::uint64_t handled_ = 0;
};

}  // namespace isotherm
