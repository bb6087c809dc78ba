#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "common/codec/byte_io.h"
#include "common/codec/prediction.h"
#include "common/codec/rans.h"
#include "common/codec/strip_row_pair.h"
#include "common/frame/image.h"

namespace isotherm::codec {

/// Unpacks what StripEncoder packs. Keeps its memory from image to image. Thread-compatible.
template <typename Model>
class StripDecoder {
 public:
  /// Reads the rest of a payload into `image`, which has the size that the payload must have. A
  /// pixel becomes mapping[what was packed], or that itself if `mapping` is null. Returns how much
  /// the largest that was packed is, or nothing if the payload does not fit the image.
  std::optional<std::uint16_t> Decode(PayloadReader& in, const std::uint16_t* mapping,
                                      Image<std::uint16_t>& image);

 private:
  using Slots = std::array<std::int32_t, kContexts<Model> * kScale>;

  bool GetTables(PayloadReader& in);
  bool GetStrips(PayloadReader& in);

  std::unique_ptr<Slots> slots_ = std::make_unique<Slots>();
  StripRowPair<Model> rows_;
  std::vector<std::int32_t> words_;  ///< All strips', and one behind them.
  std::array<std::int32_t, kStrips + 1> first_words_{};
};

}  // namespace isotherm::codec
