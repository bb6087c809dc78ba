#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "common/frame/frame.h"
#include "common/messages/messages.h"
#include "common/time/time_types.h"
#include "common/transport/endpoints.h"
#include "common/transport/refusal.h"

namespace isotherm {

/// A sample that says it is of the rig that is followed.
struct RigSample {
  std::variant<RigDescription, EdgeStatus, ExternalOdometrySample, CommandResult, EncodedDepthFrame,
               EncodedThermalFrame>
      content;
  CaptureTime arrival{};  ///< Ground wall clock.
};

/// Decides whose samples are used. A name is no proof: anybody may write it, and two rigs may have
/// the same one. The rig is the process (DDS participant) that announced the session by its
/// RigDescription; it keeps it until the session is closed or the process is gone:
///
///   another process --(the owner is heard kTrial later)--------------------> refused
///   another process --(the owner is gone, and not back after kTrial)-------> owner
///   another process --(the owner is there, but silent for kSilence)--------> owner
///   another process --(the owner's session is closed, or was never announced)--> owner at once
///
/// Until that is decided the samples of kMaxOthersHeld other processes are kept, each within
/// kMaxHeldBytes, so that an edge that was killed and started again loses nothing. Samples of a
/// session that the owner has not announced are kept for kPatience. What is not used is refused
/// with a cause. Pure: time enters through arguments. Thread-compatible.
class RigGate {
 public:
  /// Time in which the owner can show that it is still there. The middleware notices within a
  /// second that a process was killed, and an outage of the network takes about as long to be told
  /// from that. Shorter: a stranger becomes the rig during an outage; longer: an edge that was
  /// started again waits longer, and more of its frames are kept.
  static constexpr Nanoseconds kTrial = std::chrono::seconds(1);
  /// An owner that is there and silent for this long has lost its place: twice the interval of its
  /// statuses (1 Hz), so that one lost status changes nothing.
  static constexpr Nanoseconds kSilence = std::chrono::seconds(2);
  /// Samples wait this long for the description of their session, which the middleware repeats for
  /// late joiners: it comes behind them only after an outage. Not tuned.
  static constexpr Nanoseconds kPatience = std::chrono::seconds(5);
  static constexpr std::size_t kMaxHeldBytes = 64U << 20U;  ///< For one process.
  /// Samples held for one process: two seconds of frames at 30 and 40 Hz and of odometry at 200 Hz,
  /// twice what gathers within kTrial.
  static constexpr std::size_t kMaxHeldSamples = 512;
  /// Processes that are followed at all. More than a network of rigs has; a program that joins
  /// again and again under new names cannot fill the memory.
  static constexpr std::size_t kMaxProcesses = 16;
  /// Processes beside the owner whose samples are kept: an edge may be killed twice before it is
  /// decided that the first one is gone. Each one costs up to kMaxHeldBytes.
  static constexpr std::ptrdiff_t kMaxOthersHeld = 2;

  using Pass = std::function<void(RigSample&&)>;
  using Refuse = std::function<void(const RigSample&, RefusalCause)>;
  using IsPresent = std::function<bool(PeerHandle)>;

  /// `pass` gets what is used, in the order of its arrival; a session's rig comes first.
  RigGate(Pass pass, Refuse refuse) : pass_(std::move(pass)), refuse_(std::move(refuse)) {}

  /// A sample of `peer` has arrived.
  void Add(PeerHandle peer, RigSample&& sample, SteadyTime now);
  /// `session` is closed: nothing of it will come.
  void OnClosed(std::uint64_t session);
  /// Decides what time decides. To be called several times in a second.
  void Update(SteadyTime now, const IsPresent& is_present);

  /// The rig's process; 0 before the first sample.
  PeerHandle owner() const { return owner_; }
  /// A process that is refused although it calls itself the rig.
  struct Rival {
    PeerHandle peer = 0;
    std::uint64_t session = 0;  ///< The session that it has announced; 0 = none.
    friend bool operator==(const Rival&, const Rival&) = default;
  };
  std::vector<Rival> rivals() const;
  /// Samples of all that were refused because too many waited already.
  std::uint64_t overflowed() const { return overflowed_; }

 private:
  /// Holds a sample of a process that has not been decided on.
  struct Held {
    RigSample sample;
    SteadyTime time;
  };
  /// Holds a process that speaks under the followed rig's name.
  struct Process {
    PeerHandle peer = 0;
    SteadyTime since;                   ///< When it began to ask for the owner's place.
    SteadyTime heard;                   ///< The newest sample.
    bool refused = false;               ///< It was decided that it is not the rig.
    std::optional<RigSample> rig{};     ///< The newest.
    std::optional<RigSample> status{};  ///< The newest that was not passed.
    std::deque<Held> held{};
    std::size_t held_bytes = 0;
  };

  Process* Find(PeerHandle peer);
  Process* FindOrCreate(PeerHandle peer, SteadyTime now);
  /// Session that it has announced, if that can become ours.
  std::optional<std::uint64_t> OpenSession(const Process& process) const;
  bool IsOver(std::uint64_t session) const;
  bool MayHold(const Process& process) const;
  void Hold(Process& process, RigSample&& sample, SteadyTime now);
  void Drop(Process& process, RefusalCause cause);
  void AddOwn(Process& owner, RigSample&& sample, SteadyTime now);
  void AddOther(Process& process, RigSample&& sample, SteadyTime now);
  void BeginSession(std::uint64_t session);
  /// Passes what was kept of the announced session.
  void Release(Process& owner);
  void MakeOwner(Process& process, SteadyTime now);
  bool IsFree(const Process& candidate, SteadyTime now, const IsPresent& is_present) const;

  const Pass pass_;
  const Refuse refuse_;
  std::deque<Process> processes_;
  PeerHandle owner_ = 0;
  bool announced_ = false;     ///< The owner has announced session_.
  std::uint64_t session_ = 0;  ///< Newest that an owner announced.
  bool closed_ = false;        ///< session_ is closed.
  std::deque<std::uint64_t> over_;
  std::uint64_t overflowed_ = 0;
};

/// The session of a sample; 0 = of none.
std::uint64_t SessionOf(const RigSample& sample);

}  // namespace isotherm
