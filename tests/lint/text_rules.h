#pragma once

#include <vector>

#include "tests/lint/source_tree.h"

namespace isotherm::lint {

/// Checks what a reader of the text expects:
///   - nothing names a place on one developer's machine (home folders and the like);
///   - headers have `#pragma once` (parts of SIMD kernels, `-inl.h`, have Highway's guard) and no
///   `using namespace`;
///   - tests are skipped with a reason, never disabled;
///   - CMake files list their sources, set no CPU flags, and say what their folder is for;
///   - no trailing blanks, no tabs in code;
///   - relative links in Markdown lead to a file (`root` is where paths start), and files and tests
///   that a page names are there.
std::vector<Violation> CheckText(const std::vector<SourceFile>& files,
                                 const std::filesystem::path& root);

/// Code files longer than `max_lines`: a notice to think about, not a failure.
std::vector<Violation> FindLongFiles(const std::vector<SourceFile>& files, std::size_t max_lines);

}  // namespace isotherm::lint
