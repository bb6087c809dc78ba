#include "ground/feedback/reach.h"

namespace isotherm {
namespace {

/// A piece that grew by more than this is another one, and its views are tried anew. Smaller: noise
/// at its border restarts it; larger: new surface beside a crevice is taken for part of it. Not
/// tuned.
constexpr double kSamePiece = 1.3;

}  // namespace

void Reach::Begin(const LackingSurface& surface, int views) {
  Assessment& assessment = assessments_[surface.cell];
  // What was found before counts until the views have been tried anew.
  if (surface.area_m2 > kSamePiece * assessment.area_m2) assessment.is_out_of_reach = false;
  assessment.area_m2 = surface.area_m2;
  assessment.views_left = views;
  assessment.gains = false;
}

void Reach::Note(std::uint64_t cell, bool gains) {
  const auto found = assessments_.find(cell);
  if (found == assessments_.end() || found->second.views_left == 0) return;
  Assessment& assessment = found->second;
  assessment.gains = assessment.gains || gains;
  if (--assessment.views_left == 0) assessment.is_out_of_reach = !assessment.gains;
}

bool Reach::IsOutOfReach(std::uint64_t cell, double area_m2) const {
  const auto found = assessments_.find(cell);
  return found != assessments_.end() && found->second.is_out_of_reach &&
         area_m2 <= kSamePiece * found->second.area_m2;
}

double Reach::OutOfReach(const ModelCoverage& coverage) const {
  double sum_m2 = 0.0;
  for (const auto& [cell, assessment] : assessments_) {
    const double area_m2 = coverage.LackingArea(cell);
    if (IsOutOfReach(cell, area_m2)) sum_m2 += area_m2;
  }
  return sum_m2;
}

}  // namespace isotherm
