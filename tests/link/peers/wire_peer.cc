// Edge and ground of another version in one, for tests/link: DOMAIN [SECONDS]. Built once with the
// types of wire 1.1 and once with those of a minor version to come; knows nothing of today's.
// Writes a hello, a status, a command and a receipt until it has got one of each itself (of another
// major: the hello), and for SECONDS more; prints what it got.
#include <dds/dds.h>
#include PEER_TYPES

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>

#include "common/base/check.h"
#include "common/messages/messages.h"
#include "common/transport/qos.h"

namespace isotherm {
namespace {

constexpr const char* kProfile =
    "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name=\"lo\"/></Interfaces>"
    "</General></Domain></CycloneDDS>";
constexpr dds_duration_t kRepeat = DDS_MSECS(50);
constexpr int kMaxRepeats = 1200;  // A minute: nobody is there any more.
constexpr bool kSameMajor = PEER_MAJOR == kWireMajor;
// A peer of wire 1 had no version in the names.
constexpr const char* kTopics = PEER_MAJOR == 1 ? "isotherm/" : "isotherm/2/";

/// Writes and reads one topic.
template <typename Sample>
class Ends {
 public:
  Ends(dds_entity_t participant, dds_entity_t waiter, const dds_topic_descriptor_t& descriptor,
       TopicId id, const std::string& name)
      : descriptor_(descriptor) {
    const QosPtr qos = MakeQos(id);
    const dds_entity_t topic =
        dds_create_topic(participant, &descriptor, name.c_str(), qos.get(), nullptr);
    writer_ = dds_create_writer(participant, topic, qos.get(), nullptr);
    reader_ = dds_create_reader(participant, topic, qos.get(), nullptr);
    CHECK(writer_ > 0 && reader_ > 0);
    const dds_entity_t condition = dds_create_readcondition(reader_, DDS_ANY_STATE);
    CHECK(dds_waitset_attach(waiter, condition, 0) == DDS_RETCODE_OK);
  }
  void Write(const Sample& sample) const { CHECK(dds_write(writer_, &sample) == DDS_RETCODE_OK); }
  /// Calls `print` for the first sample that comes.
  template <typename Print>
  void Take(Print print) {
    Sample sample{};
    void* samples[1] = {&sample};
    dds_sample_info_t info{};
    while (dds_take(reader_, samples, &info, 1, 1) > 0) {
      if (info.valid_data && !got_) print(sample);
      got_ = got_ || info.valid_data;
      dds_sample_free(&sample, &descriptor_, DDS_FREE_CONTENTS);
      sample = {};
    }
  }
  bool got() const { return got_; }
  /// Whether somebody reads or writes this topic besides.
  bool IsShared() const {
    dds_publication_matched_status_t readers{};
    dds_subscription_matched_status_t writers{};
    CHECK(dds_get_publication_matched_status(writer_, &readers) == DDS_RETCODE_OK);
    CHECK(dds_get_subscription_matched_status(reader_, &writers) == DDS_RETCODE_OK);
    return readers.total_count + writers.total_count > 0;
  }

 private:
  const dds_topic_descriptor_t& descriptor_;
  dds_entity_t writer_ = 0;
  dds_entity_t reader_ = 0;
  bool got_ = false;
};

template <typename Sample>
Sample Named() {
  Sample sample{};
  std::strcpy(sample.edge_id, "edge");
  if constexpr (requires { sample.mark; }) sample.mark = kWireMark;
  return sample;
}

int Main(int domain, int seconds) {
  setenv("CYCLONEDDS_URI", kProfile, /*overwrite=*/1);
  const dds_entity_t participant =
      dds_create_participant(static_cast<dds_domainid_t>(domain), nullptr, nullptr);
  CHECK(participant > 0);
  const dds_entity_t waiter = dds_create_waitset(participant);
  const std::string topics = kTopics;
  Ends<isotherm_wire_EdgeStatus> status(participant, waiter, isotherm_wire_EdgeStatus_desc,
                                        TopicId::kEdgeStatus, topics + "edge_status");
  Ends<isotherm_wire_Command> command(participant, waiter, isotherm_wire_Command_desc,
                                      TopicId::kCommand, topics + "command");
  Ends<isotherm_wire_Receipt> receipt(participant, waiter, isotherm_wire_Receipt_desc,
                                      TopicId::kReceipt, topics + "receipt");
  // Last: who has met this one has met the others, as the middleware announces them in order.
  Ends<isotherm_wire_Hello> hello(participant, waiter, isotherm_wire_Hello_desc, TopicId::kHello,
                                  "isotherm/hello");
  auto own_hello = Named<isotherm_wire_Hello>();
  own_hello.wire_major = PEER_MAJOR;
  own_hello.wire_minor = PEER_MINOR;
  std::strcpy(own_hello.software_version, "of another day");
  auto own_status = Named<isotherm_wire_EdgeStatus>();
  own_status.session = 11;
  own_status.time_ns = 1'700'000'000'000'000'000;
  own_status.scan_state = 1;
  own_status.nuc_state = 1;
  own_status.depth.published = own_status.depth.next_frame_number = 90;
  own_status.clock_error_s = 0.002;
  own_status.feedback_count = 5;
  own_status.feedback_latency_p99_s = 0.11;
  auto own_command = Named<isotherm_wire_Command>();
  own_command.number = 12;
  own_command.kind = 2;
  auto own_receipt = Named<isotherm_wire_Receipt>();
  own_receipt.session = 13;
  own_receipt.thermal.next_number = own_receipt.thermal.received = 40;

  for (int i = 0; i < kMaxRepeats; ++i) {
    const bool got_all = status.got() && command.got() && receipt.got();
    if (hello.got() && (!kSameMajor || got_all)) break;
    for (std::uint8_t role = 0; role < 2; ++role) {
      own_hello.role = role;
      hello.Write(own_hello);
    }
    status.Write(own_status);
    command.Write(own_command);
    receipt.Write(own_receipt);
    dds_attach_t triggered[4];
    dds_waitset_wait(waiter, triggered, 4, kRepeat);
    hello.Take([](const auto& s) { std::printf("hello %d.%d\n", s.wire_major, s.wire_minor); });
    status.Take([](const auto& s) {
      std::printf("status %llu published %llu error %g feedback %llu p99 %g\n",
                  static_cast<unsigned long long>(s.session),
                  static_cast<unsigned long long>(s.depth.published), s.clock_error_s,
                  static_cast<unsigned long long>(s.feedback_count), s.feedback_latency_p99_s);
    });
    command.Take([](const auto& s) {
      std::printf("command %llu kind %d\n", static_cast<unsigned long long>(s.number), s.kind);
    });
    receipt.Take([](const auto& s) {
      std::printf("receipt %llu thermal %llu hole %llu\n",
                  static_cast<unsigned long long>(s.session),
                  static_cast<unsigned long long>(s.thermal.received),
                  static_cast<unsigned long long>(
                      s.thermal.holes._length > 0 ? s.thermal.holes._buffer[0].last : 0));
    });
  }
  std::printf("shared: status %d command %d receipt %d\n", status.IsShared(), command.IsShared(),
              receipt.IsShared());
  std::puts("got all");
  std::fflush(stdout);
  std::this_thread::sleep_for(std::chrono::seconds(seconds));  // Hellos stay as long as we do.
  dds_delete(participant);
  return 0;
}

}  // namespace
}  // namespace isotherm

int main(int argc, char** argv) {
  if (argc != 2 && argc != 3) return 64;
  return isotherm::Main(std::atoi(argv[1]), argc == 3 ? std::atoi(argv[2]) : 0);
}
