#include "ground/model/record_part.h"

#include <bit>
#include <cstring>

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
  }
  return bytes;
}

bool UnpackRecords(std::span<const std::uint8_t> bytes, std::int32_t first, std::int32_t end,
                   ThermalVolume& thermal) {
  for (std::int32_t block = first; block < end; ++block) {
    std::uint64_t mask = 0;
    if (bytes.size() < sizeof(mask)) return false;
    std::memcpy(&mask, bytes.data(), sizeof(mask));
    bytes = bytes.subspan(sizeof(mask));
    const std::size_t size = sizeof(RecordRow) * static_cast<std::size_t>(std::popcount(mask));
    if (bytes.size() < size) return false;
    const std::uint8_t* in = bytes.data();
    for (int row = 0; row < ThermalRecords::kRowsPerBlock; ++row) {
      if ((mask >> row & 1) == 0) continue;
      if (thermal.records() != nullptr)
        std::memcpy(&thermal.records()->Row(block, row), in, sizeof(RecordRow));
      in += sizeof(RecordRow);
    }
    bytes = bytes.subspan(size);
  }
  return bytes.empty();
}

}  // namespace isotherm
