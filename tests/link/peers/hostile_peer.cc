// Sends frames that cannot be, for tests/link: hostile_peer DOMAIN. Prints "second session" when
// that has begun and waits for SIGUSR1: that its samples were delivered does not say that they were
// taken. Prints "sent" when all are delivered and waits for a signal.
#include <dds/dds.h>
#include <hostile_frames.h>
#include <isotherm_frames.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <iterator>
#include <limits>
#include <thread>
#include <vector>

#include "common/base/check.h"
#include "common/transport/qos.h"
#include "common/transport/transport_environment.h"

namespace isotherm {
namespace {

constexpr int kRepeats = 3;
constexpr char kName[] = "test-edge";
// Without the limits of the shipped profiles.
constexpr const char* kProfile =
    "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name=\"lo\"/></Interfaces>"
    "</General></Domain></CycloneDDS>";

std::vector<std::uint8_t> Bytes(std::size_t count) { return std::vector<std::uint8_t>(count, 7); }

class RawWriter {
 public:
  /// Claims to write the type `type_name`.
  RawWriter(dds_entity_t participant, dds_topic_descriptor_t descriptor, const char* type_name,
            TopicId topic) {
    descriptor.m_typename = type_name;
    const QosPtr qos = MakeQos(topic);
    const dds_entity_t entity =
        dds_create_topic(participant, &descriptor, TopicName(topic), qos.get(), nullptr);
    writer_ = dds_create_writer(participant, entity, qos.get(), nullptr);
    CHECK(writer_ > 0);
  }
  void AwaitReader() const {
    dds_publication_matched_status_t status{};
    while (status.current_count == 0) {
      CHECK(dds_get_publication_matched_status(writer_, &status) == DDS_RETCODE_OK);
      std::this_thread::yield();
    }
  }
  void Write(const void* sample) const { CHECK(dds_write(writer_, sample) == DDS_RETCODE_OK); }
  void Finish() const { CHECK(dds_wait_for_acks(writer_, DDS_SECS(20)) == DDS_RETCODE_OK); }

 private:
  dds_entity_t writer_ = 0;
};

/// Sends what an edge says before it sends frames of a session.
void Announce(const RawWriter& writer, std::uint64_t session) {
  isotherm_wire_Rig rig{};
  std::copy(std::begin(kName), std::end(kName), rig.edge_id);
  rig.session = session;
  rig.mark = kWireMark;
  writer.Write(&rig);
  writer.Finish();
}

/// A sample whose image is right: 64 x 48, raw.
template <typename Sample>
Sample GoodSample(std::vector<std::uint8_t>* payload) {
  Sample sample{};
  std::copy(std::begin(kName), std::end(kName), sample.edge_id);
  sample.stamp.session = 1;
  sample.mark = kWireMark;
  sample.image.width = 64;
  sample.image.height = 48;
  *payload = Bytes(64 * 48 * 2);
  return sample;
}

template <typename Sample>
void Lend(std::vector<std::uint8_t>* payload, Sample* sample) {
  const auto bytes = static_cast<std::uint32_t>(payload->size());
  sample->image.payload = {
      ._maximum = bytes, ._length = bytes, ._buffer = payload->data(), ._release = false};
}

void Say(const char* line) {
  std::puts(line);
  std::fflush(stdout);
}

sigset_t AwaitedSignals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGUSR1);
  return signals;
}

void AwaitSignal() {
  const sigset_t signals = AwaitedSignals();
  int caught = 0;
  CHECK(sigwait(&signals, &caught) == 0);
}

void SendDepth(const RawWriter& rig, const RawWriter& writer) {
  using Sample = hostile_DepthFrame;
  using Payload = std::vector<std::uint8_t>;
  const std::vector<std::function<void(Sample&, Payload&)>> cases = {
      [](Sample&, Payload&) {},  // Good, and from a newer version.
      [](Sample& s, Payload&) { s.image.width = 0; },
      [](Sample& s, Payload&) { s.image.height = 0xFFFFFFFFU; },
      [](Sample& s, Payload&) { s.image.encoding = 77; },
      [](Sample&, Payload& p) { p.clear(); },
      [](Sample&, Payload& p) { p = Bytes(5U << 20U); },
      [](Sample& s, Payload&) { s.stamp.capture_time_ns = -1; },
      [](Sample& s, Payload&) { s.stamp.capture_sigma_ns = -1; },
      [](Sample& s, Payload&) { s.depth_scale = std::nan(""); },
      [](Sample& s, Payload&) { s.stamp.frame_number = ~0ULL; },
      [](Sample& s, Payload&) { s.stamp.frame_number = 1ULL << 39U; },
      [](Sample&, Payload& p) { p.pop_back(); },  // Does not decode.
      [](Sample& s, Payload&) { s.stamp.session = 2; },
      [](Sample& s, Payload&) { s.stamp.frame_number = 1; },    // The first session is over.
      [](Sample&, Payload& p) { p = Bytes((8U << 20U) + 1); },  // The middleware drops these two.
      [](Sample&, Payload& p) { p = Bytes(12U << 20U); },
      [](Sample& s, Payload&) { s.stamp.session = 2, s.stamp.frame_number = 1; },
  };
  std::uint64_t announced = 0;
  for (const auto& change : cases) {
    Payload payload;
    auto sample = GoodSample<Sample>(&payload);
    sample.depth_scale = 1000.0;
    sample.added_later = 42;
    change(sample, payload);
    const bool begins = sample.stamp.session > announced;
    if (begins) Announce(rig, announced = sample.stamp.session);
    Lend(&payload, &sample);
    for (int i = 0; i < kRepeats; ++i) writer.Write(&sample);
    writer.Finish();
    if (begins && announced > 1) {
      Say("second session");
      AwaitSignal();
    }
  }
}

void SendThermal(const RawWriter& writer) {
  using Sample = hostile_ThermalFrame;
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const std::vector<std::function<void(Sample&)>> cases = {
      [](Sample&) {},
      [](Sample& s) { s.nuc_state = 200; },
      [](Sample& s) { s.nuc_source = 200; },
      [](Sample& s) { s.housing_celsius = kInfinity; },
      [](Sample& s) { s.has_seconds_since_nuc = true, s.seconds_since_nuc = std::nan(""); },
  };
  for (const auto& change : cases) {
    std::vector<std::uint8_t> payload;
    auto sample = GoodSample<Sample>(&payload);
    sample.stamp.session = 2;  // The newest of SendDepth.
    change(sample);
    Lend(&payload, &sample);
    for (int i = 0; i < kRepeats; ++i) writer.Write(&sample);
    writer.Finish();
  }
}

int Main(int domain) {
  setenv("CYCLONEDDS_URI", kProfile, /*overwrite=*/1);
  const sigset_t awaited = AwaitedSignals();
  CHECK(pthread_sigmask(SIG_BLOCK, &awaited, nullptr) == 0);
  const SystemClock clock{};
  const TransportEnvironment environment(clock);
  const dds_entity_t participant =
      dds_create_participant(static_cast<dds_domainid_t>(domain), nullptr, nullptr);
  CHECK(participant > 0);
  const RawWriter depth(participant, hostile_DepthFrame_desc, "isotherm::wire::DepthFrame",
                        TopicId::kDepth);
  const RawWriter thermal(participant, hostile_ThermalFrame_desc, "isotherm::wire::ThermalFrame",
                          TopicId::kThermal);
  const RawWriter rig(participant, isotherm_wire_Rig_desc, "isotherm::wire::Rig", TopicId::kRig);
  rig.AwaitReader();
  depth.AwaitReader();
  thermal.AwaitReader();
  SendDepth(rig, depth);
  SendThermal(thermal);
  Say("sent");
  pause();  // Until a signal ends it: a peer that has left cannot be asked who it was.
  return 0;
}

}  // namespace
}  // namespace isotherm

int main(int argc, char** argv) { return argc == 2 ? isotherm::Main(std::atoi(argv[1])) : 64; }
