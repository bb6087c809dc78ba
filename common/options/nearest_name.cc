#include "common/options/nearest_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace isotherm {
namespace {

char LowerAscii(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

// Least number of inserted, deleted, replaced or swapped neighbouring characters between two names,
// without regard to the case of ASCII letters.
std::size_t EditDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  const auto same = [&](std::size_t i, std::size_t j) {
    return LowerAscii(a[i]) == LowerAscii(b[j]);
  };
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::swap(before, above);
    std::swap(above, row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = above[j - 1] + (same(i - 1, j - 1) ? 0 : 1);
      row[j] = std::min({replaced, above[j] + 1, row[j - 1] + 1});
      const bool swapped = i > 1 && j > 1 && same(i - 1, j - 2) && same(i - 2, j - 1);
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row[b.size()];
}

}  // namespace

std::string NearestName(std::string_view name, std::span<const std::string> candidates) {
  constexpr std::size_t kMaxLength = 256;  // Longer names are no typing errors.
  if (name.empty() || name.size() > kMaxLength) return {};
  std::size_t best_distance = std::max<std::size_t>(1, name.size() / 3) + 1;
  std::string best;
  for (const std::string& candidate : candidates) {
    if (candidate.size() > kMaxLength) continue;
    const std::size_t distance = EditDistance(name, candidate);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

std::string DidYouMean(std::string_view name, std::span<const std::string> candidates) {
  const std::string nearest = NearestName(name, candidates);
  return nearest.empty() ? std::string() : fmt::format(" Did you mean '{}'?", nearest);
}

std::function<std::string(std::string&)> NumberOfName(std::map<std::string, int> names) {
  return [names = std::move(names)](std::string& text) {
    std::vector<std::string> known;
    for (const auto& [name, number] : names) {
      if (std::ranges::equal(name, text, {}, LowerAscii, LowerAscii)) {
        text = std::to_string(number);
        return std::string();
      }
      known.push_back(name);
    }
    return fmt::format("'{}' is none of {}.{}", text, JoinNames(known), DidYouMean(text, known));
  };
}

std::string JoinNames(std::span<const std::string> names) {
  std::string joined;
  for (const std::string& name : names) {
    if (!joined.empty()) joined += ", ";
    joined += name;
  }
  return joined;
}

}  // namespace isotherm
