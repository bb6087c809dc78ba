#pragma once

#include <vector>

#include "tests/lint/folder_arrows.h"
#include "tests/lint/source_tree.h"

namespace isotherm::lint {

/// Checks who includes whom (docs/architecture.md, "Dependency rule"):
///   - a folder includes only folders below it; `edge` and `ground` never each other;
///   - a stage includes only the folders it is listed with (folder_arrows.cc): its options and
///     those that declare its input, never the pipeline;
///   - a third-party SDK header appears in exactly one folder and only in .cc files;
///   - heavy library headers (OpenCV, Protobuf, ...) do not leave a folder through its headers;
///   - our own headers are included by their path from the root, never relatively.
/// Tests may look across stages, but not across the edge-ground border unless they live in tests/.
std::vector<Violation> CheckIncludes(const std::vector<SourceFile>& files);

/// Checks that no folder stands on a folder that stands on it, whatever the table allows. Tests do
/// not count.
std::vector<Violation> CheckCircles(const std::vector<SourceFile>& files);

/// Checks that the rule says nothing that is not so: the folders it lists are there, each arrow is
/// used by an include of a program, and each SDK header is included in its home.
std::vector<Violation> CheckListed(const std::vector<SourceFile>& files,
                                   const DependencyRule& rule);

}  // namespace isotherm::lint
