#pragma once

#include <string>
#include <vector>

#include "common/base/status.h"

namespace CLI {
class App;
}

namespace isotherm {

class GroundOptions;

/// Collects all that is wrong with a command line, so that it is said at once. Thread-compatible.
class Problems {
 public:
  void Add(const Status& status);
  bool empty() const { return text_.empty(); }
  /// One problem per line.
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// Holds where a command's options come from besides flags of its own: --config and --set.
struct ConfigurationArguments {
  std::string file;  ///< Empty: none.
  std::vector<std::string> overrides;
};

/// Adds --config and --set to the command. `arguments` must outlive it.
void AddConfigurationArguments(CLI::App& command, ConfigurationArguments& arguments);

/// Reads the file into `options`, then the overrides.
void Apply(const ConfigurationArguments& arguments, GroundOptions& options, Problems& problems);

/// Adds what the stages say against the options. To be called last: options that could not be read
/// would lead to problems that are none, so it does nothing if there are some already.
void AddInvalid(const GroundOptions& options, Problems& problems);

}  // namespace isotherm
