#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "edge/openni/testing/fake_depth_script.h"

namespace isotherm {

/// Tells the fake driver what to be, for this process and its children. Every change of `script`
/// takes effect with Apply: `connected` at once, the rest when the camera is opened.
class FakeDepthCamera {
 public:
  explicit FakeDepthCamera(std::filesystem::path folder) : path_(std::move(folder) / "depth.txt") {
    Apply();
    setenv("ISOTHERM_FAKE_DEPTH", path_.c_str(), 1);
  }
  ~FakeDepthCamera() { unsetenv("ISOTHERM_FAKE_DEPTH"); }
  FakeDepthCamera(const FakeDepthCamera&) = delete;
  FakeDepthCamera& operator=(const FakeDepthCamera&) = delete;

  void Apply() const {
    // Replaced as a whole: the driver reads it at any moment.
    const std::filesystem::path next = path_.string() + ".next";
    std::ofstream(next) << script.ToText();
    std::filesystem::rename(next, path_);
  }
  void Plug(bool in) {
    script.connected = in;
    Apply();
  }
  const std::filesystem::path& path() const { return path_; }

  FakeDepthScript script;

 private:
  const std::filesystem::path path_;
};

}  // namespace isotherm
