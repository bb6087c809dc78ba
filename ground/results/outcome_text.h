#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string_view>

#include "common/base/enum_array.h"
#include "ground/scan/scan_counts.h"

namespace isotherm {

/// Returns what a reason means, for people: a sentence with what to do, to be read behind
/// "N lost: ".
std::string_view ExplainLost(LostReason reason);

/// The same for thermal frames, behind "N not used: ".
std::string_view ExplainLeftOut(LeftOutReason reason);

/// The reason that occurs most often; nullopt without any.
template <typename Reason>
std::optional<Reason> MainReason(const EnumArray<Reason, std::uint64_t>& counts) {
  const auto reasons = AllValues<Reason>();
  const auto main =
      std::ranges::max_element(reasons, {}, [&counts](Reason reason) { return counts[reason]; });
  return counts[*main] == 0 ? std::nullopt : std::optional(*main);
}

}  // namespace isotherm
