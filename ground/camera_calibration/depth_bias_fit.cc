#include "ground/camera_calibration/depth_bias_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "common/base/quantile.h"
#include "common/rig/depth_bias_nodes.h"
#include "ground/camera_calibration/depth_bias_equations.h"

namespace isotherm {
namespace {

constexpr std::size_t kMaxViews = 800;
constexpr std::size_t kMinViews = 40;
// Swellings are smooth: the lenses of camera and projector bend the image slowly.
constexpr int kColumns = 9, kRows = 7, kMaxDistances = 6;
constexpr double kDistanceRatio = 1.4;  // From one distance of the table to the next.
constexpr int kRounds = 6;
// Patches whose inverse depth is off by more than this many standard deviations do not count.
constexpr double kCutSigmas = 4.7;
// Systematic errors are means of at least this many views.
constexpr int kMinMean = 5;
// Parts of a scan that are held out or taken together.
constexpr double kPart_s = 1.0, kMinSeconds = 6.0;

/// The patches' inverse depths as a table corrects them.
std::vector<double> Corrected(const WallView& view, const DepthBias& bias) {
  std::vector<double> corrected;
  corrected.reserve(view.patches.size());
  for (const WallPatch& patch : view.patches) {
    corrected.push_back(patch.inverse_depth /
                        bias.At(patch.across, patch.down, patch.Distance_m()));
  }
  return corrected;
}

/// A table without values whose distances cover those of the wall.
DepthBias EmptyTable(const std::vector<const WallView*>& views) {
  std::vector<double> distances;
  for (const WallView* view : views)
    for (const WallPatch& patch : view->patches) distances.push_back(patch.Distance_m());
  std::sort(distances.begin(), distances.end());
  const double near = distances[distances.size() / 50];
  const double far = distances[distances.size() - 1 - distances.size() / 50];
  const int layers =
      std::clamp(static_cast<int>(std::lround(std::log(far / near) / std::log(kDistanceRatio))) + 1,
                 1, kMaxDistances);
  DepthBias table{.columns = kColumns, .rows = kRows, .distances_m = {}, .multipliers = {}};
  for (int k = 0; k < layers; ++k) {
    const double share = layers > 1 ? static_cast<double>(k) / (layers - 1) : 0.5;
    table.distances_m.push_back(static_cast<float>(near * std::pow(far / near, share)));
  }
  table.multipliers.assign(static_cast<std::size_t>(layers * kColumns * kRows), 1.0F);
  return table;
}

DepthBias FitTable(const std::vector<const WallView*>& views) {
  DepthBias table = EmptyTable(views);
  double cut = kMaxOffWall;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<std::vector<double>> weights;
    std::vector<double> distances;
    for (const WallView* view : views) {
      const WallFit fit = FitWall(*view, Corrected(*view, table), cut);
      std::vector<double>& of_view = weights.emplace_back();
      for (std::size_t i = 0; i < view->patches.size(); ++i) {
        of_view.push_back(view->patches[i].weight * Biweight(fit.off[i], cut));
        distances.push_back(std::abs(fit.off[i]));
      }
    }
    // Of a normal distribution the median is 0.67 standard deviations.
    const double sigma = std::max(1e-5, TakeMedian(distances) / 0.6745);
    DepthBiasEquations equations(table);
    equations.AddPrior();
    for (std::size_t i = 0; i < views.size(); ++i) equations.AddView(*views[i], weights[i], sigma);
    table.multipliers = equations.Solve();
    if (!Validate(table).ok()) break;  // It gets no better, and may hold what is no number.
    cut = std::clamp(kCutSigmas * sigma, 1e-4, kMaxOffWall);
  }
  return table;
}

/// How far walls are from planes, root mean square over places in the image and distances, of means
/// over the views.
std::optional<double> SystematicError(const std::vector<const WallView*>& views,
                                      const DepthBias& bias) {
  struct Mean {
    double sum = 0.0;
    int count = 0;
  };
  std::map<std::tuple<int, int, int>, Mean> places;
  for (const WallView* view : views) {
    const WallFit fit = FitWall(*view, Corrected(*view, bias), kMaxOffWall);
    for (std::size_t i = 0; i < view->patches.size(); ++i) {
      if (std::abs(fit.off[i]) > kMaxOffWall) continue;
      const WallPatch& patch = view->patches[i];
      const double band = std::log(patch.Distance_m()) / std::log(kDistanceRatio);
      Mean& place =
          places[{static_cast<int>(std::floor(band)), static_cast<int>(patch.across * 16.0F),
                  static_cast<int>(patch.down * 12.0F)}];
      place.sum += fit.off[i];
      ++place.count;
    }
  }
  double squares = 0.0, count = 0.0;
  for (const auto& [where, place] : places) {
    if (place.count < kMinMean) continue;
    squares += std::pow(place.sum / place.count, 2);
    count += 1.0;
  }
  if (count == 0.0) return std::nullopt;
  return std::sqrt(squares / count);
}

int CountSeenNodes(const std::vector<const WallView*>& views, const DepthBias& table) {
  std::vector<double> seen(table.multipliers.size(), 0.0);
  for (const WallView* view : views)
    for (const WallPatch& patch : view->patches) {
      const NodeShares at = SharesAt(table, patch.across, patch.down, patch.Distance_m());
      for (std::size_t i = 0; i < 8; ++i) seen[at.nodes[i]] += at.shares[i];
    }
  return static_cast<int>(
      std::count_if(seen.begin(), seen.end(), [](double sum) { return sum >= kMinMean; }));
}

}  // namespace

DepthBiasFit::DepthBiasFit(const CameraModel& depth_camera, DepthBias before)
    : camera_(depth_camera), before_(std::move(before)) {}

void DepthBiasFit::Add(double time_s, const Image<float>& depth_m) {
  CHECK(depth_m.width() == camera_.width && depth_m.height() == camera_.height);
  if (frames_++ % stride_ != 0) return;
  std::optional<WallView> view = SeeWall(camera_, time_s, depth_m);
  if (!view) return;
  views_.push_back(std::move(*view));
  if (views_.size() <= kMaxViews) return;
  // Every second one is enough from now on.
  for (std::size_t i = 1; 2 * i < views_.size(); ++i) views_[i] = std::move(views_[2 * i]);
  views_.resize((views_.size() + 1) / 2);
  stride_ *= 2;
}

Result<DepthBiasReport> DepthBiasFit::Solve(const std::function<void(double)>& progress) const {
  if (views_.size() < kMinViews) {
    return Err(FailedPrecondition(fmt::format(
        "a flat wall fills the image in {} of {} depth frames, {} are needed: move slowly before a "
        "bare wall, from near to far and back, and turn the camera to either side",
        views_.size(), (frames_ + stride_ - 1) / stride_, kMinViews)));
  }
  const auto [first, last] =
      std::minmax_element(views_.begin(), views_.end(),
                          [](const WallView& a, const WallView& b) { return a.time_s < b.time_s; });
  if (const double seen_s = last->time_s - first->time_s; !(seen_s >= kMinSeconds)) {
    return Err(FailedPrecondition(
        fmt::format("the wall was seen for {:.1f} s only, {:g} are needed", seen_s, kMinSeconds)));
  }
  // Of three parts one is held out; the others make two halves.
  std::vector<const WallView*> held_out, all;
  std::array<std::vector<const WallView*>, 2> halves;
  for (const WallView& view : views_) {
    const auto part = static_cast<std::size_t>((view.time_s - first->time_s) / kPart_s) % 3;
    if (part == 2) {
      held_out.push_back(&view);
    } else {
      all.push_back(&view);
      halves[part].push_back(&view);
    }
  }
  if (held_out.empty() || halves[0].empty() || halves[1].empty())
    return Err(FailedPrecondition("the wall was seen now and then only: keep it in view"));
  const auto tell = [&](double fraction) {
    if (progress) progress(fraction);
  };
  DepthBiasReport report;
  report.frames = (frames_ + stride_ - 1) / stride_;
  report.walls = views_.size();
  report.bias = FitTable(all);
  if (Status found = Validate(report.bias); !found.ok()) {
    return Err(FailedPrecondition(fmt::format(
        "distances would have to change by more than a camera's can be wrong: is the wall flat, "
        "and the calibration that of this camera? ({})",
        found.message())));
  }
  tell(0.4);
  const std::array<DepthBias, 2> of_halves = {FitTable(halves[0]), FitTable(halves[1])};
  tell(0.8);
  double squares = 0.0, count = 0.0;
  for (const WallView* view : held_out)
    for (const WallPatch& patch : view->patches) {
      const double distance_m = patch.Distance_m();
      squares += std::pow(of_halves[0].At(patch.across, patch.down, distance_m) -
                              of_halves[1].At(patch.across, patch.down, distance_m),
                          2);
      count += 1.0;
    }
  report.halves_rms = std::sqrt(squares / count);
  const auto before_rms = SystematicError(held_out, before_);
  const auto after_rms = SystematicError(held_out, report.bias);
  if (!before_rms || !after_rms) {
    return Err(FailedPrecondition(
        "what was held out shows no place of the wall often enough: scan for half a minute"));
  }
  report.before_rms = *before_rms;
  report.after_rms = *after_rms;
  report.near_m = report.bias.distances_m.front();
  report.far_m = report.bias.distances_m.back();
  report.nodes = static_cast<int>(report.bias.multipliers.size());
  report.seen_nodes = CountSeenNodes(all, report.bias);
  tell(1.0);
  return report;
}

}  // namespace isotherm
