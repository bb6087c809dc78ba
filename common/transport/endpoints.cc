#include "common/transport/endpoints.h"

#include <dds/dds.h>
#include <fmt/format.h>
#include <isotherm_control.h>
#include <isotherm_frames.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "common/transport/bounded_text.h"
#include "common/transport/conversions.h"
#include "common/transport/instance_limit.h"
#include "common/transport/qos.h"

namespace isotherm {
namespace {

const dds_topic_descriptor_t* DescriptorOf(TopicId topic) {
  switch (topic) {
    case TopicId::kDepth:
      return &isotherm_wire_DepthFrame_desc;
    case TopicId::kThermal:
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
    case TopicId::kHello:
      return &isotherm_wire_Hello_desc;
    case TopicId::kExternalOdometry:
      return &isotherm_wire_OutsidePose_desc;
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

/// Takes what dds_get_matched_*_data gives; may be null. Made from the participant's GUID (FNV-1a):
/// when an outage lets the middleware forget a participant, it comes back with another instance
/// handle, but with the same GUID.
PeerHandle TakePeer(dds_builtintopic_endpoint_t* endpoint) {
  if (endpoint == nullptr) return 0;
  PeerHandle peer = 0xCBF29CE484222325ULL;
  for (const std::uint8_t byte : endpoint->participant_key.v) {
    peer = (peer ^ byte) * 0x100000001B3ULL;
  }
  dds_builtintopic_free_endpoint(endpoint);
  // 0 means that nobody is known.
  return peer == 0 ? 1 : peer;
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
int Writer<Message>::matched_readers() const {
  dds_publication_matched_status_t status{};
  if (dds_get_publication_matched_status(writer_.value(), &status) != DDS_RETCODE_OK) return 0;
  return static_cast<int>(status.current_count);
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

template <typename Message>
struct Reader<Message>::Impl {
  InstanceLimit limit;  // Outlives the reader, whose threads ask it.
  RefusalCounter* refusals = nullptr;
  DdsHandle topic;
  DdsHandle reader;
  DdsHandle condition;
  WireSample<Message> sample;  // Reused, so that its payload buffer is allocated once.

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
  ISOTHERM_RETURN_IF_ERROR(CreateTopic(participant, kTopic, &impl->topic));
  ISOTHERM_RETURN_IF_ERROR(impl->SetFilter());  // Before the reader is there.
  const QosPtr qos = MakeReaderQos(kTopic);
  impl->reader =
      DdsHandle(dds_create_reader(participant.handle(), impl->topic.value(), qos.get(), nullptr));
  if (impl->reader.value() < 0) return CreationFailed("reader", kTopic, impl->reader.value());
  impl->condition = DdsHandle(dds_create_readcondition(impl->reader.value(), DDS_ANY_STATE));
  if (impl->condition.value() < 0) {
    return CreationFailed("read condition", kTopic, impl->condition.value());
  }
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
    if (info.instance_state == DDS_NOT_ALIVE_NO_WRITERS_INSTANCE_STATE) {
      impl_->limit.Forget(info.instance_handle);
    }
    // Otherwise a writer came or left.
    if (info.valid_data) impl_->Accept(handle, info.publication_handle);
  }
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
std::int32_t Reader<Message>::read_condition() const {
  return impl_->condition.value();
}

template class Writer<EncodedDepthFrame>;
template class Writer<EncodedThermalFrame>;
template class Writer<RigDescription>;
template class Writer<ExternalOdometrySample>;
template class Writer<EdgeStatus>;
template class Writer<Command>;
template class Writer<CommandResult>;
template class Writer<Receipt>;
template class Writer<Feedback>;
template class Writer<Hello>;

template class Reader<EncodedDepthFrame>;
template class Reader<EncodedThermalFrame>;
template class Reader<RigDescription>;
template class Reader<ExternalOdometrySample>;
template class Reader<EdgeStatus>;
template class Reader<Command>;
template class Reader<CommandResult>;
template class Reader<Receipt>;
template class Reader<Feedback>;
template class Reader<Hello>;

}  // namespace isotherm
