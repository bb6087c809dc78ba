#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/frame/frame.h"
#include "common/messages/messages.h"
#include "common/transport/refusal.h"

namespace isotherm {

/// Returns a frame as one run of bytes (frame_packet.proto), to be cut into pieces.
std::vector<std::uint8_t> PackFrame(const EncodedDepthFrame& frame);
std::vector<std::uint8_t> PackFrame(const EncodedThermalFrame& frame);

/// Fills `frame` from what a peer sent, or says why it cannot be used: the rules are those for
/// frames that come whole.
std::optional<RefusalCause> UnpackFrame(std::span<const std::uint8_t> packet,
                                        EncodedDepthFrame* frame);
std::optional<RefusalCause> UnpackFrame(std::span<const std::uint8_t> packet,
                                        EncodedThermalFrame* frame);

}  // namespace isotherm
