#include "common/messages/frame_number_set.h"

#include <algorithm>
#include <iterator>

namespace isotherm {

bool FrameNumberSet::IsNew(std::uint64_t number) const {
  return number >= next_ || FindHole(number) != holes_.end();
}

bool FrameNumberSet::Add(std::uint64_t number) {
  if (number >= next_) {
    if (number > next_) AddHole(next_, number - 1);
    next_ = number + 1;
    ++size_;
    return true;
  }
  const auto hole = FindHole(number);
  if (hole == holes_.end()) return false;
  // A late frame splits its hole in two, or makes it smaller.
  const auto [first, last] = *hole;
  holes_.erase(hole);
  if (first < number) AddHole(first, number - 1);
  if (number < last) AddHole(number + 1, last);
  ++size_;
  return true;
}

std::vector<FrameRange> FrameNumberSet::NewestHoles(std::size_t max) const {
  std::vector<FrameRange> result;
  for (auto hole = holes_.rbegin(); hole != holes_.rend() && result.size() < max; ++hole) {
    result.push_back({.first = hole->first, .last = hole->second});
  }
  std::ranges::reverse(result);
  return result;
}

FrameNumberSet::Holes::const_iterator FrameNumberSet::FindHole(std::uint64_t number) const {
  auto hole = holes_.upper_bound(number);
  if (hole == holes_.begin()) return holes_.end();
  --hole;
  return number <= hole->second ? hole : holes_.end();
}

void FrameNumberSet::AddHole(std::uint64_t first, std::uint64_t last) {
  holes_.emplace(first, last);
  // The oldest is forgotten; its frames then count as duplicates if they should still come, never
  // twice as received.
  if (holes_.size() > max_holes_) holes_.erase(holes_.begin());
}

}  // namespace isotherm
