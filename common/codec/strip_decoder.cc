#include "common/codec/strip_decoder.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>
#include <span>

#include "common/codec/strip_kernel.h"

namespace isotherm::codec {
namespace {

static_assert(std::endian::native == std::endian::little, "words are copied as they are");

/// SlotLayout's words of a context.
void MakeSlots(std::span<const std::uint16_t> frequencies, std::int32_t* slot) {
  // A context that does not occur must not keep the slots of the image before.
  std::fill_n(slot, kScale, 0);
  for (std::size_t token = 0; token < frequencies.size(); ++token) {
    const int frequency = frequencies[token];
    for (int offset = 0; offset < frequency; ++offset) {
      *slot++ = static_cast<int>(token) | frequency << SlotLayout::kFrequencyShift |
                offset << SlotLayout::kOffsetShift;
    }
  }
}

/// Copies a row of each strip to its place in the image; returns the largest that was packed.
std::uint16_t Separate(const std::uint16_t* cells, int row, const std::uint16_t* mapping,
                       Image<std::uint16_t>& image) {
  const int rows = StripRows(image.height());
  const int strips = StripsWithRow(image.height(), row);
  std::uint16_t largest = 0;
  for (int strip = 0; strip < strips; ++strip) {
    const std::uint16_t* cell = cells + strip;
    for (std::uint16_t& pixel : image.Row(strip * rows + row)) {
      largest = std::max(largest, *cell);
      pixel = mapping != nullptr ? mapping[*cell] : *cell;
      cell += kStrips;
    }
  }
  return largest;
}

}  // namespace

template <typename Model>
std::optional<std::uint16_t> StripDecoder<Model>::Decode(PayloadReader& in,
                                                         const std::uint16_t* mapping,
                                                         Image<std::uint16_t>& image) {
  if (!GetTables(in) || !GetStrips(in)) return std::nullopt;
  StripDecoderState state;
  const auto word = [this](std::int32_t i) {
    return words_[static_cast<std::size_t>(i >> 1)] >> (16 * (i & 1)) & 0xFFFF;
  };
  for (std::size_t strip = 0; strip < kStrips; ++strip) {
    const std::int32_t first = first_words_[strip];
    if (first_words_[strip + 1] - first < 2 || word(first) > 0x7FFF) return std::nullopt;
    state.states[strip] = word(first) << 16 | word(first + 1);
    state.positions[strip] = first + 2;
  }
  const StripWords all{
      .slots = slots_->data(), .words = words_.data(), .last_word = first_words_[kStrips]};
  rows_.Reset(image.width());
  std::uint16_t largest = 0;
  for (int row = 0; row < StripRows(image.height()); ++row) {
    const StripRow now = rows_.Get();
    DecodeStripRow<Model>(all, StripsWithRow(image.height(), row), now, state);
    largest = std::max(largest, Separate(now.row, row, mapping, image));
    rows_.Next();
  }
  for (std::size_t strip = 0; strip < kStrips; ++strip) {
    if (state.states[strip] != kMinStripState || state.positions[strip] != first_words_[strip + 1])
      return std::nullopt;
  }
  return largest;
}

template <typename Model>
bool StripDecoder<Model>::GetTables(PayloadReader& in) {
  std::array<std::uint16_t, kTokens<Model>> frequencies;
  for (std::size_t context = 0; context < kContexts<Model>; ++context) {
    if (!GetFrequencies(in, frequencies)) return false;
    MakeSlots(frequencies, slots_->data() + context * kScale);
  }
  return true;
}

template <typename Model>
bool StripDecoder<Model>::GetStrips(PayloadReader& in) {
  // So that positions fit 32 bits whatever a payload says.
  constexpr std::uint32_t kMaxWords = 1U << 30;
  std::uint32_t count = 0;
  for (std::size_t strip = 0; strip < kStrips; ++strip) {
    const std::optional<std::uint32_t> words = in.Varint();
    if (!words || *words > kMaxWords - count) return false;
    count += *words;
    first_words_[strip + 1] = static_cast<std::int32_t>(count);
  }
  const auto bytes = in.Bytes(std::size_t{count} * sizeof(std::uint16_t));
  if (!bytes || !in.AtEnd()) return false;
  words_.resize(count / 2 + 1);
  words_.back() = 0;
  std::memcpy(words_.data(), bytes->data(), bytes->size());
  return true;
}

template class StripDecoder<DepthModel>;
template class StripDecoder<ThermalModel>;

}  // namespace isotherm::codec
