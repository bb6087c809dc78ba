#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace isotherm {

using Bytes = std::span<const std::uint8_t>;

/// Little-endian numbers at `offset`, which the caller has checked.
inline std::uint16_t Le16(Bytes bytes, std::size_t offset) {
  return static_cast<std::uint16_t>(bytes[offset] | bytes[offset + 1] << 8);
}
inline std::uint32_t Le32(Bytes bytes, std::size_t offset) {
  return Le16(bytes, offset) | static_cast<std::uint32_t>(Le16(bytes, offset + 2)) << 16;
}
inline void PutLe16(std::span<std::uint8_t> bytes, std::size_t offset, std::uint16_t value) {
  bytes[offset] = static_cast<std::uint8_t>(value);
  bytes[offset + 1] = static_cast<std::uint8_t>(value >> 8);
}
inline void PutLe32(std::span<std::uint8_t> bytes, std::size_t offset, std::uint32_t value) {
  PutLe16(bytes, offset, static_cast<std::uint16_t>(value));
  PutLe16(bytes, offset + 2, static_cast<std::uint16_t>(value >> 16));
}

}  // namespace isotherm
