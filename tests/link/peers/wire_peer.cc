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
constexpr const char* kTopics = PEER_MAJOR == 1 ? "isotherm/" : "isotherm/3/";

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
  /// Returns whether somebody else reads or writes this topic.
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

isotherm_wire_Hello OwnHello() {
  auto hello = Named<isotherm_wire_Hello>();
  hello.wire_major = PEER_MAJOR;
  hello.wire_minor = PEER_MINOR;
  std::strcpy(hello.software_version, "of another day");
  return hello;
}

isotherm_wire_EdgeStatus OwnStatus() {
  auto status = Named<isotherm_wire_EdgeStatus>();
  status.session = 11;
  status.time_ns = 1'700'000'000'000'000'000;
  status.scan_state = 1;
  status.nuc_state = 1;
  status.depth.published = status.depth.next_frame_number = 90;
  status.clock_error_s = 0.002;
  status.feedback_count = 5;
  status.feedback_latency_p99_s = 0.11;
  return status;
}

isotherm_wire_Command OwnCommand() {
  auto command = Named<isotherm_wire_Command>();
  command.number = 12;
  command.kind = 2;
  return command;
}

isotherm_wire_Receipt OwnReceipt() {
  auto receipt = Named<isotherm_wire_Receipt>();
  receipt.session = 13;
  receipt.thermal.next_number = receipt.thermal.received = 40;
  return receipt;
}

unsigned long long Number(std::uint64_t value) { return value; }

void Print(const isotherm_wire_Hello& hello) {
  std::printf("hello %d.%d\n", hello.wire_major, hello.wire_minor);
}

void Print(const isotherm_wire_EdgeStatus& status) {
  std::printf("status %llu published %llu error %g feedback %llu p99 %g\n", Number(status.session),
              Number(status.depth.published), status.clock_error_s, Number(status.feedback_count),
              status.feedback_latency_p99_s);
}

void Print(const isotherm_wire_Command& command) {
  std::printf("command %llu kind %d\n", Number(command.number), command.kind);
}

void Print(const isotherm_wire_Receipt& receipt) {
  const auto& holes = receipt.thermal.holes;
  std::printf("receipt %llu thermal %llu hole %llu\n", Number(receipt.session),
              Number(receipt.thermal.received),
              Number(holes._length > 0 ? holes._buffer[0].last : 0));
}

/// Edge and ground in one.
class Peer {
 public:
  explicit Peer(dds_entity_t participant) : participant_(participant) {}

  /// Writes and prints until it has got all that it can get.
  void Run() {
    for (int i = 0; i < kMaxRepeats && !HasGotAll(); ++i) {
      WriteAll();
      dds_attach_t triggered[4];
      dds_waitset_wait(waiter_, triggered, 4, kRepeat);
      const auto print = [](const auto& sample) { Print(sample); };
      hello_.Take(print);
      status_.Take(print);
      command_.Take(print);
      receipt_.Take(print);
    }
    std::printf("shared: status %d command %d receipt %d\n", status_.IsShared(),
                command_.IsShared(), receipt_.IsShared());
  }

 private:
  bool HasGotAll() const {
    return hello_.got() && (!kSameMajor || (status_.got() && command_.got() && receipt_.got()));
  }
  void WriteAll() const {
    isotherm_wire_Hello hello = OwnHello();
    for (std::uint8_t role = 0; role < 2; ++role) {
      hello.role = role;
      hello_.Write(hello);
    }
    status_.Write(OwnStatus());
    command_.Write(OwnCommand());
    receipt_.Write(OwnReceipt());
  }

  const dds_entity_t participant_;
  const dds_entity_t waiter_ = dds_create_waitset(participant_);
  const std::string topics_ = kTopics;
  Ends<isotherm_wire_EdgeStatus> status_{participant_, waiter_, isotherm_wire_EdgeStatus_desc,
                                         TopicId::kEdgeStatus, topics_ + "edge_status"};
  Ends<isotherm_wire_Command> command_{participant_, waiter_, isotherm_wire_Command_desc,
                                       TopicId::kCommand, topics_ + "command"};
  Ends<isotherm_wire_Receipt> receipt_{participant_, waiter_, isotherm_wire_Receipt_desc,
                                       TopicId::kReceipt, topics_ + "receipt"};
  // Last: an edge that has met this one has met the others, announced in order by the middleware.
  Ends<isotherm_wire_Hello> hello_{participant_, waiter_, isotherm_wire_Hello_desc, TopicId::kHello,
                                   "isotherm/hello"};
};

int Main(int domain, int seconds) {
  setenv("CYCLONEDDS_URI", kProfile, /*overwrite=*/1);
  const dds_entity_t participant =
      dds_create_participant(static_cast<dds_domainid_t>(domain), nullptr, nullptr);
  CHECK(participant > 0);
  Peer(participant).Run();
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
