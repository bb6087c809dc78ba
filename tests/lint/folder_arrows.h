#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace isotherm::lint {

using Folders = std::set<std::string, std::less<>>;

/// Says which folders each folder may include besides itself: its options and the folders that
/// declare its input. The order is that of the line, from what others stand on to what stands on
/// others.
using FolderArrows = std::map<std::string, Folders, std::less<>>;

/// Says who may include whom (docs/architecture.md, "Folders and the dependency rule").
struct DependencyRule {
  FolderArrows arrows;  ///< Every folder with code; without those to `shared` from edge and ground.
  Folders shared;       ///< Folders of `common` that every folder of edge and ground may include.
  std::map<std::string, std::string> sdk_homes;  ///< Header prefix and the only folder that has it.

  bool Allows(std::string_view folder, std::string_view target) const;
};

/// The rule of this repository.
const DependencyRule& RepositoryRule();

/// Folders that lead back to the first, which is named again at the end ("a", "b", "a"); empty if
/// there is no circle.
std::vector<std::string> FindCircle(const FolderArrows& arrows);

}  // namespace isotherm::lint
