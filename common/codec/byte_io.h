#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

/// The small parts of a payload: numbers of variable length (7 bits per byte, lowest first).
namespace isotherm::codec {

inline void PutVarint(std::uint32_t value, std::vector<std::uint8_t>& out) {
  constexpr std::uint32_t kMore = 0x80;
  while (value >= kMore) {
    out.push_back(static_cast<std::uint8_t>(value | kMore));
    value >>= 7;
  }
  out.push_back(static_cast<std::uint8_t>(value));
}

/// Reads from the front of a payload; every read says whether it fitted. Thread-compatible.
class PayloadReader {
 public:
  explicit PayloadReader(std::span<const std::uint8_t> payload) : rest_(payload) {}

  std::optional<std::uint8_t> Byte() {
    if (rest_.empty()) return std::nullopt;
    const std::uint8_t byte = rest_.front();
    rest_ = rest_.subspan(1);
    return byte;
  }

  std::optional<std::uint32_t> Varint() {
    std::uint32_t value = 0;
    for (int shift = 0; shift < 32; shift += 7) {
      const std::optional<std::uint8_t> byte = Byte();
      if (!byte) return std::nullopt;
      value |= static_cast<std::uint32_t>(*byte & 0x7F) << shift;
      if (*byte < 0x80) return value;
    }
    return std::nullopt;
  }

  std::optional<std::span<const std::uint8_t>> Bytes(std::size_t count) {
    if (count > rest_.size()) return std::nullopt;
    const std::span<const std::uint8_t> bytes = rest_.first(count);
    rest_ = rest_.subspan(count);
    return bytes;
  }

  bool AtEnd() const { return rest_.empty(); }

 private:
  std::span<const std::uint8_t> rest_;
};

}  // namespace isotherm::codec
