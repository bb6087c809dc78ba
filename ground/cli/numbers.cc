#include "ground/cli/numbers.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/dataset/text_lines.h"

namespace isotherm {

Result<std::vector<double>> ParseNumbers(std::string_view text,
                                         std::initializer_list<std::size_t> counts,
                                         std::string_view option) {
  std::string spaced(text);
  std::replace(spaced.begin(), spaced.end(), ',', ' ');
  std::vector<double> numbers;
  std::string_view rest = spaced;
  for (std::string_view word = NextWord(rest); !word.empty(); word = NextWord(rest)) {
    const Result<double> number = ParseNumber(word);
    if (!number)
      return Err(InvalidArgument(fmt::format("{}: {}", option, number.error().message())));
    numbers.push_back(*number);
  }
  if (std::find(counts.begin(), counts.end(), numbers.size()) != counts.end()) return numbers;
  std::string expected;
  for (const std::size_t count : counts)
    expected += fmt::format("{}{}", expected.empty() ? "" : " or ", count);
  return Err(InvalidArgument(fmt::format("{}: expected {} numbers, got {} in '{}'", option,
                                         expected, numbers.size(), text)));
}

}  // namespace isotherm
