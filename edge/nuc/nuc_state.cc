#include "edge/nuc/nuc_state.h"

#include <algorithm>
#include <iterator>

namespace isotherm {
namespace {

/// A row of the table of states.
struct Row {
  NucState state;
  bool (*applies)(const NucFacts& facts, NucState camera);
};

using enum NucState;

// From what is certain and forbids most to what is wished for. The last row always applies.
constexpr Row kRows[] = {
    {kError, [](const NucFacts& f, NucState camera) { return camera == kError || f.is_stuck; }},
    {kInProgress, [](const NucFacts& f, NucState) { return f.is_closed; }},
    {kSettling,
     [](const NucFacts& f, NucState camera) { return f.is_settling || camera == kSettling; }},
    {kImminent,
     [](const NucFacts& f, NucState camera) { return f.is_ordered || camera == kImminent; }},
    {kBlocked,
     [](const NucFacts& f, NucState camera) { return f.is_given_up || camera == kBlocked; }},
    {kUnknown,
     [](const NucFacts& f, NucState) { return f.waits_for_first || f.waits_for_warm_up; }},
    {kDesired, [](const NucFacts& f, NucState camera) { return f.is_due || camera == kDesired; }},
    {kIdle, [](const NucFacts&, NucState) { return true; }},
};

/// An edge that learns late of a correction, or never, could take the shutter for the scene.
bool IsToldInTime(const NucFacts& facts) {
  return facts.camera ? facts.camera->source == NucSource::kInBand : facts.is_shutter_reported;
}

}  // namespace

NucState StateFrom(const NucFacts& facts) {
  const NucState camera = facts.camera ? facts.camera->state : kUnknown;
  return std::find_if(std::begin(kRows), std::end(kRows),
                      [&](const Row& row) { return row.applies(facts, camera); })
      ->state;
}

bool IsValid(NucState state, const NucFacts& facts) {
  if (facts.waits_for_first || facts.waits_for_warm_up) return false;
  switch (state) {
    case kIdle:
    case kDesired:
    case kBlocked:
      return true;
    case kImminent:
      return IsToldInTime(facts);
    default:
      return false;
  }
}

}  // namespace isotherm
