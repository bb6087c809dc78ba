#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <queue>
#include <string>
#include <thread>
#include <vector>

#include "common/base/file_descriptor.h"
#include "common/base/mutex.h"
#include "common/base/status.h"
#include "ground/link_emulator/emulated_host.h"
#include "ground/link_emulator/packet_path.h"

namespace isotherm {

/// Names the two computers of an emulated network.
enum class NetworkEnd : std::uint8_t { kEdge, kGround };

/// Two computers on this one (EmulatedHost), and a link between them that delays, loses, doubles
/// and reorders packets, or is too narrow. Every packet passes through a thread of this object,
/// some 10 us each. Thread-safe.
class EmulatedNetwork {
 public:
  /// Addresses of the two: those of the shipped profile for a radio.
  static constexpr std::array<const char*, 2> kAddresses = {"192.168.50.1", "192.168.50.2"};

  /// The same `seed` loses the same packets, if the same are sent.
  static Result<std::unique_ptr<EmulatedNetwork>> Create(std::uint64_t seed);
  ~EmulatedNetwork();
  EmulatedNetwork(const EmulatedNetwork&) = delete;
  EmulatedNetwork& operator=(const EmulatedNetwork&) = delete;

  const EmulatedHost& host(NetworkEnd end) const { return hosts_[static_cast<std::size_t>(end)]; }
  /// For what `from` sends from now on.
  void Set(NetworkEnd from, const PathProperties& properties);
  /// The same in both directions.
  void SetBoth(const PathProperties& properties);
  PathCounts counts(NetworkEnd from) const;

 private:
  /// A packet that is under way.
  struct Packet {
    SteadyTime arrival;
    std::uint64_t order;  ///< Equal arrivals come in the order of sending.
    std::size_t to;
    std::vector<std::byte> bytes;
  };
  struct Later {
    bool operator()(const Packet& a, const Packet& b) const {
      return a.arrival != b.arrival ? a.arrival > b.arrival : a.order > b.order;
    }
  };

  EmulatedNetwork(EmulatedHost edge, EmulatedHost ground, FileDescriptor wake, std::uint64_t seed);
  void Carry(const std::stop_token& stop);
  /// Takes what `from` has sent by now, up to a limit. Returns whether there may be more.
  bool Take(std::size_t from);
  void Deliver();
  void Wait();

  std::array<EmulatedHost, 2> hosts_;
  FileDescriptor wake_;
  mutable Mutex mutex_;
  std::array<PacketPath, 2> paths_ GUARDED_BY(mutex_);  ///< By the sender.
  // Of the thread.
  std::priority_queue<Packet, std::vector<Packet>, Later> under_way_;
  std::uint64_t order_ = 0;
  std::jthread carrier_;  ///< Last: it uses all of the above.
};

}  // namespace isotherm
