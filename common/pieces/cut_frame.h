#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "common/messages/frame_piece.h"

namespace isotherm {

/// Says of a block of so many data pieces how many parity pieces it gets.
using ParityRule = std::function<int(int data_pieces)>;

/// Returns the pieces of a frame in the order in which they are sent; what identifies the frame,
/// and their order in the session, is the caller's to fill in. `frame` is not empty and has at most
/// kMaxPiecedFrameBytes.
std::vector<FramePiece> CutFrame(std::span<const std::uint8_t> frame, const ParityRule& parity);

}  // namespace isotherm
