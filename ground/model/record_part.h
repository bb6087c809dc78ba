#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ground/thermal/thermal_volume.h"

namespace isotherm {

/// Most that the records of one block can take, bytes.
inline constexpr std::size_t kMaxRecordBytes =
    sizeof(std::uint64_t) +
    ThermalRecords::kRowsPerBlock * (sizeof(RecordRow) + std::size_t{RecordRow::kVoxels});

/// Records of blocks `first` to `end` - 1: per block a bit mask of the rows that there are, then
/// these rows, then their uncertainties. All masks are 0 if the volume keeps none.
std::vector<std::uint8_t> PackRecords(const ThermalVolume& thermal, std::int32_t first,
                                      std::int32_t end);
/// The inverse; false if the bytes are too few or too many. Without `with_sigmas` the bytes hold no
/// uncertainties. A volume that keeps no records stays without.
bool UnpackRecords(std::span<const std::uint8_t> bytes, std::int32_t first, std::int32_t end,
                   bool with_sigmas, ThermalVolume& thermal);

}  // namespace isotherm
