#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/status.h"

namespace isotherm {

/// The vertices of a PLY file: one column of numbers per property.
struct PlyVertices {
  std::size_t count = 0;
  std::vector<std::string> names;
  std::vector<std::vector<float>> columns;

  /// The property of that name, or else with or without the prefix `scalar_` that CloudCompare
  /// gives to scalar fields (our older files have few of them); nullptr if there is none.
  const std::vector<float>* Find(std::string_view name) const;
};

/// The largest file that is read: a hundred million points of 40 bytes.
inline constexpr std::uint64_t kMaxPlyBytes = 4'000'000'000;

/// Reads the element `vertex` (which must come first and have no lists) of an ASCII or binary PLY
/// file; what follows it is ignored. kDataLoss says what is wrong: not a PLY file, truncated,
/// unknown types, more than kMaxPlyBytes.
Result<PlyVertices> ReadPly(const std::filesystem::path& path);
Result<PlyVertices> ParsePly(std::string_view bytes);

}  // namespace isotherm
