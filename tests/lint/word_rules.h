#pragma once

#include <vector>

#include "tests/lint/source_tree.h"

namespace isotherm::lint {

/// Keeps the words that were decided on, and comments that can be read aloud, in code:
///   - a doc comment is a sentence: it begins with none of the words that begin a fragment ("Of",
///   "What", "Whether" and so on), and not with dots, which run on from the one before;
///   - a constant that bounds something is kMax or kMin, not a superlative;
///   - comments say image, assess, fraction and counters where they once had other words.
/// Names of the wire and of files that older versions wrote are no comments and may stay.
std::vector<Violation> CheckWords(const std::vector<SourceFile>& files);

}  // namespace isotherm::lint
