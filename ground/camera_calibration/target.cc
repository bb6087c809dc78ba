#include "ground/camera_calibration/target.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <sstream>

namespace isotherm {
namespace {

using Pattern = CalibrationTarget::Pattern;

constexpr std::string_view kThesisBoard =
    "asymmetric-circles 4x9 0.05 hole=0.05 thickness=0.001 placement=0.0001";
constexpr std::array<std::pair<std::string_view, Pattern>, 4> kPatterns = {{
    {"asymmetric-circles", Pattern::kAsymmetricCircles},
    {"symmetric-circles", Pattern::kSymmetricCircles},
    {"square-holes", Pattern::kSquareHoles},
    {"chessboard", Pattern::kChessboard},
}};

Status SpecError(std::string_view spec, std::string_view what) {
  return InvalidArgument(fmt::format(
      "target '{}': {} (expected PATTERN COLUMNSxROWS SQUARE, lengths in metres, for example "
      "'asymmetric-circles 4x9 0.05'; --help draws each pattern)",
      spec, what));
}

/// Metres, from a tenth of a millimetre (or 0 if allowed) to 10 m.
std::optional<double> ParseMetres(std::string_view word, bool zero_allowed) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
    return std::nullopt;
  constexpr double kMin_m = 1e-6, kMax_m = 10.0;
  if (value == 0.0 && zero_allowed) return value;
  if (value < kMin_m || value > kMax_m) return std::nullopt;
  return value;
}

bool ParseGrid(std::string_view word, CalibrationTarget& target) {
  const std::size_t x = word.find('x');
  if (x == std::string_view::npos) return false;
  const auto parse = [](std::string_view digits, int& value) {
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    return error == std::errc() && end == digits.data() + digits.size();
  };
  if (!parse(word.substr(0, x), target.columns) || !parse(word.substr(x + 1), target.rows))
    return false;
  constexpr int kMin = 2, kMax = 50;
  return target.columns >= kMin && target.rows >= kMin && target.columns <= kMax &&
         target.rows <= kMax;
}

/// One of the words behind the three that must be there.
bool ParseProperty(std::string_view word, CalibrationTarget& target) {
  if (word == "bright" || word == "dark") {
    target.contrast = word == "bright" ? CalibrationTarget::Contrast::kBright
                                       : CalibrationTarget::Contrast::kDark;
    return true;
  }
  const std::size_t equals = word.find('=');
  if (equals == std::string_view::npos) return false;
  const std::string_view name = word.substr(0, equals);
  const bool zero_allowed = name != "hole";
  const auto value = ParseMetres(word.substr(equals + 1), zero_allowed);
  if (!value) return false;
  if (name == "hole") {
    target.hole_m = *value;
  } else if (name == "thickness") {
    target.thickness_m = *value;
  } else if (name == "placement") {
    target.placement_sigma_m = *value;
  } else if (name == "warp") {
    target.warp_sigma_m = *value;
  } else {
    return false;
  }
  return true;
}

std::vector<std::string> Words(std::string_view text) {
  std::istringstream stream{std::string(text)};
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

/// Neighbouring holes must leave a part of the board between them.
Status CheckHole(const CalibrationTarget& target) {
  if (!target.hole_m) return OkStatus();
  const double nearest_m = target.pattern == Pattern::kAsymmetricCircles
                               ? std::sqrt(2.0) * target.square_m
                               : target.square_m;
  if (*target.hole_m < nearest_m) return OkStatus();
  return SpecError(target.spec,
                   fmt::format("holes of {:g} m do not fit between centres {:g} m apart",
                               *target.hole_m, nearest_m));
}

}  // namespace

bool CalibrationTarget::IsAmbiguous() const {
  return pattern != Pattern::kAsymmetricCircles || rows % 2 == 0;
}

Eigen::Vector2d CalibrationTarget::FeaturePosition(int feature) const {
  const int row = feature / columns, column = feature % columns;
  if (pattern == Pattern::kAsymmetricCircles)
    return {(2 * column + row % 2) * square_m, row * square_m};
  return {column * square_m, row * square_m};
}

Eigen::Vector2d CalibrationTarget::Middle() const {
  const int steps = pattern == Pattern::kAsymmetricCircles ? 2 * columns - 1 : columns - 1;
  return 0.5 * square_m * Eigen::Vector2d(steps, rows - 1);
}

std::optional<int> CalibrationTarget::Mirrored(int feature) const {
  const int row = feature / columns, column = feature % columns;
  if (pattern != Pattern::kAsymmetricCircles) return row * columns + columns - 1 - column;
  if (rows % 2 == 0) return std::nullopt;
  return (rows - 1 - row) * columns + column;
}

bool CalibrationTarget::TellPose(const std::vector<int>& some) const {
  constexpr std::size_t kMinFeatures = 8;
  if (some.size() < kMinFeatures) return false;
  Eigen::Matrix2Xd places(2, static_cast<Eigen::Index>(some.size()));
  for (std::size_t i = 0; i < some.size(); ++i)
    places.col(static_cast<Eigen::Index>(i)) = FeaturePosition(some[i]);
  const Eigen::Matrix2Xd off = places.colwise() - places.rowwise().mean();
  const Eigen::Matrix2d scatter = off * off.transpose() / static_cast<double>(some.size());
  // The spread across: two neighbouring lines have half of their distance.
  constexpr double kMinSpread = 0.4;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(scatter, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()[0])) >= kMinSpread * square_m;
}

Result<CalibrationTarget> ParseTarget(std::string_view spec) {
  const bool thesis = spec == "thesis-board";
  const std::vector<std::string> words = Words(thesis ? kThesisBoard : spec);
  CalibrationTarget target;
  target.spec = std::string(spec);
  constexpr std::size_t kRequired = 3;
  if (words.size() < kRequired) return Err(SpecError(spec, "three words are needed"));
  bool known = false;
  for (const auto& [name, pattern] : kPatterns) {
    if (words[0] != name) continue;
    target.pattern = pattern;
    known = true;
  }
  if (!known) {
    return Err(SpecError(spec, fmt::format("there is no pattern '{}', but asymmetric-circles, "
                                           "symmetric-circles, square-holes, chessboard and "
                                           "thesis-board",
                                           words[0])));
  }
  if (!ParseGrid(words[1], target))
    return Err(SpecError(spec, fmt::format("'{}' is no grid of 2x2 to 50x50 features", words[1])));
  const auto square_m = ParseMetres(words[2], false);
  if (!square_m) return Err(SpecError(spec, fmt::format("'{}' is no length", words[2])));
  target.square_m = *square_m;
  for (std::size_t i = kRequired; i < words.size(); ++i) {
    if (!ParseProperty(words[i], target))
      return Err(SpecError(spec, fmt::format("'{}' is not understood", words[i])));
  }
  const int across =
      target.pattern == Pattern::kAsymmetricCircles ? 2 * target.columns : target.columns;
  if (across == target.rows)
    return Err(SpecError(spec, "it looks the same turned by 90 degrees: leave out a row"));
  if (Status status = CheckHole(target); !status.ok()) return Err(status);
  return target;
}

std::string_view TargetHelp() {
  return R"(Targets: PATTERN COLUMNSxROWS SQUARE [hole=M] [thickness=M] [placement=M] [warp=M] [bright|dark]

  asymmetric-circles 4x5 0.05   symmetric-circles 4x3 0.05   square-holes 4x3 0.05   chessboard 3x2 0.05
    o   o   o   o                 o   o   o   o                []  []  []  []          ##  ##
      o   o   o   o                                                                     ##  ##  3x2 inner
    o   o   o   o                 o   o   o   o                []  []  []  []          ##  ##    corners
      o   o   o   o                                                                     ##  ##
    o   o   o   o                 o   o   o   o                []  []  []  []

COLUMNS are the features in a row, ROWS the rows, as in OpenCV's patternSize. SQUARE is the distance of
neighbours in metres; of rows in an asymmetric grid, where neighbours in a row are twice as far apart
(OpenCV's squareSize). hole is the holes' diameter or side (measured if not given), thickness that of
the layer they are cut into, placement how exactly they were placed (0.0001), warp how far the board may
be off a plane (0.002); all in metres. bright or dark is what holes are in the images; without it both
are tried. thesis-board is the heated target of three layers: asymmetric-circles 4x9 0.05 hole=0.05
thickness=0.001.)";
}

}  // namespace isotherm
