// Rows of all strips of an image, a strip per SIMD lane. Compiled once per instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "common/codec/strip_kernel.cc"
#include "common/simd/kernel_prelude-inl.h"  // Before everything else.

#include "common/codec/rans.h"
#include "common/codec/residual_token.h"
#include "common/codec/strip_kernel.h"
#include "common/simd/packing-inl.h"

HWY_BEFORE_NAMESPACE();
namespace isotherm::HWY_NAMESPACE {

// A strip per lane, in as many vectors as it takes.
using DS = hn::CappedTag<std::int32_t, codec::kStrips>;
using D16 = hn::Rebind<std::uint16_t, DS>;
using DF = hn::Rebind<float, DS>;
using VS = hn::Vec<DS>;
using MS = hn::Mask<DS>;
constexpr DS ds;
constexpr int kLanes = static_cast<int>(hn::MaxLanes(ds));
constexpr int kParts = codec::kStrips / kLanes;

HWY_INLINE VS Load16(const std::uint16_t* cells) {
  return hn::PromoteTo(ds, hn::LoadU(D16(), cells));
}
HWY_INLINE void Store16(VS values, std::uint16_t* cells) {
  hn::StoreU(hn::DemoteTo(D16(), values), D16(), cells);
}
HWY_INLINE VS Int(int value) { return hn::Set(ds, value); }
HWY_INLINE VS Distance(VS a, VS b) { return hn::Abs(hn::Sub(a, b)); }

/// Bits of a float of a value below 2^24, whose exponent says how many bits the value has.
HWY_INLINE VS FloatBits(VS value) { return hn::BitCast(ds, hn::ConvertTo(DF(), value)); }
constexpr int kExponentShift = 23;
constexpr int kExponentBias = 127;

HWY_INLINE VS Predict(codec::DepthModel, VS west, VS north, VS /*north_west*/) {
  return hn::ShiftRight<1>(hn::Add(west, north));
}
HWY_INLINE VS Predict(codec::ThermalModel, VS west, VS north, VS north_west) {
  const VS least = hn::Min(west, north);
  const VS most = hn::Max(west, north);
  return hn::Sub(hn::Add(least, most), hn::Min(hn::Max(north_west, least), most));
}

/// Knows what can be known of a pixel before it is decoded. Goes along a row.
template <typename Model>
class Surroundings {
 public:
  HWY_INLINE Surroundings(const codec::StripRow& row, int part)
      : row_(row), first_cell_(part * kLanes) {
    west_ = west_value_ = hn::Zero(ds);
    if (!row.is_first) {
      west_ = Load16(row.filled_above + first_cell_);
      if constexpr (Model::kHasHoles) west_value_ = Load16(row.above + first_cell_);
    }
    north_ = north_west_ = north_east_ = west_;
    north_value_ = west_value_;
  }

  /// Call this for each column in turn, before anything else.
  HWY_INLINE void Enter(int x) {
    const std::ptrdiff_t cell = std::ptrdiff_t{x} * codec::kStrips + first_cell_;
    if (row_.is_first) {  // The pixel to the west stands for those above.
      north_ = north_west_ = north_east_ = west_;
      north_value_ = west_value_;
      return;
    }
    north_west_ = north_;
    north_ = north_east_;
    north_east_ = Load16(row_.filled_above + cell + codec::kStrips);
    if constexpr (Model::kHasHoles) north_value_ = Load16(row_.above + cell);
  }
  /// Call this when the column's pixels are known; `filled` is `value` without holes.
  HWY_INLINE void Leave(VS value, VS filled) {
    west_ = filled;
    west_value_ = value;
  }

  HWY_INLINE VS north() const { return north_; }
  HWY_INLINE VS Prediction() const { return Predict(Model(), west_, north_, north_west_); }
  HWY_INLINE VS Context() const {
    const VS activity =
        hn::Add(hn::Add(Distance(west_, north_west_), Distance(north_, north_west_)),
                Distance(north_, north_east_));
    const VS odd = hn::Or(hn::ShiftLeft<1>(activity), Int(1));
    const VS bits = hn::Sub(hn::ShiftRight<kExponentShift>(FloatBits(odd)), Int(kExponentBias));
    VS context = hn::Min(bits, Int(Model::kActivityLevels - 1));
    if constexpr (Model::kHasHoles) {
      const VS zero = hn::Zero(ds);
      constexpr int kLevels = Model::kActivityLevels;
      context = hn::Add(context, hn::IfThenElseZero(hn::Eq(west_value_, zero), Int(kLevels)));
      context = hn::Add(context, hn::IfThenElseZero(hn::Eq(north_value_, zero), Int(2 * kLevels)));
    }
    return context;
  }

 private:
  const codec::StripRow& row_;
  const int first_cell_;
  VS west_, north_, north_west_, north_east_;  ///< Without holes.
  VS west_value_, north_value_;                ///< 0 where there is a hole.
};

/// Repeats the last pixel of a row behind its end, as what is north-east of the next row's last.
HWY_INLINE void PadRight(std::uint16_t* cells, int width) {
  std::uint16_t* const end = cells + std::ptrdiff_t{width} * codec::kStrips;
  std::memcpy(end, end - codec::kStrips, codec::kStrips * sizeof(*end));
}

template <typename Model>
HWY_INLINE void PadRow(const codec::StripRow& row) {
  PadRight(row.row, row.width);
  if constexpr (Model::kHasHoles) PadRight(row.filled, row.width);
}

// Predicts the pixels of a row of all strips and turns what is left into tokens. The token of a
// residual of 16 and more is made of its exponent and two bits below the leading one, which is what
// a float begins with; TokenOf is the same for one.
template <typename Model>
HWY_INLINE void TokenizeRow(const codec::StripRow& row, const codec::StripTokens& tokens) {
  for (int part = 0; part < kParts; ++part) {
    Surroundings<Model> around(row, part);
    for (int x = 0; x < row.width; ++x) {
      const std::ptrdiff_t cell = std::ptrdiff_t{x} * codec::kStrips + part * kLanes;
      around.Enter(x);
      const VS pixel = Load16(row.row + cell);
      VS filled = pixel;
      // Modulo 2^16, then as a signed number.
      const VS residual =
          hn::ShiftRight<16>(hn::ShiftLeft<16>(hn::Sub(pixel, around.Prediction())));
      const VS zigzag = hn::Xor(hn::ShiftLeft<1>(residual), hn::ShiftRight<31>(residual));
      const VS large =
          hn::Sub(hn::ShiftRight<kExponentShift - 2>(FloatBits(zigzag)), Int(4 * kExponentBias));
      VS token = hn::IfThenElse(hn::Lt(zigzag, Int(codec::kDirectTokens)), zigzag, large);
      if constexpr (Model::kHasHoles) {
        const MS hole = hn::Eq(pixel, hn::Zero(ds));
        token = hn::IfThenZeroElse(hole, hn::Add(token, Int(1)));
        filled = hn::IfThenElse(hole, around.north(), pixel);
        Store16(filled, row.filled + cell);
      }
      const VS symbol = hn::Add(hn::Mul(around.Context(), Int(codec::kTokens<Model>)), token);
      Store16(symbol, tokens.symbols + cell);
      Store16(zigzag, tokens.residuals + cell);
      around.Leave(pixel, filled);
    }
  }
  PadRow<Model>(row);
}

void TokenizeDepthRow(const codec::StripRow& row, const codec::StripTokens& tokens) {
  TokenizeRow<codec::DepthModel>(row, tokens);
}
void TokenizeThermalRow(const codec::StripRow& row, const codec::StripTokens& tokens) {
  TokenizeRow<codec::ThermalModel>(row, tokens);
}

/// Notes the low words of some lanes, with their strips' numbers, and takes them off.
HWY_INLINE VS Emit(VS state, MS full, int part, std::int32_t*& queue) {
  const VS strip = hn::ShiftLeft<16>(hn::Iota(ds, part * kLanes));
  const VS word = hn::Or(hn::And(state, Int(0xFFFF)), strip);
  const Packing<DS> packing(full);
  packing.Store(word, queue);
  queue += packing.count();
  return hn::IfThenElse(full, hn::ShiftRight<16>(state), state);
}

/// x / divisor and the rest, for x below 2^21 divisor: single precision misses by one at most.
HWY_INLINE VS Divide(VS x, VS divisor, hn::Vec<DF> reciprocal, VS& rest) {
  VS quotient = hn::ConvertTo(ds, hn::Mul(hn::ConvertTo(DF(), x), reciprocal));
  rest = hn::Sub(x, hn::Mul(quotient, divisor));
  const MS over = hn::Lt(rest, hn::Zero(ds));
  const MS under = hn::Gt(rest, hn::Sub(divisor, Int(1)));
  quotient = hn::Add(quotient, hn::IfThenElseZero(under, Int(1)));
  quotient = hn::Sub(quotient, hn::IfThenElseZero(over, Int(1)));
  rest = hn::Sub(rest, hn::IfThenElseZero(under, divisor));
  rest = hn::Add(rest, hn::IfThenElseZero(over, divisor));
  return quotient;
}

// Puts the symbols of a row into the strips' coders, from its end to its beginning: the bits that
// follow a token, then the token (Duda, arXiv:1311.2540, section 2.3). A state gives its low word
// away where it would leave [2^15, 2^31). Fast: a state is divided by multiplying in single
// precision and set right; the words that few lanes give at a time are noted without a branch, and
// sorted by strip afterwards.
std::size_t EncodeRow(const codec::StripTokens& tokens, int width, int strips,
                      const std::int32_t* symbol_table, std::int32_t* states, std::int32_t* words) {
  using Symbol = codec::SymbolLayout;
  std::int32_t* next = words;
  for (int part = 0; part < kParts; ++part) {
    const MS active = hn::Lt(hn::Iota(ds, part * kLanes), Int(strips));
    VS state = hn::LoadU(ds, states + part * kLanes);
    const VS old = state;
    for (int x = width - 1; x >= 0; --x) {
      const std::ptrdiff_t cell = std::ptrdiff_t{x} * codec::kStrips + part * kLanes;
      // What is read in lanes without a row is nobody's.
      const VS index = hn::IfThenElseZero(active, Load16(tokens.symbols + cell));
      const VS symbol = hn::GatherIndex(ds, symbol_table, index);
      const VS frequency = hn::And(symbol, Int(Symbol::kFrequencyMask));
      const hn::Vec<DF> reciprocal = hn::Div(hn::Set(DF(), 1.0F), hn::ConvertTo(DF(), frequency));
      const VS raw_bits = hn::ShiftRight<Symbol::kRawBitsShift>(symbol);
      const MS has_raw = hn::And(active, hn::Gt(raw_bits, hn::Zero(ds)));
      if (!hn::AllFalse(ds, has_raw)) {
        const MS full = hn::Gt(hn::Shr(state, hn::Sub(Int(31), raw_bits)), hn::Zero(ds));
        state = Emit(state, hn::And(has_raw, full), part, next);
        const VS mask = hn::Sub(hn::Shl(Int(1), raw_bits), Int(1));
        const VS raw = hn::And(Load16(tokens.residuals + cell), mask);
        state = hn::IfThenElse(has_raw, hn::Or(hn::Shl(state, raw_bits), raw), state);
      }
      constexpr int kFullShift = 31 - static_cast<int>(codec::kScaleBits);
      const MS has_room = hn::Lt(hn::ShiftRight<kFullShift>(state), frequency);
      state = Emit(state, hn::AndNot(has_room, active), part, next);
      VS rest;
      const VS quotient = Divide(state, frequency, reciprocal, rest);
      const VS start =
          hn::And(hn::ShiftRight<Symbol::kStartShift>(symbol), Int(Symbol::kStartMask));
      state = hn::Add(hn::Add(hn::ShiftLeft<codec::kScaleBits>(quotient), start), rest);
    }
    hn::StoreU(hn::IfThenElse(active, state, old), ds, states + part * kLanes);
  }
  return static_cast<std::size_t>(next - words);
}

/// The coders of a vector of strips.
class Decoder {
 public:
  HWY_INLINE Decoder(const codec::StripWords& words, int strips,
                     const codec::StripDecoderState& state, int part)
      : words_(words),
        active_(hn::Lt(hn::Iota(ds, part * kLanes), Int(strips))),
        state_(hn::LoadU(ds, state.states + part * kLanes)),
        position_(hn::LoadU(ds, state.positions + part * kLanes)) {}

  HWY_INLINE void Save(int part, codec::StripDecoderState& state) const {
    hn::StoreU(hn::IfThenElse(active_, state_, hn::LoadU(ds, state.states + part * kLanes)), ds,
               state.states + part * kLanes);
    hn::StoreU(position_, ds, state.positions + part * kLanes);
  }

  HWY_INLINE VS Token(VS context) {
    using Slot = codec::SlotLayout;
    const VS number = hn::And(state_, Int(static_cast<int>(codec::kScale) - 1));
    const VS slot = hn::GatherIndex(ds, words_.slots,
                                    hn::Or(hn::ShiftLeft<codec::kScaleBits>(context), number));
    const VS frequency =
        hn::And(hn::ShiftRight<Slot::kFrequencyShift>(slot), Int(Slot::kFrequencyMask));
    const VS offset = hn::ShiftRight<Slot::kOffsetShift>(slot);
    state_ = hn::Add(hn::Mul(frequency, hn::ShiftRight<codec::kScaleBits>(state_)), offset);
    Refill();
    return hn::And(slot, Int(Slot::kTokenMask));
  }

  /// The residual, as ZigZag's value, of a token, with the bits that follow.
  HWY_INLINE VS Residual(VS token) {
    const MS large = hn::Gt(token, Int(codec::kDirectTokens - 1));
    if (hn::AllFalse(ds, hn::And(active_, large))) return token;
    const VS raw_bits = hn::IfThenElseZero(large, hn::Sub(hn::ShiftRight<2>(token), Int(2)));
    const VS leading = hn::Add(hn::And(token, Int(3)), Int(4));
    const VS base = hn::IfThenElse(large, hn::Shl(leading, raw_bits), token);
    const VS raw = hn::And(state_, hn::Sub(hn::Shl(Int(1), raw_bits), Int(1)));
    state_ = hn::Shr(state_, raw_bits);
    Refill();
    return hn::Add(base, raw);
  }

 private:
  HWY_INLINE void Refill() {
    const MS few = hn::And(active_, hn::Lt(state_, Int(codec::kMinStripState)));
    const VS pair = hn::GatherIndex(ds, words_.words, hn::ShiftRight<1>(position_));
    const VS half = hn::ShiftLeft<4>(hn::And(position_, Int(1)));
    const VS word = hn::And(hn::Shr(pair, half), Int(0xFFFF));
    state_ = hn::IfThenElse(few, hn::Or(hn::ShiftLeft<16>(state_), word), state_);
    const VS behind = hn::Add(position_, Int(1));
    position_ = hn::IfThenElse(few, hn::Min(behind, Int(words_.last_word)), position_);
  }

  const codec::StripWords& words_;
  const MS active_;
  VS state_, position_;
};

// Takes a row out of the strips' coders: the token in the context of the pixel's neighbours, the
// bits that follow it, and the pixel they and the prediction make. Rows: a strip per lane; a pixel
// waits for the one to its west, so that what counts is how long a step takes, and all lanes take
// it together. Where vectors have fewer lanes than there are strips, one step is done for all
// before the next, and they wait together.
template <typename Model>
HWY_INLINE void DecodeRow(const codec::StripWords& words, int strips, const codec::StripRow& row,
                          codec::StripDecoderState& state) {
  const auto decode = [&](int part, int x, Decoder& decoder, Surroundings<Model>& around) HWY_ATTR {
    const std::ptrdiff_t cell = std::ptrdiff_t{x} * codec::kStrips + part * kLanes;
    around.Enter(x);
    VS token = decoder.Token(around.Context());
    MS hole = hn::Lt(token, hn::Zero(ds));  // None.
    if constexpr (Model::kHasHoles) {
      hole = hn::Eq(token, hn::Zero(ds));
      token = hn::Max(hn::Sub(token, Int(1)), hn::Zero(ds));
    }
    const VS zigzag = decoder.Residual(token);
    const VS sign = hn::Neg(hn::And(zigzag, Int(1)));
    const VS residual = hn::Xor(hn::ShiftRight<1>(zigzag), sign);
    const VS pixel = hn::And(hn::Add(around.Prediction(), residual), Int(0xFFFF));
    if constexpr (Model::kHasHoles) {
      const VS value = hn::IfThenZeroElse(hole, pixel);
      const VS filled = hn::IfThenElse(hole, around.north(), pixel);
      Store16(value, row.row + cell);
      Store16(filled, row.filled + cell);
      around.Leave(value, filled);
    } else {
      Store16(pixel, row.row + cell);
      around.Leave(pixel, pixel);
    }
  };
  // Vectors side by side, two at most: more do not fit the registers.
  constexpr int kAtOnce = kParts < 2 ? 1 : 2;
  for (int part = 0; part < kParts; part += kAtOnce) {
    Decoder decoder(words, strips, state, part);
    Surroundings<Model> around(row, part);
    if constexpr (kAtOnce == 1) {
      for (int x = 0; x < row.width; ++x) decode(part, x, decoder, around);
    } else {
      Decoder other(words, strips, state, part + 1);
      Surroundings<Model> other_around(row, part + 1);
      for (int x = 0; x < row.width; ++x) {
        decode(part, x, decoder, around);
        decode(part + 1, x, other, other_around);
      }
      other.Save(part + 1, state);
    }
    decoder.Save(part, state);
  }
  PadRow<Model>(row);
}

void DecodeDepthRow(const codec::StripWords& words, int strips, const codec::StripRow& row,
                    codec::StripDecoderState& state) {
  DecodeRow<codec::DepthModel>(words, strips, row, state);
}
void DecodeThermalRow(const codec::StripWords& words, int strips, const codec::StripRow& row,
                      codec::StripDecoderState& state) {
  DecodeRow<codec::ThermalModel>(words, strips, row, state);
}

}  // namespace isotherm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace isotherm {

HWY_EXPORT(TokenizeDepthRow);
HWY_EXPORT(TokenizeThermalRow);
HWY_EXPORT(EncodeRow);
HWY_EXPORT(DecodeDepthRow);
HWY_EXPORT(DecodeThermalRow);

namespace codec {

template <>
void TokenizeStripRow<DepthModel>(const StripRow& row, const StripTokens& tokens) {
  HWY_DYNAMIC_DISPATCH(TokenizeDepthRow)(row, tokens);
}
template <>
void TokenizeStripRow<ThermalModel>(const StripRow& row, const StripTokens& tokens) {
  HWY_DYNAMIC_DISPATCH(TokenizeThermalRow)(row, tokens);
}

std::size_t EncodeStripRow(const StripTokens& tokens, int width, int strips,
                           const std::int32_t* symbol_table, std::int32_t* states,
                           std::int32_t* words) {
  return HWY_DYNAMIC_DISPATCH(EncodeRow)(tokens, width, strips, symbol_table, states, words);
}

template <>
void DecodeStripRow<DepthModel>(const StripWords& words, int strips, const StripRow& row,
                                StripDecoderState& state) {
  HWY_DYNAMIC_DISPATCH(DecodeDepthRow)(words, strips, row, state);
}
template <>
void DecodeStripRow<ThermalModel>(const StripWords& words, int strips, const StripRow& row,
                                  StripDecoderState& state) {
  HWY_DYNAMIC_DISPATCH(DecodeThermalRow)(words, strips, row, state);
}

}  // namespace codec
}  // namespace isotherm
#endif  // HWY_ONCE
