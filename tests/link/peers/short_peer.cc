// A peer whose types end too early, for tests: short_peer DOMAIN EDGE_ID. An ordinary DDS program
// that writes short_types.idl under the topics and the type names of the link, all over and over,
// and stays. Prints "delivered TOPIC" when all its writers of a topic have readers that have
// acknowledged what they wrote.
#include <dds/dds.h>
#include <short_types.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <thread>
#include <vector>

#include "common/base/check.h"
#include "common/transport/qos.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;

// Without the limits of the shipped profiles.
constexpr const char* kProfile =
    "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name=\"lo\"/></Interfaces>"
    "</General></Domain></CycloneDDS>";
constexpr auto kRound = 100ms;
constexpr dds_duration_t kPatience = DDS_SECS(2);

using Types = std::vector<const dds_topic_descriptor_t*>;

struct ShortTopic {
  TopicId topic;
  const char* type_name;
  Types types;
};

const std::vector<ShortTopic>& ShortTopics() {
  static const std::vector<ShortTopic> topics = {
      {TopicId::kDepth,
       "isotherm::wire::DepthFrame",
       {&ends_early_NameOnly_desc, &ends_early_Depth1_desc, &ends_early_Depth2_desc,
        &ends_early_Depth3_desc}},
      {TopicId::kThermal,
       "isotherm::wire::ThermalFrame",
       {&ends_early_NameOnly_desc, &ends_early_Thermal1_desc, &ends_early_Thermal2_desc}},
      {TopicId::kExternalOdometry,
       "isotherm::wire::ExternalOdometry",
       {&ends_early_NameOnly_desc, &ends_early_ExternalOdometry1_desc,
        &ends_early_ExternalOdometry2_desc}},
      {TopicId::kRig,
       "isotherm::wire::Rig",
       {&ends_early_NameOnly_desc, &ends_early_Rig1_desc, &ends_early_Rig2_desc,
        &ends_early_Rig3_desc, &ends_early_Rig4_desc, &ends_early_Rig5_desc}},
      {TopicId::kEdgeStatus,
       "isotherm::wire::EdgeStatus",
       {&ends_early_NameOnly_desc, &ends_early_EdgeStatus1_desc, &ends_early_EdgeStatus2_desc,
        &ends_early_EdgeStatus3_desc, &ends_early_EdgeStatus4_desc}},
      {TopicId::kCommand,
       "isotherm::wire::Command",
       {&ends_early_NameOnly_desc, &ends_early_Command1_desc}},
      {TopicId::kRecordingRequest,
       "isotherm::wire::RecordingRequest",
       {&ends_early_NameOnly_desc, &ends_early_RecordingRequest1_desc}},
      {TopicId::kCommandResult,
       "isotherm::wire::CommandResult",
       {&ends_early_NameOnly_desc, &ends_early_CommandResult1_desc}},
      {TopicId::kReceipt,
       "isotherm::wire::Receipt",
       {&ends_early_NameOnly_desc, &ends_early_Receipt1_desc, &ends_early_Receipt2_desc}},
      {TopicId::kFeedback,
       "isotherm::wire::Feedback",
       {&ends_early_NameOnly_desc, &ends_early_Feedback1_desc, &ends_early_Feedback2_desc,
        &ends_early_Feedback3_desc, &ends_early_Feedback4_desc, &ends_early_Feedback5_desc}},
      {TopicId::kHello, "isotherm::wire::Hello", {&ends_early_NameOnly_desc}},
  };
  return topics;
}

constexpr std::size_t kMaxTypes = 6;  // Of one topic.

/// The writers of one topic.
class ShortWriters {
 public:
  /// One participant per type, because within one a topic has one type.
  ShortWriters(const std::array<dds_entity_t, kMaxTypes>& participants, const ShortTopic& topic)
      : topic_(topic) {
    const QosPtr qos = MakeQos(topic.topic);
    for (std::size_t i = 0; i < topic.types.size(); ++i) {
      dds_topic_descriptor_t descriptor = *topic.types[i];
      descriptor.m_typename = topic.type_name;
      const dds_entity_t entity = dds_create_topic(participants.at(i), &descriptor,
                                                   TopicName(topic.topic), qos.get(), nullptr);
      writers_.push_back(dds_create_writer(participants.at(i), entity, qos.get(), nullptr));
      CHECK(writers_.back() > 0);
    }
  }

  /// All members but the key are zero.
  void Write(const char* edge_id) const {
    for (std::size_t i = 0; i < writers_.size(); ++i) {
      std::vector<char> sample(topic_.types[i]->m_size);
      std::snprintf(sample.data(), kMaxIdBytes + 1, "%s", edge_id);
      static_cast<void>(dds_write(writers_[i], sample.data()));
    }
  }
  bool IsDelivered() const {
    for (const dds_entity_t writer : writers_) {
      dds_publication_matched_status_t status{};
      CHECK(dds_get_publication_matched_status(writer, &status) == DDS_RETCODE_OK);
      if (status.current_count == 0) return false;
      if (dds_wait_for_acks(writer, kPatience) != DDS_RETCODE_OK) return false;
    }
    return true;
  }

 private:
  const ShortTopic& topic_;
  std::vector<dds_entity_t> writers_;
};

int Main(int domain, const char* edge_id) {
  setenv("CYCLONEDDS_URI", kProfile, /*overwrite=*/1);
  std::array<dds_entity_t, kMaxTypes> participants{};
  for (dds_entity_t& participant : participants) {
    participant = dds_create_participant(static_cast<dds_domainid_t>(domain), nullptr, nullptr);
    CHECK(participant > 0);
  }
  std::vector<ShortWriters> writers;
  for (const ShortTopic& topic : ShortTopics()) writers.emplace_back(participants, topic);
  std::puts("started");
  for (;;) {
    for (std::size_t i = 0; i < writers.size(); ++i) {
      writers[i].Write(edge_id);
      if (!writers[i].IsDelivered()) continue;
      std::printf("delivered %s\n", TopicName(ShortTopics()[i].topic));
    }
    std::fflush(stdout);
    std::this_thread::sleep_for(kRound);
  }
}

}  // namespace
}  // namespace isotherm

int main(int argc, char** argv) {
  if (argc != 3 || std::strlen(argv[2]) > 32) return 64;
  return isotherm::Main(std::atoi(argv[1]), argv[2]);
}
