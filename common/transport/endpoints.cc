#include "common/transport/endpoints.h"

#include <dds/dds.h>
#include <dds/ddsc/dds_statistics.h>
#include <fmt/format.h>
#include <isotherm_control.h>
#include <isotherm_frames.h>
#include <isotherm_pieces.h>
#include <isotherm_recordings.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "common/base/log.h"
#include "common/transport/bounded_text.h"
#include "common/transport/conversions.h"
#include "common/transport/instance_limit.h"
#include "common/transport/peer_guid.h"
#include "common/transport/qos.h"

namespace isotherm {
namespace {

const dds_topic_descriptor_t* DescriptorOf(TopicId topic) {
  switch (topic) {
    case TopicId::kDepth:
    case TopicId::kBackfillDepth:
      return &isotherm_wire_DepthFrame_desc;
    case TopicId::kThermal:
    case TopicId::kBackfillThermal:
      return &isotherm_wire_ThermalFrame_desc;
    case TopicId::kRig:
      return &isotherm_wire_Rig_desc;
    case TopicId::kEdgeStatus:
      return &isotherm_wire_EdgeStatus_desc;
    case TopicId::kCommand:
      return &isotherm_wire_Command_desc;
    case TopicId::kCommandResult:
      return &isotherm_wire_CommandResult_desc;
    case TopicId::kReceipt:
      return &isotherm_wire_Receipt_desc;
    case TopicId::kFeedback:
      return &isotherm_wire_Feedback_desc;
    case TopicId::kRecordingRequest:
      return &isotherm_wire_RecordingRequest_desc;
    case TopicId::kRecordingPiece:
      return &isotherm_wire_RecordingPiece_desc;
    case TopicId::kFramePiece:
      return &isotherm_wire_FramePiece_desc;
    case TopicId::kPieceReport:
      return &isotherm_wire_PieceReport_desc;
    case TopicId::kHello:
      return &isotherm_wire_Hello_desc;
    case TopicId::kExternalOdometry:
      return &isotherm_wire_ExternalOdometry_desc;
  }
  return nullptr;
}

Status CreationFailed(std::string_view kind, TopicId topic, std::int32_t code) {
  return Internal(
      fmt::format("cannot create a {} of {}: {}", kind, TopicName(topic), dds_strretcode(code)));
}

Status CreateTopic(const Participant& participant, TopicId topic, DdsHandle* handle) {
  const QosPtr qos = MakeQos(topic);
  *handle = DdsHandle(dds_create_topic(participant.handle(), DescriptorOf(topic), TopicName(topic),
                                       qos.get(), nullptr));
  return handle->value() > 0 ? OkStatus() : CreationFailed("topic", topic, handle->value());
}

/// Takes what dds_get_matched_*_data gives; may be null.
PeerHandle TakePeer(dds_builtintopic_endpoint_t* endpoint) {
  if (endpoint == nullptr) return 0;
  const PeerHandle peer = PeerOfGuid(endpoint->participant_key);
  dds_builtintopic_free_endpoint(endpoint);
  return peer;
}

/// A wire struct with the lists that ToWire allocated.
template <typename Message>
struct WireSample {
  using Wire = typename TopicOf<Message>::Wire;
  WireSample() = default;
  WireSample(const WireSample&) = delete;
  WireSample& operator=(const WireSample&) = delete;
  ~WireSample() { dds_sample_free(&wire, DescriptorOf(TopicOf<Message>::kId), DDS_FREE_CONTENTS); }
  Wire wire{};
};

}  // namespace

template <typename Message>
Status Writer<Message>::Open(const Participant& participant) {
  constexpr TopicId kTopic = TopicOf<Message>::kId;
  ISOTHERM_RETURN_IF_ERROR(CreateTopic(participant, kTopic, &topic_));
  const QosPtr qos = MakeQos(kTopic);
  writer_ = DdsHandle(dds_create_writer(participant.handle(), topic_.value(), qos.get(), nullptr));
  return writer_.value() > 0 ? OkStatus() : CreationFailed("writer", kTopic, writer_.value());
}

template <typename Message>
Status Writer<Message>::Write(std::string_view edge_id, const Message& message) {
  constexpr TopicId kTopic = TopicOf<Message>::kId;
  if (edge_id.empty() || edge_id.size() > kMaxIdBytes) {
    return InvalidArgument(
        fmt::format("edge_id \"{}\" must have 1 to {} bytes", edge_id, kMaxIdBytes));
  }
  WireSample<Message> sample;
  CopyText(edge_id, sample.wire.edge_id);
  ToWire(message, &sample.wire);
  SetMark(&sample.wire);
  const dds_return_t code = dds_write(writer_.value(), &sample.wire);
  if (code == DDS_RETCODE_OK) return OkStatus();
  const std::string text = fmt::format("{}: {}", TopicName(kTopic), dds_strretcode(code));
  // Callers tell the two apart: a frame that met slow readers is dropped and counted, one that is
  // too large will be each time.
  if (code == DDS_RETCODE_TIMEOUT) return Unavailable(text + " (readers too slow)");
  if (code == DDS_RETCODE_BAD_PARAMETER) return InvalidArgument(text + " (message too large)");
  return Internal(text);
}

template <typename Message>
Status Writer<Message>::ForgetPast(std::string_view edge_id) {
  WireSample<Message> key;
  CopyText(edge_id, key.wire.edge_id);
  const dds_return_t code = dds_unregister_instance(writer_.value(), &key.wire);
  // The second: there was none.
  if (code == DDS_RETCODE_OK || code == DDS_RETCODE_PRECONDITION_NOT_MET) return OkStatus();
  const std::string text =
      fmt::format("{}: {}", TopicName(TopicOf<Message>::kId), dds_strretcode(code));
  return code == DDS_RETCODE_TIMEOUT ? Unavailable(text) : Internal(text);
}

template <typename Message>
int Writer<Message>::matched_readers() const {
  dds_publication_matched_status_t status{};
  if (dds_get_publication_matched_status(writer_.value(), &status) != DDS_RETCODE_OK) return 0;
  return static_cast<int>(status.current_count);
}

template <typename Message>
std::uint64_t Writer<Message>::repeated_bytes() const {
  const std::unique_ptr<dds_statistics, decltype(&dds_delete_statistics)> statistics(
      dds_create_statistics(writer_.value()), &dds_delete_statistics);
  if (!statistics) return 0;
  const dds_stat_keyvalue* bytes = dds_lookup_statistic(statistics.get(), "rexmit_bytes");
  return bytes != nullptr && bytes->kind == DDS_STAT_KIND_UINT64 ? bytes->u.u64 : 0;
}

template <typename Message>
bool Writer<Message>::Reaches(PeerHandle peer) const {
  // More readers of one topic than a network of rigs has; those beyond are not known.
  constexpr std::size_t kMaxReaders = 64;
  std::array<dds_instance_handle_t, kMaxReaders> readers{};
  const dds_return_t count =
      dds_get_matched_subscriptions(writer_.value(), readers.data(), readers.size());
  const auto known = std::clamp<std::ptrdiff_t>(count, 0, kMaxReaders);
  return peer != 0 && std::any_of(readers.begin(), readers.begin() + known, [&](auto reader) {
           return TakePeer(dds_get_matched_subscription_data(writer_.value(), reader)) == peer;
         });
}

template <typename Message>
bool Writer<Message>::WaitForAcknowledgments(Nanoseconds timeout) const {
  return dds_wait_for_acks(writer_.value(), timeout.count()) == DDS_RETCODE_OK;
}

// Names that are only taken back (dds_dispose) never come by the filter below, and the middleware
// keeps some 0.6 kB of each as long as their writer lives. Beyond so many the reader is made anew,
// which frees them: 2.5 MB for a topic.
constexpr int kMaxTakenBack = 4'096;

/// A reader gets this much of the time before it was there.
enum class Past : std::uint8_t { kKept, kNone };

template <typename Message>
struct Reader<Message>::Impl {
  static constexpr TopicId kTopic = TopicOf<Message>::kId;

  InstanceLimit limit;  // Outlives the reader, whose threads ask it.
  RefusalCounter* refusals = nullptr;
  std::int32_t participant = 0;
  std::int32_t wait_set = 0;  ///< 0: nobody waits.
  DdsHandle topic;
  DdsHandle reader;
  DdsHandle condition;
  DdsHandle publications;      ///< All that the participant knows of; there while it is flooded.
  std::uint64_t flooding = 0;  ///< The writer that floods it with names; 0: none.
  int taken_back = 0;          ///< Names that the reader has state of, and no sample.
  bool is_closed = false;      ///< It could not be made anew, and is tried again.
  WireSample<Message> sample;  // Reused, so that its payload buffer is allocated once.

  Status OpenReader(Past past) {
    condition = DdsHandle();
    reader = DdsHandle();
    limit.Clear();
    taken_back = 0;
    const QosPtr qos = MakeReaderQos(kTopic);
    if (past == Past::kNone) dds_qset_durability(qos.get(), DDS_DURABILITY_VOLATILE);
    reader = DdsHandle(dds_create_reader(participant, topic.value(), qos.get(), nullptr));
    if (reader.value() < 0) return CreationFailed("reader", kTopic, reader.value());
    condition = DdsHandle(dds_create_readcondition(reader.value(), DDS_ANY_STATE));
    if (condition.value() < 0) return CreationFailed("read condition", kTopic, condition.value());
    return wait_set > 0 ? Attach() : OkStatus();
  }
  Status Attach() const {
    const dds_return_t code = dds_waitset_attach(wait_set, condition.value(), 0);
    if (code == DDS_RETCODE_OK) return OkStatus();
    return Internal(fmt::format("cannot attach to a DDS wait set: {}", dds_strretcode(code)));
  }

  /// A name was taken back, or all its writers are gone.
  void OnWithoutData(const dds_sample_info_t& info) {
    if (info.instance_state == DDS_NOT_ALIVE_NO_WRITERS_INSTANCE_STATE) {
      limit.Forget(info.instance_handle);
    } else if (info.instance_state == DDS_NOT_ALIVE_DISPOSED_INSTANCE_STATE &&
               !limit.Knows(info.instance_handle)) {
      ++taken_back;
      if (taken_back == kMaxTakenBack) flooding = info.publication_handle;
    }
  }
  void Reopen(Past past) {
    const Status status = OpenReader(past);
    if (!status.ok() && !is_closed) {
      LOG(Transport, Error) << status.message();
    }
    is_closed = !status.ok();
  }
  /// While the writer that floods it is there, its past would flood it again, so that it does
  /// without any: what comes from now on comes, and rigs that start meanwhile may not be seen.
  void Heal() {
    if (taken_back >= kMaxTakenBack) {
      refusals->Add(RefusalCause::kTooManyNames, TopicName(kTopic));
      publications = DdsHandle(
          dds_create_reader(participant, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr));
      Reopen(Past::kNone);
    } else if (flooding != 0 && !IsThere(flooding)) {
      flooding = 0;
      publications = DdsHandle();
      Reopen(Past::kKept);
    } else if (is_closed) {
      Reopen(flooding != 0 ? Past::kNone : Past::kKept);
    }
  }
  /// Returns whether a writer is known to the participant, matched or not.
  bool IsThere(std::uint64_t writer) const {
    void* samples[1] = {nullptr};
    dds_sample_info_t info{};
    const dds_return_t count =
        dds_read_instance(publications.value(), samples, &info, 1, 1, writer);
    if (count > 0) dds_return_loan(publications.value(), samples, count);
    return count > 0 && info.instance_state == DDS_ALIVE_INSTANCE_STATE;
  }

  /// Asked by the middleware before it keeps anything of a sample.
  static bool Admit(const dds_sample_info_t* info, void* self) {
    auto* impl = static_cast<Impl*>(self);
    if (impl->limit.Admit(info->publication_handle, info->instance_handle)) return true;
    impl->refusals->Add(RefusalCause::kTooManyNames, TopicName(TopicOf<Message>::kId));
    return false;
  }
  Status SetFilter() {
    dds_topic_filter filter{};
    filter.mode = DDS_TOPIC_FILTER_SAMPLEINFO_ARG;
    filter.f.sampleinfo_arg = &Impl::Admit;
    filter.arg = this;
    const dds_return_t code = dds_set_topic_filter_extended(topic.value(), &filter);
    return code == DDS_RETCODE_OK ? OkStatus()
                                  : CreationFailed("filter", TopicOf<Message>::kId, code);
  }

  void Accept(const std::function<void(Received<Message>&&)>& handle, std::uint64_t writer) {
    Received<Message> received;
    received.writer = writer;
    received.edge_id = ReadText(sample.wire.edge_id);
    // Everything from the link is checked before it is used; the sender may be anybody.
    if (const auto cause = isotherm::Receive(sample.wire, &received.message)) {
      refusals->Add(*cause, fmt::format("topic={} edge_id={}", TopicName(TopicOf<Message>::kId),
                                        received.edge_id));
      return;
    }
    handle(std::move(received));
  }
};

template <typename Message>
Reader<Message>::Reader() = default;
template <typename Message>
Reader<Message>::Reader(Reader&&) noexcept = default;
template <typename Message>
Reader<Message>& Reader<Message>::operator=(Reader&&) noexcept = default;
template <typename Message>
Reader<Message>::~Reader() = default;

template <typename Message>
Status Reader<Message>::Open(const Participant& participant, RefusalCounter* refusals) {
  constexpr TopicId kTopic = TopicOf<Message>::kId;
  auto impl = std::make_unique<Impl>();
  impl->refusals = refusals;
  impl->participant = participant.handle();
  ISOTHERM_RETURN_IF_ERROR(CreateTopic(participant, kTopic, &impl->topic));
  ISOTHERM_RETURN_IF_ERROR(impl->SetFilter());  // Before the reader is there.
  ISOTHERM_RETURN_IF_ERROR(impl->OpenReader(Past::kKept));
  impl_ = std::move(impl);
  return OkStatus();
}

template <typename Message>
int Reader<Message>::Take(const std::function<void(Received<Message>&&)>& handle, int max_samples) {
  int taken = 0;
  while (taken < max_samples) {
    void* samples[1] = {&impl_->sample.wire};
    dds_sample_info_t info{};
    // One at a time: a batch would keep as many large samples alive at once.
    if (dds_take(impl_->reader.value(), samples, &info, 1, 1) <= 0) break;
    ++taken;
    if (info.instance_state == DDS_NOT_ALIVE_NO_WRITERS_INSTANCE_STATE || !info.valid_data)
      impl_->OnWithoutData(info);
    if (info.valid_data) impl_->Accept(handle, info.publication_handle);
  }
  impl_->Heal();
  return taken;
}

template <typename Message>
int Reader<Message>::matched_writers() const {
  dds_liveliness_changed_status_t status{};
  if (dds_get_liveliness_changed_status(impl_->reader.value(), &status) != DDS_RETCODE_OK) return 0;
  return static_cast<int>(status.alive_count);
}

template <typename Message>
PeerHandle Reader<Message>::PeerOf(std::uint64_t writer) const {
  return TakePeer(dds_get_matched_publication_data(impl_->reader.value(), writer));
}

template <typename Message>
Status Reader<Message>::AttachTo(std::int32_t wait_set) const {
  impl_->wait_set = wait_set;
  return impl_->Attach();
}

template class Writer<EncodedDepthFrame>;
template class Writer<EncodedThermalFrame>;
template class Writer<Backfilled<EncodedDepthFrame>>;
template class Writer<Backfilled<EncodedThermalFrame>>;
template class Writer<RigDescription>;
template class Writer<ExternalOdometrySample>;
template class Writer<EdgeStatus>;
template class Writer<Command>;
template class Writer<CommandResult>;
template class Writer<Receipt>;
template class Writer<Feedback>;
template class Writer<Hello>;
template class Writer<RecordingRequest>;
template class Writer<RecordingPiece>;
template class Writer<FramePiece>;
template class Writer<PieceReport>;

template class Reader<EncodedDepthFrame>;
template class Reader<EncodedThermalFrame>;
template class Reader<Backfilled<EncodedDepthFrame>>;
template class Reader<Backfilled<EncodedThermalFrame>>;
template class Reader<RigDescription>;
template class Reader<ExternalOdometrySample>;
template class Reader<EdgeStatus>;
template class Reader<Command>;
template class Reader<CommandResult>;
template class Reader<Receipt>;
template class Reader<Feedback>;
template class Reader<Hello>;
template class Reader<RecordingRequest>;
template class Reader<RecordingPiece>;
template class Reader<FramePiece>;
template class Reader<PieceReport>;

}  // namespace isotherm
