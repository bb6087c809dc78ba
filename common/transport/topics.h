#pragma once

#include <cstdint>

#include "common/messages/frame_piece.h"
#include "common/messages/messages.h"
#include "common/messages/recording_transfer.h"

// Generated from idl/; complete only in the .cc files of this folder.
struct isotherm_wire_DepthFrame;
struct isotherm_wire_ThermalFrame;
struct isotherm_wire_ExternalOdometry;
struct isotherm_wire_Rig;
struct isotherm_wire_EdgeStatus;
struct isotherm_wire_Command;
struct isotherm_wire_CommandResult;
struct isotherm_wire_Receipt;
struct isotherm_wire_Feedback;
struct isotherm_wire_Hello;
struct isotherm_wire_RecordingRequest;
struct isotherm_wire_RecordingPiece;
struct isotherm_wire_FramePiece;
struct isotherm_wire_PieceReport;

namespace isotherm {

/// Names the topics of the link; TopicName and MakeQos say what they are on the wire.
enum class TopicId : std::uint8_t {
  kDepth,
  kThermal,
  kRig,
  kEdgeStatus,
  kCommand,
  kCommandResult,
  kReceipt,
  kFeedback,
  kHello,
  kExternalOdometry,
  kBackfillDepth,
  kBackfillThermal,
  kRecordingRequest,
  kRecordingPiece,
  kFramePiece,
  kPieceReport,
};

/// Relates a message to its topic and to the type that idlc generated for it.
template <typename Message>
struct TopicOf;
template <>
struct TopicOf<EncodedDepthFrame> {
  using Wire = ::isotherm_wire_DepthFrame;
  static constexpr TopicId kId = TopicId::kDepth;
};
template <>
struct TopicOf<EncodedThermalFrame> {
  using Wire = ::isotherm_wire_ThermalFrame;
  static constexpr TopicId kId = TopicId::kThermal;
};
template <>
struct TopicOf<Backfilled<EncodedDepthFrame>> {
  using Wire = ::isotherm_wire_DepthFrame;
  static constexpr TopicId kId = TopicId::kBackfillDepth;
};
template <>
struct TopicOf<Backfilled<EncodedThermalFrame>> {
  using Wire = ::isotherm_wire_ThermalFrame;
  static constexpr TopicId kId = TopicId::kBackfillThermal;
};
template <>
struct TopicOf<RigDescription> {
  using Wire = ::isotherm_wire_Rig;
  static constexpr TopicId kId = TopicId::kRig;
};
template <>
struct TopicOf<ExternalOdometrySample> {
  using Wire = ::isotherm_wire_ExternalOdometry;
  static constexpr TopicId kId = TopicId::kExternalOdometry;
};
template <>
struct TopicOf<EdgeStatus> {
  using Wire = ::isotherm_wire_EdgeStatus;
  static constexpr TopicId kId = TopicId::kEdgeStatus;
};
template <>
struct TopicOf<Command> {
  using Wire = ::isotherm_wire_Command;
  static constexpr TopicId kId = TopicId::kCommand;
};
template <>
struct TopicOf<CommandResult> {
  using Wire = ::isotherm_wire_CommandResult;
  static constexpr TopicId kId = TopicId::kCommandResult;
};
template <>
struct TopicOf<Receipt> {
  using Wire = ::isotherm_wire_Receipt;
  static constexpr TopicId kId = TopicId::kReceipt;
};
template <>
struct TopicOf<Feedback> {
  using Wire = ::isotherm_wire_Feedback;
  static constexpr TopicId kId = TopicId::kFeedback;
};
template <>
struct TopicOf<Hello> {
  using Wire = ::isotherm_wire_Hello;
  static constexpr TopicId kId = TopicId::kHello;
};
template <>
struct TopicOf<RecordingRequest> {
  using Wire = ::isotherm_wire_RecordingRequest;
  static constexpr TopicId kId = TopicId::kRecordingRequest;
};
template <>
struct TopicOf<RecordingPiece> {
  using Wire = ::isotherm_wire_RecordingPiece;
  static constexpr TopicId kId = TopicId::kRecordingPiece;
};
template <>
struct TopicOf<FramePiece> {
  using Wire = ::isotherm_wire_FramePiece;
  static constexpr TopicId kId = TopicId::kFramePiece;
};
template <>
struct TopicOf<PieceReport> {
  using Wire = ::isotherm_wire_PieceReport;
  static constexpr TopicId kId = TopicId::kPieceReport;
};

}  // namespace isotherm
