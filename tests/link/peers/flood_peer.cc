// A peer that goes by ever new names, for tests: flood_peer DOMAIN NAMES [take-back]. Writes a
// hello, a status and a receipt under each, to an edge and a ground that are there, or takes only
// back what was never there; prints "flooded" when all are delivered, and stays.
#include <dds/dds.h>
#include <isotherm_control.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>

#include "common/base/check.h"
#include "common/transport/bounded_text.h"
#include "common/transport/conversions.h"
#include "common/transport/participant.h"
#include "common/transport/qos.h"

namespace isotherm {
namespace {

/// Writes one topic under many names.
template <typename Message>
class Flood {
 public:
  Flood(const Participant& participant, const dds_topic_descriptor_t& descriptor) {
    constexpr TopicId kTopic = TopicOf<Message>::kId;
    const QosPtr qos = MakeQos(kTopic);
    const dds_entity_t topic =
        dds_create_topic(participant.handle(), &descriptor, TopicName(kTopic), qos.get(), nullptr);
    writer_ = dds_create_writer(participant.handle(), topic, qos.get(), nullptr);
    CHECK(writer_ > 0);
  }
  void AwaitReader() const {
    dds_publication_matched_status_t status{};
    while (status.current_count == 0) {
      CHECK(dds_get_publication_matched_status(writer_, &status) == DDS_RETCODE_OK);
      std::this_thread::yield();
    }
  }
  void Write(const std::string& name, bool take_back) const {
    typename TopicOf<Message>::Wire sample{};
    CopyText(name, sample.edge_id);
    if (take_back) {
      CHECK(dds_dispose(writer_, &sample) == DDS_RETCODE_OK);
      return;
    }
    ToWire(Message{}, &sample);
    SetMark(&sample);
    CHECK(dds_write(writer_, &sample) == DDS_RETCODE_OK);
  }
  void Finish() const { CHECK(dds_wait_for_acks(writer_, DDS_SECS(60)) == DDS_RETCODE_OK); }

 private:
  dds_entity_t writer_ = 0;
};

int Main(int domain, int names, bool take_back) {
  const SystemClock clock{};
  const TransportEnvironment environment(clock);
  const auto participant = std::move(*Participant::Create(environment, domain));
  const Flood<Hello> hello(*participant, isotherm_wire_Hello_desc);
  const Flood<EdgeStatus> status(*participant, isotherm_wire_EdgeStatus_desc);
  const Flood<Receipt> receipt(*participant, isotherm_wire_Receipt_desc);
  hello.AwaitReader();
  status.AwaitReader();
  receipt.AwaitReader();
  for (int i = 0; i < names; ++i) {
    const std::string name = "name-" + std::to_string(i);
    hello.Write(name, take_back);
    status.Write(name, take_back);
    receipt.Write(name, take_back);
    // So that nothing is overtaken: the history holds one sample per name, the network less.
    if (i % 100 == 0) hello.Finish(), status.Finish(), receipt.Finish();
  }
  hello.Finish();
  status.Finish();
  receipt.Finish();
  std::puts("flooded");
  std::fflush(stdout);
  std::this_thread::sleep_for(std::chrono::hours(1));
  return 0;
}

}  // namespace
}  // namespace isotherm

int main(int argc, char** argv) {
  return argc >= 3 ? isotherm::Main(std::atoi(argv[1]), std::atoi(argv[2]), argc > 3) : 64;
}
