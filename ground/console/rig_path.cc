#include "ground/console/rig_path.h"

#include <cstddef>

namespace isotherm {
namespace {

/// Some 50 kB as a message.
constexpr std::size_t kMaxPoints = 4000;

}  // namespace

std::size_t RigPath::points() const {
  std::size_t count = 0;
  for (const Piece& piece : pieces_) count += piece.points.size();
  return count;
}

bool RigPath::Add(int map, const Eigen::Vector3d& position_m) {
  const Eigen::Vector3f point = position_m.cast<float>();
  if (pieces_.empty() || pieces_.back().map != map || is_broken_) {
    is_broken_ = false;
    pieces_.push_back({map, {point}});
    if (RigPath::points() > kMaxPoints) ThinOut();
    return true;
  }
  std::vector<Eigen::Vector3f>& points = pieces_.back().points;
  if ((points.back() - point).norm() < static_cast<float>(step_m_)) return false;
  points.push_back(point);
  if (RigPath::points() > kMaxPoints) ThinOut();
  return true;
}

void RigPath::ThinOut() {
  // Pieces of a point each do not get shorter: the oldest go.
  if (pieces_.size() > kMaxPoints / 2) {
    pieces_.erase(pieces_.begin(),
                  pieces_.begin() + static_cast<std::ptrdiff_t>(pieces_.size() / 2));
    return;
  }
  step_m_ *= 2.0;
  for (Piece& piece : pieces_) {
    std::vector<Eigen::Vector3f> kept;
    for (const Eigen::Vector3f& point : piece.points) {
      if (kept.empty() || (kept.back() - point).norm() >= static_cast<float>(step_m_))
        kept.push_back(point);
    }
    piece.points = std::move(kept);
  }
}

live::Path RigPath::ToMessage() const {
  live::Path path;
  for (const Piece& piece : pieces_) {
    live::Path::Part& part = *path.add_parts();
    part.set_map(static_cast<std::uint32_t>(piece.map));
    for (const Eigen::Vector3f& point : piece.points) {
      for (int axis = 0; axis < 3; ++axis) part.add_positions(point[axis]);
    }
  }
  return path;
}

}  // namespace isotherm
