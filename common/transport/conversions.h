#pragma once

#include <optional>

#include "common/transport/refusal.h"
#include "common/transport/topics.h"

/// Between our messages and what idlc generated, field by field. The key edge_id and the mark at
/// the end are handled by the endpoints.
namespace isotherm {

/// Fills `to`, which must be all zero. Payloads are borrowed from `from`; short lists are allocated
/// and released with the wire struct (dds_sample_free).
void ToWire(const EncodedDepthFrame& from, isotherm_wire_DepthFrame* to);
void ToWire(const EncodedThermalFrame& from, isotherm_wire_ThermalFrame* to);
void ToWire(const RigDescription& from, isotherm_wire_Rig* to);
void ToWire(const ExternalOdometrySample& from, isotherm_wire_ExternalOdometry* to);
void ToWire(const EdgeStatus& from, isotherm_wire_EdgeStatus* to);
void ToWire(const Command& from, isotherm_wire_Command* to);
void ToWire(const CommandResult& from, isotherm_wire_CommandResult* to);
void ToWire(const Receipt& from, isotherm_wire_Receipt* to);
void ToWire(const Feedback& from, isotherm_wire_Feedback* to);
void ToWire(const Hello& from, isotherm_wire_Hello* to);
void ToWire(const RecordingRequest& from, isotherm_wire_RecordingRequest* to);
void ToWire(const RecordingPiece& from, isotherm_wire_RecordingPiece* to);
void ToWire(const FramePiece& from, isotherm_wire_FramePiece* to);
void ToWire(const PieceReport& from, isotherm_wire_PieceReport* to);

/// Fills `to`, or says why `from` cannot be used. Frames are checked before their payload is
/// copied.
std::optional<RefusalCause> FromWire(const isotherm_wire_DepthFrame& from, EncodedDepthFrame* to);
std::optional<RefusalCause> FromWire(const isotherm_wire_ThermalFrame& from,
                                     EncodedThermalFrame* to);
std::optional<RefusalCause> FromWire(const isotherm_wire_Rig& from, RigDescription* to);
std::optional<RefusalCause> FromWire(const isotherm_wire_ExternalOdometry& from,
                                     ExternalOdometrySample* to);
std::optional<RefusalCause> FromWire(const isotherm_wire_EdgeStatus& from, EdgeStatus* to);
std::optional<RefusalCause> FromWire(const isotherm_wire_Command& from, Command* to);
std::optional<RefusalCause> FromWire(const isotherm_wire_CommandResult& from, CommandResult* to);
std::optional<RefusalCause> FromWire(const isotherm_wire_Receipt& from, Receipt* to);
std::optional<RefusalCause> FromWire(const isotherm_wire_Feedback& from, Feedback* to);
std::optional<RefusalCause> FromWire(const isotherm_wire_Hello& from, Hello* to);
std::optional<RefusalCause> FromWire(const isotherm_wire_RecordingRequest& from,
                                     RecordingRequest* to);
std::optional<RefusalCause> FromWire(const isotherm_wire_RecordingPiece& from, RecordingPiece* to);
std::optional<RefusalCause> FromWire(const isotherm_wire_FramePiece& from, FramePiece* to);
std::optional<RefusalCause> FromWire(const isotherm_wire_PieceReport& from, PieceReport* to);

/// A frame is the same on the wire whichever way it takes.
template <typename Frame, typename Wire>
void ToWire(const Backfilled<Frame>& from, Wire* to) {
  ToWire(from.frame, to);
}
template <typename Frame, typename Wire>
std::optional<RefusalCause> FromWire(const Wire& from, Backfilled<Frame>* to) {
  return FromWire(from, &to->frame);
}

/// Says with which members a sample of this major version ends at least; the hello's type is
/// frozen and has no mark.
template <typename Wire>
void SetMark(Wire* to) {
  if constexpr (requires { to->mark; }) to->mark = kWireMark;
}

/// As FromWire, for what a peer sent: refuses what ends too early, whose members read as zero.
template <typename Wire, typename Message>
std::optional<RefusalCause> Receive(const Wire& from, Message* to) {
  if constexpr (requires { from.mark; }) {
    if (from.mark != kWireMark) return RefusalCause::kIncomplete;
  }
  return FromWire(from, to);
}

}  // namespace isotherm
