#include "edge/thermal_camera/optris_camera.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <cstring>
#include <utility>

namespace isotherm {
namespace {

/// Holds what the library tells about a frame (its EvoIRFrameMetadata, natural alignment).
struct Metadata {
  std::uint32_t counter;
  std::uint32_t counter_hw;
  std::int64_t timestamp;        ///< 100 ns.
  std::int64_t timestamp_media;  ///< 100 ns.
  std::int32_t flag_state;       ///< 0 open, 1 closed, 2 opening, 3 closing, 4 error.
  float chip_celsius;
  float flag_celsius;
  float box_celsius;
};
static_assert(sizeof(Metadata) == 40 && offsetof(Metadata, flag_state) == 24);
// A longer structure of a newer library must not write beyond ours.
constexpr std::size_t kMetadataRoom = 128;

// Celsius = (count - 1000) / 10.
constexpr PixelEncoding kEncoding{true, 0.1, kCelsiusZero_k - 100.0};
constexpr int kMaxPixels = 4096;  ///< Per side; more is no camera.

NucState StateOf(int flag) {
  switch (flag) {
    case 0:
      return NucState::kIdle;
    case 1:
    case 2:
    case 3:
      return NucState::kInProgress;
    case 4:
      return NucState::kError;
    default:
      return NucState::kUnknown;
  }
}

}  // namespace

/// The loaded library and its functions.
struct OptrisCamera::Library {
  struct Unload {
    void operator()(void* library) const { dlclose(library); }
  };
  std::unique_ptr<void, Unload> handle;
  int (*usb_init)(const char* config, const char* formats, const char* log) = nullptr;
  int (*terminate)() = nullptr;
  int (*get_size)(int* width, int* height) = nullptr;
  int (*get_image)(int* width, int* height, unsigned short* data, void* metadata) = nullptr;
  int (*set_shutter_mode)(int automatic) = nullptr;
  int (*trigger_shutter)() = nullptr;
  int (*set_radiation)(float emissivity, float transmissivity, float ambient) = nullptr;
  int (*get_serial)(unsigned long* serial) = nullptr;            ///< May be missing.
  int (*set_range)(int min_celsius, int max_celsius) = nullptr;  ///< May be missing.

  template <typename Function>
  bool Find(const char* name, Function& function) {
    function = reinterpret_cast<Function>(dlsym(handle.get(), name));
    return function != nullptr;
  }
  /// The name of the first function that is missing; nullptr = all are there.
  const char* FindAll() {
    Find("evo_irimager_get_serial", get_serial);
    Find("evo_irimager_set_temperature_range", set_range);
    // All are looked up at once, so that an unfit library is found before the camera is touched.
    if (!Find("evo_irimager_usb_init", usb_init)) return "evo_irimager_usb_init";
    if (!Find("evo_irimager_terminate", terminate)) return "evo_irimager_terminate";
    if (!Find("evo_irimager_get_thermal_image_size", get_size)) {
      return "evo_irimager_get_thermal_image_size";
    }
    if (!Find("evo_irimager_get_thermal_image_metadata", get_image)) {
      return "evo_irimager_get_thermal_image_metadata";
    }
    if (!Find("evo_irimager_set_shutter_mode", set_shutter_mode)) {
      return "evo_irimager_set_shutter_mode";
    }
    if (!Find("evo_irimager_trigger_shutter_flag", trigger_shutter)) {
      return "evo_irimager_trigger_shutter_flag";
    }
    if (!Find("evo_irimager_set_radiation_parameters", set_radiation)) {
      return "evo_irimager_set_radiation_parameters";
    }
    return nullptr;
  }
};

OptrisCamera::OptrisCamera(std::string bus_port, OptrisSettings settings, const Clock& clock)
    : clock_(clock), settings_(std::move(settings)) {
  info_.driver = kDriver;
  info_.product = "Optris";
  info_.bus_port = std::move(bus_port);
  info_.counter_step = 1;
  info_.start_time = std::chrono::seconds(10);  // Its first correction takes three.
}

OptrisCamera::~OptrisCamera() { Close(); }

Status OptrisCamera::Load() {
  auto library = std::make_unique<Library>();
  // Its symbols stay local: it links libraries of its own that must not replace ours. Unresolved
  // ones show now, not in the middle of a scan.
  library->handle.reset(dlopen(settings_.library.c_str(), RTLD_NOW | RTLD_LOCAL));
  if (!library->handle) {
    return FailedPrecondition(fmt::format(
        "the Optris library cannot be loaded: {}; install the vendor's package, or name "
        "it in source.thermal_camera.expert.optris_library",
        dlerror()));
  }
  if (const char* missing = library->FindAll()) {
    return FailedPrecondition(
        fmt::format("{} is no Optris library: it has no {}", settings_.library, missing));
  }
  library_ = std::move(library);
  return OkStatus();
}

Status OptrisCamera::Open() {
  Close();
  if (settings_.config.empty()) {
    return InvalidArgument(
        "source.thermal_camera.expert.optris_config is empty; name the camera's XML file");
  }
  ISOTHERM_RETURN_IF_ERROR(Load());
  // usb_init may have succeeded before something else failed: the camera must be given back.
  const Status done = Initialise();
  if (!done.ok()) Close();
  return done;
}

Status OptrisCamera::Initialise() {
  if (library_->usb_init(settings_.config.c_str(), settings_.formats.c_str(), nullptr) != 0) {
    return Unavailable(fmt::format("the Optris library finds no camera for {}", settings_.config));
  }
  initialised_ = true;
  if (library_->get_size(&info_.width, &info_.height) != 0 || info_.width < 1 || info_.height < 1 ||
      info_.width > kMaxPixels || info_.height > kMaxPixels) {
    return DataLoss(fmt::format("the Optris camera says {}x{} pixels", info_.width, info_.height));
  }
  // The ground applies emissivity and transmission.
  if (library_->set_radiation(1.0F, 1.0F, -300.0F) != 0) {
    return IoError("the Optris camera does not take emissivity and transmission for 1");
  }
  ISOTHERM_RETURN_IF_ERROR(SetRange());
  unsigned long serial = 0;
  if (library_->get_serial != nullptr && library_->get_serial(&serial) == 0) {
    info_.serial = std::to_string(serial);
  }
  counter_.Reset();
  return OkStatus();
}

Status OptrisCamera::SetRange() {
  info_.settings = "range as in " + settings_.config;
  if (!settings_.range) return OkStatus();
  const auto [lowest, highest] = *settings_.range;
  if (library_->set_range == nullptr) {
    return FailedPrecondition(settings_.library +
                              " has no evo_irimager_set_temperature_range: set the range in "
                              "the camera's XML file, and leave optris_min_celsius unset");
  }
  // It takes a range that the camera is calibrated for, and ends with a correction.
  if (library_->set_range(lowest, highest) != 0) {
    return FailedPrecondition(fmt::format(
        "the Optris camera has no range of {} to {} degrees Celsius: take one that its calibration "
        "files are named after (source.thermal_camera.expert.optris_min_celsius, "
        "optris_max_celsius)",
        lowest, highest));
  }
  info_.settings = fmt::format("range {} to {} degrees Celsius", lowest, highest);
  info_.range = MeasuringRange{static_cast<double>(lowest), static_cast<double>(highest)};
  return OkStatus();
}

Status OptrisCamera::SetGain(ThermalGain gain) {
  if (gain == ThermalGain::kKeep) return OkStatus();
  return Refuse("has ranges in degrees: optris_min_celsius and optris_max_celsius instead of gain");
}

Result<std::optional<RawThermalFrame>> OptrisCamera::Read(Nanoseconds) {
  if (!initialised_) return Err(Unavailable("the Optris camera is not open"));
  int width = info_.width;
  int height = info_.height;
  RawThermalFrame raw;
  raw.counts.Resize(width, height);
  alignas(Metadata) std::array<std::byte, kMetadataRoom> room{};
  const int code = library_->get_image(&width, &height, raw.counts.data(), room.data());
  if (code != 0) return Err(Unavailable(fmt::format("the Optris camera fails, code={}", code)));
  if (width != info_.width || height != info_.height) {
    return Err(DataLoss(fmt::format("the Optris camera sends {}x{} pixels instead of {}x{}", width,
                                    height, info_.width, info_.height)));
  }
  Metadata metadata;
  std::memcpy(&metadata, room.data(), sizeof(metadata));
  raw.first_packet = {clock_.Now(), clock_.SteadyNow()};
  raw.encoding = kEncoding;
  // 100 ns to microseconds.
  raw.device_ticks = DeviceTicks(std::chrono::microseconds(metadata.timestamp_media / 10));
  raw.device_counter = counter_.Process(metadata.counter_hw);
  raw.nuc = CameraNuc{StateOf(metadata.flag_state), NucSource::kInBand, std::nullopt};
  raw.shutter_closed = raw.nuc->state == NucState::kInProgress;
  raw.housekeeping = {metadata.chip_celsius, metadata.box_celsius, metadata.flag_celsius};
  return std::optional(std::move(raw));
}

void OptrisCamera::Close() {
  if (initialised_) static_cast<void>(library_->terminate());
  initialised_ = false;
  library_.reset();
}

Status OptrisCamera::TriggerNuc() {
  if (!initialised_) return Unavailable("the Optris camera is not open");
  return library_->trigger_shutter() == 0 ? OkStatus() : IoError("the Optris shutter refuses");
}

Status OptrisCamera::SetAutomaticNuc(bool on) {
  if (!initialised_) return Unavailable("the Optris camera is not open");
  return library_->set_shutter_mode(on ? 1 : 0) == 0 ? OkStatus()
                                                     : IoError("the Optris shutter refuses");
}

}  // namespace isotherm
