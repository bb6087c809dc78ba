#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "common/messages/messages.h"

namespace isotherm {

/// Returns whether `number` is in one of `ranges`, which are ascending.
inline bool IsIn(std::uint64_t number, const std::vector<FrameRange>& ranges) {
  const auto range = std::ranges::lower_bound(ranges, number, {}, &FrameRange::last);
  return range != ranges.end() && range->first <= number;
}

/// Holds which frame numbers of one stream were seen. size() + missing() = next(), always.
/// Memory is bounded: when there are too many holes, the oldest is given up, its frames stay
/// missing for good. Thread-compatible.
class FrameNumberSet {
 public:
  /// Over a narrow link every second frame comes later, if it is not every sixteenth that comes at
  /// once: an hour and more. 8 MB. Smaller: the ground forgets what it lacks.
  static constexpr std::size_t kMaxHolesKept = std::size_t{1} << 17U;

  explicit FrameNumberSet(std::size_t max_holes = kMaxHolesKept) : max_holes_(max_holes) {}

  /// Enters `number`; false if it was here before or was given up.
  bool Add(std::uint64_t number);
  /// True if Add would take `number`.
  bool IsNew(std::uint64_t number) const;

  std::uint64_t next() const { return next_; }  ///< One above the highest number.
  std::uint64_t size() const { return size_; }
  std::uint64_t missing() const { return next_ - size_; }
  /// The newest `max` holes, ascending.
  std::vector<FrameRange> NewestHoles(std::size_t max) const;

 private:
  using Holes = std::map<std::uint64_t, std::uint64_t>;  ///< First to last number, both missing.
  Holes::const_iterator FindHole(std::uint64_t number) const;
  void AddHole(std::uint64_t first, std::uint64_t last);

  std::size_t max_holes_;
  Holes holes_;
  std::uint64_t next_ = 0;
  std::uint64_t size_ = 0;
};

}  // namespace isotherm
