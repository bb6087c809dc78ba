#include "ground/camera_calibration/board_image.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "common/base/check.h"
#include "common/base/noise.h"
#include "common/base/units.h"
#include "ground/camera_calibration/target_detector.h"

namespace isotherm {
namespace {

/// A face in an image: its inverse depth, 1 / m, as a polynomial of the place. That of a plane is
/// linear (`kPlaneTerms`); lens, warp and the depth camera's own errors bend it.
using Face = Eigen::Matrix<double, 6, 1>;
constexpr int kPlaneTerms = 3, kAllTerms = 6;

struct FacePoint {
  Face terms;            ///< Terms of the polynomial there.
  double inverse_depth;  ///< 1 / m.

  /// Along x and y, in halves of the image's width.
  Eigen::Vector2d Place() const { return terms.segment<2>(1); }
};

/// `x` and `y` from the image's middle, in halves of its width, so that all terms are alike.
Face Terms(const Image<float>& image, int x, int y) {
  const double half = 0.5 * image.width();
  const double u = x / half - 1.0, v = (y - 0.5 * image.height()) / half;
  Face terms;
  terms << 1.0, u, v, u * u, u * v, v * v;
  return terms;
}

/// How far a point is behind a face along the optical axis, metres.
double Behind(const Face& face, const FacePoint& point) {
  return 1.0 / point.inverse_depth - 1.0 / face.dot(point.terms);
}

/// Every fourth pixel of the mean of images in inverse depth: enough for planes.
std::vector<FacePoint> PointsOf(const std::vector<Image<float>>& depth_mm) {
  constexpr int kStep = 4;
  std::vector<FacePoint> points;
  for (int y = 0; y < depth_mm.front().height(); y += kStep) {
    for (int x = 0; x < depth_mm.front().width(); x += kStep) {
      double sum = 0.0;
      int count = 0;
      for (const Image<float>& image : depth_mm) {
        const auto mm = static_cast<double>(image.At(x, y));
        if (!(mm > 0.0)) continue;
        sum += kMmPerM / mm;
        ++count;
      }
      if (2 * count > static_cast<int>(depth_mm.size()))
        points.push_back({Terms(depth_mm.front(), x, y), sum / count});
    }
  }
  return points;
}

/// Least squares with the first `count` terms.
Face FitFace(const std::vector<FacePoint>& points, int count) {
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(count, count);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(count);
  for (const FacePoint& p : points) {
    normal += p.terms.head(count) * p.terms.head(count).transpose();
    right += p.terms.head(count) * p.inverse_depth;
  }
  Face face = Face::Zero();
  face.head(count) = normal.ldlt().solve(right);
  return face;
}

/// A face is warped and noisy by less, metres; what is seen through its holes is farther behind.
constexpr double kFaceDepth_m = 0.006;

bool IsOn(const Face& face, const FacePoint& p) {
  return face.dot(p.terms) > 0.0 && std::abs(Behind(face, p)) < kFaceDepth_m;
}

struct FoundFace {
  Face face;
  std::vector<FacePoint> on, off;
};

FoundFace Split(const Face& face, const std::vector<FacePoint>& points) {
  FoundFace found{face, {}, {}};
  for (const FacePoint& p : points) {
    (IsOn(face, p) ? found.on : found.off).push_back(p);
  }
  return found;
}

/// Draws three points that are near each other, so that they often lie on one plane.
std::vector<FacePoint> DrawTriple(const std::vector<FacePoint>& points, std::uint64_t stream) {
  // Halves of the image's width. Wider: rarely on one small board; closer: noise tilts the plane.
  constexpr double kReach = 0.3;
  constexpr std::uint64_t kMaxDraws = 60;
  std::vector<FacePoint> triple;
  for (std::uint64_t i = 0; i < kMaxDraws && triple.size() < 3; ++i) {
    const double at = UniformNoise(stream, i) * static_cast<double>(points.size() - 1);
    const FacePoint& point = points[static_cast<std::size_t>(at)];
    if (triple.empty() || (point.Place() - triple.front().Place()).norm() < kReach)
      triple.push_back(point);
  }
  return triple;
}

/// The plane that most points lie on, by random triples; nullopt if it is of few.
std::optional<FoundFace> LargestPlane(const std::vector<FacePoint>& points, std::uint64_t seed) {
  constexpr std::uint64_t kTries = 400;
  constexpr int kRefinements = 4;
  // A board is larger than a fiftieth of what has a depth, and a plane is not met by chance.
  constexpr std::size_t kMinPoints = 200;
  const std::size_t least = std::max(kMinPoints, points.size() / 50);
  if (points.size() < least) return std::nullopt;
  std::optional<Face> best;
  std::ptrdiff_t most_on = 0;
  for (std::uint64_t i = 0; i < kTries; ++i) {
    const std::vector<FacePoint> triple = DrawTriple(points, NoiseStream(seed, i, 0));
    if (triple.size() < 3) continue;
    const Face plane = FitFace(triple, kPlaneTerms);
    if (!plane.allFinite()) continue;
    const auto on = std::ranges::count_if(points, [&](const auto& p) { return IsOn(plane, p); });
    if (on <= most_on) continue;
    best = plane;
    most_on = on;
  }
  if (!best) return std::nullopt;
  FoundFace found = Split(*best, points);
  for (int i = 0; i < kRefinements && found.on.size() >= least; ++i)
    found = Split(FitFace(found.on, i == 0 ? kPlaneTerms : kAllTerms), points);
  if (found.on.size() < least) return std::nullopt;
  return found;
}

Image<float> HolesIn(const Face& face, const std::vector<Image<float>>& depth_mm) {
  Image<float> holes(depth_mm.front().width(), depth_mm.front().height());
  for (int y = 0; y < holes.height(); ++y) {
    for (int x = 0; x < holes.width(); ++x) {
      const Face terms = Terms(holes, x, y);
      double sum = 0.0;
      for (const Image<float>& image : depth_mm) {
        const auto mm = static_cast<double>(image.At(x, y));
        // No return is what holes and their shadows give.
        const double off_m =
            mm > 0.0 ? std::abs(Behind(face, {terms, kMmPerM / mm})) : kFaceDepth_m;
        sum += off_m < kFaceDepth_m ? 0.0 : 1.0;
      }
      holes.At(x, y) = static_cast<float>(sum / static_cast<double>(depth_mm.size()));
    }
  }
  return holes;
}

}  // namespace

Image<float> BoardImage(const std::vector<Image<float>>& depth_mm,
                        const CalibrationTarget& target) {
  CHECK(!depth_mm.empty());
  for (const Image<float>& image : depth_mm)
    CHECK(image.width() == depth_mm.front().width() && image.height() == depth_mm.front().height());
  // Board, wall, floor and one more.
  constexpr std::uint64_t kPlanes = 4;
  std::vector<FacePoint> rest = PointsOf(depth_mm);
  std::optional<Face> nearest;
  // In all of them holes are bright.
  CalibrationTarget bright = target;
  bright.contrast = CalibrationTarget::Contrast::kBright;
  const auto as_asked = [&](Image<float> holes) {
    if (target.contrast == CalibrationTarget::Contrast::kDark)
      for (float& value : holes.pixels()) value = 1.0F - value;
    return holes;
  };
  for (std::uint64_t i = 0; i < kPlanes; ++i) {
    std::optional<FoundFace> found = LargestPlane(rest, i);
    if (!found) break;
    Image<float> holes = HolesIn(found->face, depth_mm);
    if (DetectTarget(holes, bright)) return as_asked(std::move(holes));
    // The first term is the inverse depth in the middle of the image.
    if (!nearest || found->face[0] > (*nearest)[0]) nearest = found->face;
    rest = std::move(found->off);
  }
  if (nearest) return as_asked(HolesIn(*nearest, depth_mm));
  return Image<float>(depth_mm.front().width(), depth_mm.front().height(), 1.0F);
}

}  // namespace isotherm
