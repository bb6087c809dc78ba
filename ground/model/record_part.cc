#include "ground/model/record_part.h"

#include <bit>
#include <cstring>
#include <utility>

namespace isotherm {

std::vector<std::uint8_t> PackRecords(const ThermalVolume& thermal, std::int32_t first,
                                      std::int32_t end) {
  std::vector<std::uint8_t> bytes;
  const auto append = [&](const auto& value) {
    const auto* begin = reinterpret_cast<const std::uint8_t*>(&value);
    bytes.insert(bytes.end(), begin, begin + sizeof(value));
  };
  for (std::int32_t block = first; block < end; ++block) {
    std::uint64_t mask = 0;
    const auto find = [&](int row) {
      return thermal.records() != nullptr ? thermal.records()->Find(block, row) : nullptr;
    };
    for (int row = 0; row < ThermalRecords::kRowsPerBlock; ++row) {
      if (find(row) != nullptr) mask |= std::uint64_t{1} << row;
    }
    append(mask);
    for (int row = 0; row < ThermalRecords::kRowsPerBlock; ++row) {
      if (const RecordRow* records = find(row)) append(*records);
    }
    for (int row = 0; row < ThermalRecords::kRowsPerBlock; ++row) {
      if (find(row) == nullptr) continue;
      const std::uint8_t* sigmas = std::as_const(*thermal.records()).FindSigmas(block, row);
      bytes.insert(bytes.end(), sigmas, sigmas + RecordRow::kVoxels);
    }
  }
  return bytes;
}

bool UnpackRecords(std::span<const std::uint8_t> bytes, std::int32_t first, std::int32_t end,
                   bool with_sigmas, ThermalVolume& thermal) {
  for (std::int32_t block = first; block < end; ++block) {
    std::uint64_t mask = 0;
    if (bytes.size() < sizeof(mask)) return false;
    std::memcpy(&mask, bytes.data(), sizeof(mask));
    bytes = bytes.subspan(sizeof(mask));
    const auto rows = static_cast<std::size_t>(std::popcount(mask));
    const std::size_t size =
        rows * (sizeof(RecordRow) + (with_sigmas ? std::size_t{RecordRow::kVoxels} : 0));
    if (bytes.size() < size) return false;
    const std::uint8_t* in = bytes.data();
    const std::uint8_t* sigmas = in + rows * sizeof(RecordRow);
    for (int row = 0; row < ThermalRecords::kRowsPerBlock; ++row) {
      if ((mask >> row & 1) == 0) continue;
      if (thermal.records() != nullptr)
        std::memcpy(&thermal.records()->Row(block, row), in, sizeof(RecordRow));
      in += sizeof(RecordRow);
      if (!with_sigmas) continue;
      if (thermal.records() != nullptr)
        std::memcpy(thermal.records()->Sigmas(block, row), sigmas, RecordRow::kVoxels);
      sigmas += RecordRow::kVoxels;
    }
    bytes = bytes.subspan(size);
  }
  return bytes.empty();
}

}  // namespace isotherm
