#include "ground/link_emulator/emulated_network.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <utility>

namespace isotherm {
namespace {

/// Packets are no larger (the interface's MTU is 1500).
constexpr std::size_t kMaxPacket_bytes = 2048;
/// A second of 100 Mbit/s in full packets; more only fills the memory.
constexpr std::size_t kMaxUnderWay = 10000;
/// Packets that are taken from one side before the other has its turn.
constexpr int kTakenAtOnce = 64;

}  // namespace

Result<std::unique_ptr<EmulatedNetwork>> EmulatedNetwork::Create(std::uint64_t seed) {
  auto edge = EmulatedHost::Create(kAddresses[0]);
  if (!edge) return Err(edge.error());
  auto ground = EmulatedHost::Create(kAddresses[1]);
  if (!ground) return Err(ground.error());
  FileDescriptor wake(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
  if (wake.get() < 0) return Err(Unavailable(fmt::format("eventfd: {}", std::strerror(errno))));
  return std::unique_ptr<EmulatedNetwork>(
      new EmulatedNetwork(std::move(*edge), std::move(*ground), std::move(wake), seed));
}

EmulatedNetwork::EmulatedNetwork(EmulatedHost edge, EmulatedHost ground, FileDescriptor wake,
                                 std::uint64_t seed)
    : hosts_{std::move(edge), std::move(ground)},
      wake_(std::move(wake)),
      paths_{PacketPath(2 * seed), PacketPath(2 * seed + 1)},
      carrier_([this](const std::stop_token& stop) { Carry(stop); }) {}

EmulatedNetwork::~EmulatedNetwork() {
  carrier_.request_stop();
  const std::uint64_t one = 1;
  static_cast<void>(!::write(wake_.get(), &one, sizeof(one)));
  carrier_.join();
}

void EmulatedNetwork::Set(NetworkEnd from, const PathProperties& properties) {
  MutexLock lock(mutex_);
  paths_[static_cast<std::size_t>(from)].Set(properties);
}

void EmulatedNetwork::SetBoth(const PathProperties& properties) {
  Set(NetworkEnd::kEdge, properties);
  Set(NetworkEnd::kGround, properties);
}

PathCounts EmulatedNetwork::counts(NetworkEnd from) const {
  MutexLock lock(mutex_);
  return paths_[static_cast<std::size_t>(from)].counts();
}

void EmulatedNetwork::Carry(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    const bool more_of_edge = Take(0), more_of_ground = Take(1);
    Deliver();
    if (!more_of_edge && !more_of_ground) Wait();
  }
}

bool EmulatedNetwork::Take(std::size_t from) {
  std::array<std::byte, kMaxPacket_bytes> bytes;
  for (int taken = 0; taken < kTakenAtOnce; ++taken) {
    const ssize_t size = ::read(hosts_[from].packets(), bytes.data(), bytes.size());
    if (size <= 0) return false;
    const std::span packet(bytes.data(), static_cast<std::size_t>(size));
    // Only IPv4: what a kernel says to its neighbours by itself (IPv6) is nobody's.
    constexpr auto kVersion4 = std::byte{4};
    if ((packet[0] >> 4) != kVersion4) continue;
    MutexLock lock(mutex_);
    const PacketPath::Arrivals arrivals =
        paths_[from].Send(std::chrono::steady_clock::now(), packet.size());
    for (const SteadyTime arrival : arrivals.times()) {
      if (under_way_.size() >= kMaxUnderWay) {
        paths_[from].Refuse();
        continue;
      }
      under_way_.push({arrival, order_++, 1 - from, {packet.begin(), packet.end()}});
    }
  }
  return true;
}

void EmulatedNetwork::Deliver() {
  const SteadyTime now = std::chrono::steady_clock::now();
  while (!under_way_.empty() && under_way_.top().arrival <= now) {
    const Packet& packet = under_way_.top();
    // What the other computer does not take is lost, as on its network card.
    static_cast<void>(
        !::write(hosts_[packet.to].packets(), packet.bytes.data(), packet.bytes.size()));
    under_way_.pop();
  }
}

void EmulatedNetwork::Wait() {
  std::array<pollfd, 3> files{};
  files[0] = {hosts_[0].packets(), POLLIN, 0};
  files[1] = {hosts_[1].packets(), POLLIN, 0};
  files[2] = {wake_.get(), POLLIN, 0};
  const auto wait = [&files](const timespec* timeout) {
    const int ready = ::ppoll(files.data(), files.size(), timeout, nullptr);
    // A host that is gone would be ready for ever.
    constexpr auto kTick = std::chrono::milliseconds(10);
    for (const pollfd& file : files) {
      if (ready > 0 && (file.revents & (POLLERR | POLLHUP | POLLNVAL)) != 0)
        std::this_thread::sleep_for(kTick);
    }
  };
  if (under_way_.empty()) {
    wait(nullptr);
    return;
  }
  const Nanoseconds left = std::max(
      Nanoseconds(0), Nanoseconds(under_way_.top().arrival - std::chrono::steady_clock::now()));
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(left);
  const timespec timeout{seconds.count(), (left - seconds).count()};
  wait(&timeout);
}

}  // namespace isotherm
