#include "ground/radiometric_calibration/housing_drift_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "ground/radiometric_calibration/recorded_thermal.h"
#include "ground/thermal/nuc_epochs.h"

namespace isotherm {
namespace {

/// Readings of so long are one for the uncertainty: a camera's flicker lasts for half a second.
constexpr double kBlock_s = 2.0;
/// Some ten times the 0.1 K of flicker and noise that the mean of an image has, at 4 K for each.
constexpr double kMinChange_k = 0.2;
constexpr int kMinBlocks = 10;

/// The mean of the samples of one epoch and kBlock_s.
struct Block {
  int epoch = 0;
  double change_k = 0.0, reading = 0.0;
};

std::vector<Block> BlocksOf(const std::vector<DriftSample>& samples) {
  std::map<std::pair<int, long>, std::pair<Block, int>> sums;
  for (const DriftSample& sample : samples) {
    const auto number = static_cast<long>(std::floor(sample.time_s / kBlock_s));
    auto& [block, count] = sums[{sample.epoch, number}];
    block.epoch = sample.epoch;
    block.change_k += sample.housing_change_k;
    block.reading += sample.reading_celsius;
    ++count;
  }
  std::vector<Block> blocks;
  for (const auto& [place, sum] : sums) {
    const auto& [block, count] = sum;
    blocks.push_back({block.epoch, block.change_k / count, block.reading / count});
  }
  return blocks;
}

/// Blocks without the means of their epochs, of which they tell the slope.
void Center(std::vector<Block>& blocks) {
  std::map<int, std::pair<Block, int>> sums;
  for (const Block& block : blocks) {
    auto& [sum, count] = sums[block.epoch];
    sum.change_k += block.change_k;
    sum.reading += block.reading;
    ++count;
  }
  for (Block& block : blocks) {
    const auto& [sum, count] = sums[block.epoch];
    block.change_k -= sum.change_k / count;
    block.reading -= sum.reading / count;
  }
}

/// Sums over blocks that are centered.
struct Sums {
  double changes2 = 0.0, products = 0.0, readings2 = 0.0;

  double Slope() const { return changes2 > 0.0 ? products / changes2 : 0.0; }
  /// Sum of the squares of what a slope leaves.
  double Left(double slope) const {
    return readings2 - 2.0 * slope * products + slope * slope * changes2;
  }
};

Sums SumsOf(const std::vector<Block>& blocks) {
  Sums sums;
  for (const Block& block : blocks) {
    sums.changes2 += block.change_k * block.change_k;
    sums.products += block.change_k * block.reading;
    sums.readings2 += block.reading * block.reading;
  }
  return sums;
}

/// Says what each epoch tells of the others, and they of it.
struct EpochComparison {
  double left_k = 0.0;  ///< Root mean square of what the slope of the others leaves.
  double sigma = 0.0;   ///< Uncertainty of the slope of all, by leaving one out (jackknife).
};

EpochComparison CompareEpochs(const std::vector<Block>& centered) {
  std::map<int, std::vector<Block>> epochs;
  for (const Block& block : centered) epochs[block.epoch].push_back(block);
  const Sums all = SumsOf(centered);
  double left = 0.0, sum = 0.0, squares = 0.0;
  const auto count = static_cast<double>(epochs.size());
  for (const auto& [epoch, blocks] : epochs) {
    const Sums own = SumsOf(blocks);
    const double slope = Sums{all.changes2 - own.changes2, all.products - own.products}.Slope();
    left += std::max(0.0, own.Left(slope));
    sum += slope;
    squares += slope * slope;
  }
  const double variance = (count - 1.0) / count * (squares - sum * sum / count);
  return {std::sqrt(left / static_cast<double>(centered.size())),
          std::sqrt(std::max(0.0, variance))};
}

double MostChange(const std::vector<DriftSample>& samples) {
  std::map<int, std::pair<double, double>> spans;
  for (const DriftSample& sample : samples) {
    const auto [at, is_new] =
        spans.try_emplace(sample.epoch, sample.housing_change_k, sample.housing_change_k);
    at->second.first = std::min(at->second.first, sample.housing_change_k);
    at->second.second = std::max(at->second.second, sample.housing_change_k);
  }
  double most_k = 0.0;
  for (const auto& [epoch, span] : spans) most_k = std::max(most_k, span.second - span.first);
  return most_k;
}

}  // namespace

Result<DriftReport> FitHousingDrift(const std::vector<DriftSample>& samples) {
  DriftReport report;
  report.frames = samples.size();
  report.most_change_k = MostChange(samples);
  if (report.most_change_k < kMinChange_k) {
    return Err(FailedPrecondition(fmt::format(
        "between two NUCs the housing changes by {:.2f} K: record the camera from switching it on, "
        "with a NUC every few minutes",
        report.most_change_k)));
  }
  std::vector<Block> blocks = BlocksOf(samples);
  std::set<int> epochs;
  for (const Block& block : blocks) epochs.insert(block.epoch);
  report.epochs = static_cast<int>(epochs.size());
  if (report.epochs < 2 || static_cast<int>(blocks.size()) < report.epochs + kMinBlocks) {
    return Err(FailedPrecondition(fmt::format(
        "{} thermal frames in {} parts between NUCs are too few: record for minutes, with NUCs",
        samples.size(), report.epochs)));
  }
  Center(blocks);
  const EpochComparison compared = CompareEpochs(blocks);
  report.held_out_k = compared.left_k;
  const Sums sums = SumsOf(blocks);
  const double slope = sums.Slope();
  const auto freedom = static_cast<double>(blocks.size() - epochs.size() - 1);
  report.before_k = std::sqrt(sums.readings2 / static_cast<double>(blocks.size()));
  // What strays is not always noise: epochs may differ by more.
  const double noise = std::sqrt(std::max(0.0, sums.Left(slope)) / freedom / sums.changes2);
  report.drift = {slope, std::max(noise, compared.sigma)};
  return report;
}

Result<DriftReport> FindHousingDrift(const std::filesystem::path& recording,
                                     std::optional<Rig>& rig,
                                     const std::function<void(double)>& progress) {
  std::vector<DriftSample> samples;
  NucEpochs epochs;
  int epoch = 0;
  std::optional<std::uint8_t> last;
  std::optional<double> start_s;
  std::uint64_t without_housing = 0;
  const Status status = ReadThermalFrames(recording, rig, progress, [&](const ThermalFrame& frame) {
    const NucAge nuc = epochs.Follow(frame);
    if (!frame.valid) return OkStatus();
    if (last && *last != nuc.epoch) ++epoch;
    last = nuc.epoch;
    if (!nuc.housing_change_k) {
      ++without_housing;
      return OkStatus();
    }
    double sum = 0.0;
    std::size_t count = 0;
    for (const std::uint16_t value : frame.temperature_raw.pixels()) {
      if (value == 0) continue;
      sum += value;
      ++count;
    }
    if (count == 0) return OkStatus();
    const double time_s = ToSeconds(frame.header.capture_time.time_since_epoch());
    if (!start_s) start_s = time_s;
    const double mean = sum / static_cast<double>(count);
    samples.push_back({time_s - *start_s, epoch, *nuc.housing_change_k,
                       frame.scale.Kelvin(mean) - kCelsiusZero_k});
    return OkStatus();
  });
  if (!status.ok()) return Err(status);
  if (samples.empty()) {
    return Err(FailedPrecondition(
        fmt::format("{}: none of its {} valid thermal frames tells the housing's temperature",
                    recording.string(), without_housing)));
  }
  Result<DriftReport> report = FitHousingDrift(samples);
  if (!report) return Err(report.error().WithContext(recording.string()));
  return report;
}

}  // namespace isotherm
