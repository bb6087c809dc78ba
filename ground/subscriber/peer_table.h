#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <utility>

#include "common/transport/endpoints.h"

namespace isotherm {

/// Tells which process wrote a sample. It remembers the writers, because one that has left cannot
/// be asked about, and its last samples may still come. Bounded. Thread-compatible.
class PeerTable {
 public:
  /// A rig has a writer per topic that it publishes. Beyond, writers that have left are forgotten,
  /// and if none has, new ones are not known.
  static constexpr std::size_t kMaxWriters = 512;

  /// Returns the process of `writer`, which is the Received::writer of a sample of `reader`; 0 if
  /// it left before anything of it was seen, or if there are too many. `reader` is a Reader of any
  /// message and must outlive the table.
  template <typename AnyReader>
  PeerHandle Identify(const AnyReader& reader, std::uint64_t writer) {
    if (const auto known = writers_.find(writer); known != writers_.end())
      return known->second.peer;
    const PeerHandle peer = reader.PeerOf(writer);
    if (peer == 0) return 0;
    if (writers_.size() == kMaxWriters) ForgetTheGone();
    if (writers_.size() == kMaxWriters) return 0;
    writers_.emplace(writer, Entry{peer, [&reader, writer] { return reader.PeerOf(writer) != 0; }});
    return peer;
  }

  /// Returns whether a writer of `peer` that was seen is still there.
  bool IsPresent(PeerHandle peer) const {
    for (const auto& [writer, entry] : writers_)
      if (entry.peer == peer && entry.is_there()) return true;
    return false;
  }

 private:
  /// Holds the process that a writer belongs to.
  struct Entry {
    PeerHandle peer = 0;
    std::function<bool()> is_there;
  };

  void ForgetTheGone() {
    std::erase_if(writers_, [](const auto& item) { return !item.second.is_there(); });
  }

  std::map<std::uint64_t, Entry> writers_;
};

}  // namespace isotherm
