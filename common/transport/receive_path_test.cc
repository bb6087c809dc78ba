// Row F60: whatever bytes a peer sends under our topics, the way from the network to our messages
// survives them: the middleware's decoder and its sample (ddsi_serdata_from_ser, to_sample), then
// our checks. Seeded; ISOTHERM_RECEIVE_PATH_INPUTS sets how many inputs in all.
#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <dds/ddsi/q_radmin.h>
#include <gtest/gtest.h>
#include <isotherm_control.h>
#include <isotherm_frames.h>
#include <isotherm_pieces.h>
#include <isotherm_recordings.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <random>
#include <vector>

#include "common/base/check.h"
#include "common/transport/bounded_text.h"
#include "common/transport/conversions.h"
#include "common/transport/testing/example_messages.h"
#include "common/transport/testing/test_domain.h"
#include "common/transport/transport_environment.h"

namespace isotherm {
namespace {

constexpr std::uint64_t kSeed = 20'260'314;
constexpr std::uint64_t kDefaultInputs = 1'000'000;  // Seconds.
constexpr std::uint64_t kTopics = 14;
constexpr std::size_t kHeaderBytes = 4;
constexpr std::size_t kLengthBytes = 4;  // The length before the members of an appendable type.

using Bytes = std::vector<std::uint8_t>;

std::uint64_t InputsPerTopic() {
  const char* inputs = std::getenv("ISOTHERM_RECEIVE_PATH_INPUTS");
  return (inputs != nullptr ? std::strtoull(inputs, nullptr, 10) : kDefaultInputs) / kTopics;
}

void PutWord(Bytes& bytes, std::size_t at, std::uint32_t value) {
  if (at + sizeof(value) <= bytes.size()) std::memcpy(bytes.data() + at, &value, sizeof(value));
}

/// Bytes that are almost a sample.
class Mutator {
 public:
  explicit Mutator(Bytes seed) : seed_(std::move(seed)) {}

  /// First each truncation, with the length as it was and put right, and each word replaced; then
  /// at random.
  Bytes Next() {
    Bytes bytes = seed_;
    const std::uint64_t step = step_++;
    const std::uint64_t cuts = seed_.size() - kHeaderBytes;
    const std::uint64_t words = cuts / sizeof(std::uint32_t) * kWords.size();
    if (step < 2 * cuts) {
      Truncate(bytes, kHeaderBytes + step / 2, step % 2 == 0);
    } else if (step - 2 * cuts < words) {
      const std::uint64_t word = step - 2 * cuts;
      PutWord(bytes, kHeaderBytes + word / kWords.size() * sizeof(std::uint32_t),
              kWords[word % kWords.size()]);
    } else {
      for (std::uint64_t changes = 1 + Below(4); changes > 0; --changes) Change(bytes);
    }
    bytes.resize(std::max(bytes.size(), kHeaderBytes));  // Less is not passed on at all.
    return bytes;
  }
  std::uint64_t Below(std::uint64_t bound) { return bound == 0 ? 0 : random_() % bound; }

 private:
  static constexpr std::array<std::uint32_t, 12> kWords = {
      0, 1, 2, 5, 16, 33, 64, 257, 20'001, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF};

  static void Truncate(Bytes& bytes, std::size_t size, bool length_too) {
    bytes.resize(std::min(bytes.size(), size));
    if (length_too && bytes.size() >= kHeaderBytes + kLengthBytes) {
      PutWord(bytes, kHeaderBytes,
              static_cast<std::uint32_t>(bytes.size() - kHeaderBytes - kLengthBytes));
    }
  }
  std::uint8_t AnyByte() { return static_cast<std::uint8_t>(random_()); }
  void Change(Bytes& bytes) {
    const std::size_t at = Below(bytes.size());
    switch (Below(8)) {
      case 0:
        return Truncate(bytes, at, Below(4) != 0);
      case 1:  // Encapsulations: most that exist, or anything.
        bytes.resize(std::max(bytes.size(), kHeaderBytes));
        bytes[Below(8) == 0 ? Below(kHeaderBytes) : 1] = static_cast<std::uint8_t>(Below(16));
        return;
      case 2:
        return PutWord(bytes, at / 4 * 4, kWords[Below(kWords.size())]);
      case 3:
        return PutWord(bytes, at / 4 * 4, static_cast<std::uint32_t>(Below(600)));
      case 4:
        bytes[at] = static_cast<std::uint8_t>(Below(16));
        return;
      case 5:
        bytes[at] = AnyByte();
        return;
      case 6:
        std::for_each(bytes.begin() + std::ptrdiff_t(at),
                      bytes.begin() + std::ptrdiff_t(std::min(bytes.size(), at + Below(40))),
                      [this](std::uint8_t& byte) { byte = AnyByte(); });
        return;
      default:
        bytes.insert(bytes.begin() + std::ptrdiff_t(at), Below(24), AnyByte());
        return;
    }
  }

  const Bytes seed_;
  std::uint64_t step_ = 0;
  std::mt19937_64 random_{kSeed};
};

/// The rest holds for a message that our checks let through, written down anew.
template <typename Enum>
bool IsOneOf(Enum value, int count) {
  return static_cast<int>(value) < count;
}
bool IsShort(const std::string& text, std::size_t most) {
  return text.size() <= most &&
         std::ranges::all_of(text, [](char c) { return static_cast<unsigned char>(c) >= 0x20; });
}
/// Kelvin per count and kelvin of count 0 that some camera may have.
bool IsSound(const RadiometricScale& scale) {
  return scale.kelvin_per_count > 0.0 && scale.kelvin_per_count <= 1.0 &&
         std::abs(scale.offset_kelvin) <= 10'000.0;
}
template <typename Frame>
bool IsFrame(const Frame& frame) {
  const EncodedImage& image = frame.image;
  return image.width > 0 && image.height > 0 && image.width <= 16384 && image.height <= 16384 &&
         std::int64_t{image.width} * image.height <= 4'194'304 && IsOneOf(image.encoding, 10) &&
         !image.payload.empty() && image.payload.size() <= 8'388'608 &&
         ToNanoseconds(frame.header.capture_time) >= 0 && frame.header.capture_sigma.count() >= 0;
}
bool IsSound(const EncodedDepthFrame& frame) {
  return IsFrame(frame) && frame.depth_scale > 0.0 && std::isfinite(frame.depth_scale);
}
bool IsSound(const EncodedThermalFrame& frame) {
  return IsFrame(frame) && IsOneOf(frame.nuc_source, 5) && IsOneOf(frame.nuc_state, 8) &&
         !std::isinf(frame.housekeeping.housing_celsius) && IsSound(frame.scale);
}
bool IsSound(const RigDescription& rig) {
  const bool modes = rig.depth.width >= 0 && rig.thermal.height >= 0 &&
                     std::int64_t{rig.depth.width} * rig.depth.height <= 4'194'304 &&
                     IsOneOf(rig.depth.encoding, 10) && IsOneOf(rig.thermal.encoding, 10);
  return modes && IsSound(rig.rig.thermal_scale) && IsShort(rig.rig.serial, 256) &&
         IsShort(rig.thermal.model, 256) &&
         (!rig.rig.depth || (rig.rig.depth->width > 0 && std::isfinite(rig.rig.depth->fx)));
}
bool IsSound(const ExternalOdometrySample& sample) {
  return ToNanoseconds(sample.pose.time) >= 0 && IsShort(sample.pose.source, 32);
}
bool IsSound(const EdgeStatus& status) {
  return IsOneOf(status.scan_state, 3) && IsOneOf(status.publish_policy, 2) &&
         IsOneOf(status.nuc.state, 8) && IsOneOf(status.nuc.source, 5) &&
         IsOneOf(status.nuc.policy, 3) && IsOneOf(status.depth_camera.state, 4) &&
         status.depth.dropped.size() <= 16 && std::isfinite(status.thermal.rate_hz) &&
         IsShort(status.nuc.reason, 256) && status.marks.size() <= kMaxMarks &&
         std::ranges::all_of(status.marks, [](const ScanMark& mark) {
           return IsShort(mark.text, kMaxMarkBytes) && ToNanoseconds(mark.time) >= 0;
         });
}
bool IsSound(const Command& command) {
  return IsOneOf(command.kind, 7) && IsOneOf(command.nuc_policy, 3) &&
         IsOneOf(command.publish_policy, 2) && std::isfinite(command.hold_s) &&
         IsShort(command.text, kMaxMarkBytes);
}
bool IsSound(const CommandResult& result) {
  return IsOneOf(result.outcome, 3) && IsShort(result.text, 256);
}
bool IsSound(const Receipt& receipt) {
  return receipt.depth.handled <= receipt.depth.next && receipt.thermal.holes.size() <= 64 &&
         IsOneOf(receipt.verdict, 2);
}
bool IsSound(const FramePiece& piece) {
  return IsOneOf(piece.sensor, 2) && piece.bytes.size() >= kMinFramePieceBytes &&
         piece.bytes.size() <= kMaxFramePieceBytes && piece.frame_bytes > 0 &&
         piece.frame_bytes <= kMaxPiecedFrameBytes && piece.sent.count() >= 0;
}
bool IsSound(const PieceReport& report) {
  return report.received <= report.next_order && report.frames <= report.received &&
         report.broken <= report.received && report.queued.count() >= 0;
}
bool IsSound(const Feedback& feedback) {
  return IsOneOf(feedback.tracking_state, 4) && feedback.advice.size() <= 8 &&
         std::ranges::all_of(feedback.advice, [](Advice a) { return IsOneOf(a, 8); }) &&
         feedback.image.size() <= 20'000 && feedback.latencies.size() <= 16 &&
         std::isfinite(feedback.covered_area_m2) && IsShort(feedback.advice_reason, 256) &&
         IsShort(feedback.link, 256);
}
bool IsSound(const Hello& hello) {
  return IsOneOf(hello.role, 2) && IsShort(hello.host, 256) && IsShort(hello.software_version, 256);
}
bool IsSound(const RecordingRequest& request) {
  return IsOneOf(request.kind, 4) && IsShort(request.recording, 256) &&
         request.offset <= std::uint64_t{1} << 60U &&
         request.length <= (request.kind == RecordingRequestKind::kChecksum ? 4U << 20U : 65'536U);
}
bool IsSound(const RecordingPiece& piece) {
  return IsOneOf(piece.outcome, 5) && IsShort(piece.recording, 256) &&
         piece.bytes.size() <= 65'536 && ToNanoseconds(piece.written) >= 0 &&
         piece.size <= std::uint64_t{1} << 60U && piece.offset <= std::uint64_t{1} << 60U;
}

struct Outcome {
  std::uint64_t undecodable = 0;  ///< Refused by the middleware.
  std::uint64_t refused = 0;      ///< By our checks.
  std::uint64_t accepted = 0;
};

/// One topic inside this process: how the middleware decodes it.
template <typename Message>
class ReceivePath {
 public:
  using Wire = typename TopicOf<Message>::Wire;

  ReceivePath(dds_entity_t participant, const dds_topic_descriptor_t& descriptor)
      : descriptor_(descriptor) {
    const dds_entity_t topic = dds_create_topic(participant, &descriptor, "t", nullptr, nullptr);
    const dds_entity_t reader = dds_create_reader(participant, topic, nullptr, nullptr);
    const dds_entity_t writer = dds_create_writer(participant, topic, nullptr, nullptr);
    const Message good = Good<Message>();
    Wire wire{};
    CopyText("edge", wire.edge_id);
    ToWire(good, &wire);
    SetMark(&wire);
    CHECK(dds_write(writer, &wire) == DDS_RETCODE_OK);
    dds_sample_free(&wire, &descriptor_, DDS_FREE_CONTENTS);
    dds_sample_info_t info{};
    CHECK(dds_takecdr(reader, &example_, 1, &info, DDS_ANY_STATE) == 1);
  }
  ReceivePath(const ReceivePath&) = delete;
  ReceivePath& operator=(const ReceivePath&) = delete;
  ~ReceivePath() {
    dds_sample_free(&wire_, &descriptor_, DDS_FREE_CONTENTS);
    ddsi_serdata_unref(example_);
  }

  /// The good message as it crosses the network.
  Bytes seed() const {
    Bytes bytes(ddsi_serdata_size(example_));
    ddsi_serdata_to_ser(example_, 0, bytes.size(), bytes.data());
    return bytes;
  }

  /// As a message, the way that Reader::Take has it.
  void Receive(const Bytes& bytes) {
    ddsi_serdata* data = Decode(bytes, SDK_DATA);
    if (data == nullptr) {
      ++outcome_.undecodable;
      return;
    }
    CHECK(ddsi_serdata_to_sample(data, &wire_, nullptr, nullptr));
    Message message;
    if (isotherm::Receive(wire_, &message)) {
      ++outcome_.refused;
    } else {
      ++outcome_.accepted;
      EXPECT_TRUE(IsSound(message));
      EXPECT_LE(ReadText(wire_.edge_id).size(), kMaxIdBytes);
    }
    ddsi_serdata_unref(data);
  }
  /// As the key of a rig that is said to have left, and as that of a message.
  void ReceiveKey(const Bytes& bytes, bool whole) {
    ddsi_serdata* data = Decode(bytes, whole ? SDK_DATA : SDK_KEY);
    if (data == nullptr) return;
    ddsi_serdata* key = ddsi_serdata_to_untyped(data);
    Wire wire{};
    CHECK(ddsi_serdata_untyped_to_sample(example_->type, key, &wire, nullptr, nullptr));
    EXPECT_LE(ReadText(wire.edge_id).size(), kMaxIdBytes);
    dds_sample_free(&wire, &descriptor_, DDS_FREE_CONTENTS);
    ddsi_serdata_unref(key);
    ddsi_serdata_unref(data);
  }
  const Outcome& outcome() const { return outcome_; }

 private:
  /// One packet as the receive thread hands it on.
  ddsi_serdata* Decode(const Bytes& bytes, ddsi_serdata_kind kind) {
    packet_.resize(sizeof(nn_rmsg) + bytes.size());
    std::memcpy(packet_.data() + sizeof(nn_rmsg), bytes.data(), bytes.size());
    nn_rdata fragment{};
    fragment.rmsg = reinterpret_cast<nn_rmsg*>(packet_.data());
    fragment.maxp1 = static_cast<std::uint32_t>(bytes.size());
    return ddsi_serdata_from_ser(example_->type, kind, &fragment, bytes.size());
  }

  const dds_topic_descriptor_t& descriptor_;
  ddsi_serdata* example_ = nullptr;
  Bytes packet_;
  Wire wire_{};  // Reused, as Reader does.
  Outcome outcome_;
};

class ReceivePathTest : public ::testing::Test {
 protected:
  ReceivePathTest()
      : participant_(dds_create_participant(static_cast<dds_domainid_t>(domain_.number()), nullptr,
                                            nullptr)) {
    CHECK(participant_ > 0);
  }
  ~ReceivePathTest() override { dds_delete(participant_); }

  template <typename Message>
  void Run(const dds_topic_descriptor_t& descriptor) {
    ReceivePath<Message> path(participant_, descriptor);
    path.Receive(path.seed());
    EXPECT_EQ(path.outcome().accepted, 1U) << "the good one";
    Mutator mutator(path.seed());
    const std::uint64_t inputs = InputsPerTopic();
    for (std::uint64_t i = 0; i < inputs; ++i) {
      const Bytes bytes = mutator.Next();
      path.Receive(bytes);
      if (i % 8 == 0) path.ReceiveKey(bytes, i % 16 == 0);
      if (HasFailure()) FAIL() << "input " << i << ": " << ::testing::PrintToString(bytes);
    }
    const Outcome& outcome = path.outcome();
    std::cout << descriptor.m_typename << ": " << inputs << " inputs, " << outcome.undecodable
              << " refused by the middleware, " << outcome.refused << " by us, " << outcome.accepted
              << " good\n";
    // Otherwise it is not the receive path that was tried.
    EXPECT_GT(outcome.undecodable, inputs / 100);
    EXPECT_GT(outcome.accepted, inputs / 100);
    EXPECT_GT(outcome.refused, inputs / 1000);
  }

  SystemClock clock_;
  TransportEnvironment environment_{clock_};
  TestDomain domain_;
  dds_entity_t participant_;
};

TEST_F(ReceivePathTest, F60AnyBytesAsADepthFrame) {
  Run<EncodedDepthFrame>(isotherm_wire_DepthFrame_desc);
}
TEST_F(ReceivePathTest, F60AnyBytesAsAThermalFrame) {
  Run<EncodedThermalFrame>(isotherm_wire_ThermalFrame_desc);
}
TEST_F(ReceivePathTest, F60AnyBytesAsARig) { Run<RigDescription>(isotherm_wire_Rig_desc); }
TEST_F(ReceivePathTest, F60AnyBytesAsExternalOdometry) {
  Run<ExternalOdometrySample>(isotherm_wire_ExternalOdometry_desc);
}
TEST_F(ReceivePathTest, F60AnyBytesAsARequestForARecording) {
  Run<RecordingRequest>(isotherm_wire_RecordingRequest_desc);
}
TEST_F(ReceivePathTest, F60AnyBytesAsAPieceOfARecording) {
  Run<RecordingPiece>(isotherm_wire_RecordingPiece_desc);
}
TEST_F(ReceivePathTest, F60AnyBytesAsAPieceOfAFrame) {
  Run<FramePiece>(isotherm_wire_FramePiece_desc);
}
TEST_F(ReceivePathTest, F60AnyBytesAsAReportOfPieces) {
  Run<PieceReport>(isotherm_wire_PieceReport_desc);
}
TEST_F(ReceivePathTest, F60AnyBytesAsAStatus) { Run<EdgeStatus>(isotherm_wire_EdgeStatus_desc); }
TEST_F(ReceivePathTest, F60AnyBytesAsACommand) { Run<Command>(isotherm_wire_Command_desc); }
TEST_F(ReceivePathTest, F60AnyBytesAsAnAnswer) {
  Run<CommandResult>(isotherm_wire_CommandResult_desc);
}
TEST_F(ReceivePathTest, F60AnyBytesAsAReceipt) { Run<Receipt>(isotherm_wire_Receipt_desc); }
TEST_F(ReceivePathTest, F60AnyBytesAsFeedback) { Run<Feedback>(isotherm_wire_Feedback_desc); }
TEST_F(ReceivePathTest, F60AnyBytesAsAHello) { Run<Hello>(isotherm_wire_Hello_desc); }

}  // namespace
}  // namespace isotherm
