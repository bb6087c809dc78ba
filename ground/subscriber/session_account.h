#pragma once

#include <cstdint>

#include "common/transport/messages.h"

namespace isotherm {

/// published = received + missing, always. `received` are distinct frames that were good; late ones
/// included.
struct StreamAccount {
  std::uint64_t published =
      0;  ///< As the edge says; while it has not said it yet, what can be inferred.
  std::uint64_t received = 0;
  std::uint64_t missing = 0;
  std::uint64_t late = 0;        ///< Of those received: behind the reorder window.
  std::uint64_t duplicates = 0;  ///< Further copies, dropped.
  std::uint64_t refused =
      0;  ///< Samples that were dropped as malformed; their numbers stay missing.
};

struct SessionAccount {
  std::uint64_t session = 0;
  bool ended = false;   ///< The edge has said its final counts.
  bool closed = false;  ///< ... and everything has arrived or was given up.
  StreamAccount depth;
  StreamAccount thermal;
  FeedbackLatency feedback;  ///< As the edge measured it.
};

}  // namespace isotherm
