#pragma once

#include <vector>

#include "tests/lint/source_tree.h"

namespace isotherm::lint {

/// Checks that the thread sanitizer watches what has several threads: a unit or integration test
/// whose sources, or the class that a source of it tests, start a thread, join two by a queue or
/// talk over DDS is in `isotherm_threaded_tests` (cmake/Isotherm.cmake), or one of its sources says
/// why not, by "not watched by the thread sanitizer: ...". Tests of programs are not asked: the
/// sanitizer does not watch the programs. What the list names must be a test.
std::vector<Violation> CheckThreadedTests(const std::vector<SourceFile>& files);

}  // namespace isotherm::lint
