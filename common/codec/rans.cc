#include "common/codec/rans.h"

#include <algorithm>
#include <numeric>

namespace isotherm::codec {

void NormalizeCounts(std::span<const std::uint32_t> counts, std::span<std::uint16_t> frequencies) {
  const std::uint64_t total = std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
  std::fill(frequencies.begin(), frequencies.end(), std::uint16_t{0});
  if (total == 0) return;
  std::int64_t rest = kScale;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0) continue;
    const std::uint64_t rounded = (std::uint64_t{counts[i]} * kScale + total / 2) / total;
    frequencies[i] = static_cast<std::uint16_t>(std::max<std::uint64_t>(rounded, 1));
    rest -= frequencies[i];
  }
  // What rounding left over or took too much goes to and comes from the most frequent symbols,
  // where it costs least.
  while (rest != 0) {
    const auto largest = std::max_element(frequencies.begin(), frequencies.end());
    const std::int64_t change = rest > 0 ? rest : std::max<std::int64_t>(rest, -(*largest / 2));
    *largest = static_cast<std::uint16_t>(*largest + change);
    rest -= change;
  }
}

void PutFrequencies(std::span<const std::uint16_t> frequencies, std::vector<std::uint8_t>& out) {
  std::size_t used = frequencies.size();
  while (used > 0 && frequencies[used - 1] == 0) --used;
  PutVarint(static_cast<std::uint32_t>(used), out);
  for (const std::uint16_t frequency : frequencies.first(used)) PutVarint(frequency, out);
}

bool GetFrequencies(PayloadReader& in, std::span<std::uint16_t> frequencies) {
  const std::optional<std::uint32_t> used = in.Varint();
  if (!used || *used > frequencies.size()) return false;
  std::fill(frequencies.begin(), frequencies.end(), std::uint16_t{0});
  std::uint32_t sum = 0;
  for (std::uint16_t& frequency : frequencies.first(*used)) {
    const std::optional<std::uint32_t> value = in.Varint();
    if (!value || *value > kScale - sum) return false;
    frequency = static_cast<std::uint16_t>(*value);
    sum += *value;
  }
  return sum == kScale || *used == 0;
}

}  // namespace isotherm::codec
