#pragma once

#include <memory>
#include <optional>
#include <string>

#include "common/time/clock.h"
#include "edge/thermal_camera/counter.h"
#include "edge/thermal_camera/thermal_camera.h"

namespace isotherm {

/// Says where the vendor's library and its files are and how the camera is set.
struct OptrisSettings {
  std::string library;  ///< The vendor's, a path or a name that the loader finds.
  std::string config;   ///< The camera's XML file, as the vendor's programs take it.
  std::string formats;  ///< Folder with the vendor's Formats.def.
  /// The measuring range; nullopt: that of the XML file.
  struct Range {
    int min_celsius = 0;
    int max_celsius = 0;
  };
  std::optional<Range> range;
};

/// Optris PI and Xi through the vendor's library, loaded when opened (interface of libirimager as
/// published with version 2 to 8). The library decides how long a read takes: run it in a process
/// of its own. Thread-bound.
class OptrisCamera final : public ThermalCamera {
 public:
  static constexpr const char* kDriver = "optris-sdk";

  /// `clock` must outlive it.
  OptrisCamera(std::string bus_port, OptrisSettings settings, const Clock& clock);
  ~OptrisCamera() override;

  Status Open() override;
  const ThermalCameraInfo& info() const override { return info_; }
  /// Waits for the next frame as long as the library does, whatever `timeout` says.
  Result<std::optional<RawThermalFrame>> Read(Nanoseconds timeout) override;
  void Close() override;
  Status TriggerNuc() override;
  Status SetAutomaticNuc(bool on) override;
  /// Ranges have names in degrees here: OptrisSettings::range.
  Status SetGain(ThermalGain gain) override;

 private:
  struct Library;
  Status Load();
  Status Initialise();
  Status SetRange();

  const Clock& clock_;
  const OptrisSettings settings_;
  ThermalCameraInfo info_;
  std::unique_ptr<Library> library_;
  bool initialised_ = false;
  Unwrapper counter_{32};
};

}  // namespace isotherm
