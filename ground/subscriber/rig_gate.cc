#include "ground/subscriber/rig_gate.h"

#include <algorithm>
#include <utility>

namespace isotherm {
namespace {

constexpr std::size_t kMaxRemembered =
    32;  // Sessions that must not come back; each is one start of a scan.
constexpr std::size_t kSampleBytes = 512;  // About the size of a sample without its payload.

template <typename Message>
bool Is(const RigSample& sample) {
  return std::holds_alternative<Message>(sample.content);
}

std::size_t BytesOf(const RigSample& sample) {
  if (const auto* depth = std::get_if<EncodedDepthFrame>(&sample.content))
    return kSampleBytes + depth->image.payload.size();
  if (const auto* thermal = std::get_if<EncodedThermalFrame>(&sample.content))
    return kSampleBytes + thermal->image.payload.size();
  return kSampleBytes;
}

}  // namespace

std::uint64_t SessionOf(const RigSample& sample) {
  struct Visitor {
    std::uint64_t operator()(const EncodedDepthFrame& frame) { return frame.header.session; }
    std::uint64_t operator()(const EncodedThermalFrame& frame) { return frame.header.session; }
    std::uint64_t operator()(const CommandResult& /*result*/) { return 0; }
    std::uint64_t operator()(const RigDescription& rig) { return rig.session; }
    std::uint64_t operator()(const EdgeStatus& status) { return status.session; }
    std::uint64_t operator()(const ExternalOdometrySample& pose) { return pose.session; }
  };
  return std::visit(Visitor(), sample.content);
}

RigGate::Process* RigGate::Find(PeerHandle peer) {
  const auto found = std::ranges::find(processes_, peer, &Process::peer);
  return found == processes_.end() ? nullptr : &*found;
}

RigGate::Process* RigGate::FindOrCreate(PeerHandle peer, SteadyTime now) {
  if (Process* known = Find(peer)) return known;
  if (processes_.size() == kMaxProcesses) return nullptr;
  processes_.push_back({.peer = peer, .since = now, .heard = now});
  return &processes_.back();
}

void RigGate::Add(PeerHandle peer, RigSample&& sample, SteadyTime now) {
  Process* const process = peer == 0 ? nullptr : FindOrCreate(peer, now);
  if (process == nullptr) return refuse_(sample, RefusalCause::kOtherWriter);
  process->heard = now;
  // The first process heard holds the place until somebody announces a session: then the place is
  // free (OpenSession).
  if (owner_ == 0) owner_ = peer;
  // A process that announces a session comes before one that only sent something.
  if (peer != owner_ && Is<RigDescription>(sample)) {
    // Only the newest description can still become the session's; the older one is counted.
    if (process->rig) refuse_(*process->rig, RefusalCause::kOtherWriter);
    process->rig = std::move(sample);
    if ((!announced_ || closed_) && OpenSession(*process)) MakeOwner(*process, now);
    return;
  }
  if (peer == owner_) return AddOwn(*process, std::move(sample), now);
  AddOther(*process, std::move(sample), now);
}

void RigGate::AddOwn(Process& owner, RigSample&& sample, SteadyTime now) {
  const std::uint64_t session = SessionOf(sample);
  if (session == 0) return pass_(std::move(sample));  // Of no session: an answer, an idle status.
  if (IsOver(session)) return refuse_(sample, RefusalCause::kOtherSession);
  if (Is<RigDescription>(sample)) {
    owner.rig = sample;
    BeginSession(session);
    pass_(std::move(sample));
    // The description goes first, so that whoever gets frames knows their cameras.
    return Release(owner);
  }
  if (announced_ && session == session_) return pass_(std::move(sample));
  if (Is<EdgeStatus>(sample)) {
    owner.status = std::move(sample);
    return;
  }
  Hold(owner, std::move(sample), now);
}

void RigGate::AddOther(Process& process, RigSample&& sample, SteadyTime now) {
  if (Is<EdgeStatus>(sample)) {
    if (process.status) refuse_(*process.status, RefusalCause::kOtherWriter);
    process.status = std::move(sample);
  } else if (!Is<CommandResult>(sample) && MayHold(process)) {
    Hold(process, std::move(sample), now);
  } else {
    refuse_(sample, RefusalCause::kOtherWriter);
  }
}

void RigGate::BeginSession(std::uint64_t session) {
  if (announced_ && session == session_) return;
  // Frames of the session before may still be on their way; they must not reopen it.
  if (session_ != 0 && session_ != session) over_.push_back(session_);
  if (over_.size() > kMaxRemembered) over_.pop_front();
  announced_ = true;
  closed_ = false;
  session_ = session;
}

void RigGate::Release(Process& owner) {
  std::deque<Held> held = std::exchange(owner.held, {});
  owner.held_bytes = 0;
  for (Held& item : held) {
    if (SessionOf(item.sample) == session_) {
      pass_(std::move(item.sample));
    } else {
      refuse_(item.sample, RefusalCause::kUnannounced);
    }
  }
  std::optional<RigSample> status = std::exchange(owner.status, std::nullopt);
  if (status && SessionOf(*status) == session_) pass_(std::move(*status));
}

bool RigGate::IsOver(std::uint64_t session) const {
  return std::ranges::find(over_, session) != over_.end();
}

std::optional<std::uint64_t> RigGate::OpenSession(const Process& process) const {
  if (!process.rig) return std::nullopt;
  const std::uint64_t session = SessionOf(*process.rig);
  if (session == 0 || IsOver(session) || (closed_ && session == session_)) return std::nullopt;
  return session;
}

bool RigGate::MayHold(const Process& process) const {
  if (process.refused) return false;
  const std::ptrdiff_t others = std::ranges::count_if(processes_, [&](const Process& other) {
    return other.peer != owner_ && other.peer != process.peer && !other.held.empty();
  });
  return others < kMaxOthersHeld;
}

void RigGate::Hold(Process& process, RigSample&& sample, SteadyTime now) {
  process.held_bytes += BytesOf(sample);
  process.held.push_back({std::move(sample), now});
  // The oldest go first: they would be too late for the reconstruction anyway.
  while (process.held_bytes > kMaxHeldBytes || process.held.size() > kMaxHeldSamples) {
    ++overflowed_;
    process.held_bytes -= BytesOf(process.held.front().sample);
    refuse_(process.held.front().sample,
            process.peer == owner_ ? RefusalCause::kUnannounced : RefusalCause::kOtherWriter);
    process.held.pop_front();
  }
}

void RigGate::Drop(Process& process, RefusalCause cause) {
  for (const Held& item : process.held) refuse_(item.sample, cause);
  process.held.clear();
  process.held_bytes = 0;
}

void RigGate::MakeOwner(Process& process, SteadyTime now) {
  if (Process* before = Find(owner_)) {
    Drop(*before, RefusalCause::kUnannounced);
    // The one before is a candidate like any other now, and may come back.
    before->since = now;
    before->refused = false;
  }
  owner_ = process.peer;
  process.refused = false;
  // So that AddOwn begins the session anew, even if both processes name the same one.
  announced_ = false;
  AddOwn(process, RigSample(*process.rig), now);
}

void RigGate::OnClosed(std::uint64_t session) {
  if (session == session_) closed_ = true;
}

bool RigGate::IsFree(const Process& candidate, SteadyTime now, const IsPresent& is_present) const {
  if (!announced_ || closed_) return true;
  const auto owner = std::ranges::find(processes_, owner_, &Process::peer);
  if (owner == processes_.end()) return true;
  // An outage takes the owner away for a while, too, and whoever is heard first is not the rig.
  if (now < std::max(candidate.since, owner->heard) + kTrial) return false;
  return !is_present(owner_) || now >= owner->heard + kSilence;
}

void RigGate::Update(SteadyTime now, const IsPresent& is_present) {
  // The owner stays in the list when it is gone: its place is not free before kTrial.
  std::erase_if(processes_, [&](Process& process) {
    if (process.peer == owner_ || is_present(process.peer)) return false;
    Drop(process, RefusalCause::kOtherWriter);
    return true;
  });
  Process* const owner = Find(owner_);
  if (owner == nullptr) return;
  while (!owner->held.empty() && now >= owner->held.front().time + kPatience) {
    owner->held_bytes -= BytesOf(owner->held.front().sample);
    refuse_(owner->held.front().sample, RefusalCause::kUnannounced);
    owner->held.pop_front();
  }
  for (Process& process : processes_) {
    if (process.peer == owner_) continue;
    if (OpenSession(process) && IsFree(process, now, is_present)) return MakeOwner(process, now);
    // The owner was heard after the other had begun to ask: both exist, and the other is not the
    // rig.
    if (owner->heard < process.since + kTrial) continue;
    process.refused = true;
    Drop(process, RefusalCause::kOtherWriter);
  }
}

std::vector<RigGate::Rival> RigGate::rivals() const {
  std::vector<Rival> rivals;
  for (const Process& process : processes_) {
    if (process.peer == owner_ || !process.refused) continue;
    // The owner before, never heard again since: an edge that was killed.
    if (process.heard < process.since) continue;
    rivals.push_back({.peer = process.peer, .session = process.rig ? SessionOf(*process.rig) : 0});
  }
  return rivals;
}

}  // namespace isotherm
