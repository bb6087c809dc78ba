#pragma once

#include <memory>

#include "common/base/status.h"
#include "common/messages/messages.h"
#include "common/time/clock.h"
#include "ground/console/console_feed.h"
#include "ground/console/presenter.h"
#include "ground/options/ground_options.pb.h"

namespace isotherm {

/// The console of a service: serves the page and what it shows, on two threads of its own, one for
/// the network and one that makes what is shown. Nothing that serves a scan waits for them.
class Console {
 public:
  /// Serves until it is destroyed. kUnavailable: the port is taken.
  static Result<std::unique_ptr<Console>> Start(const GroundOptions& options, const Clock& clock,
                                                ConsoleServices services);
  ~Console();
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  /// For the reconstruction thread.
  ConsoleFeed& feed();
  /// A scan has ended; its model no longer changes, but is gone when nobody shows it any more.
  /// Thread-safe.
  void EndScan(std::uint64_t scan, std::vector<ReadableMap> maps);
  /// Shows a scan that is finished, instead of what was shown before. Thread-safe.
  void Show(ScanBegun scan, ScanEnded end);
  /// Thread-safe.
  void OnCommandResult(const CommandResult& result);

  /// Where a browser finds it.
  std::string address() const;
  /// The same in lines for people, with codes and certificate if it needs them. In a terminal codes
  /// are shown, as a QR code too; elsewhere it says where they are.
  std::string HowToComeIn(bool is_terminal) const;

 private:
  struct Parts;
  explicit Console(std::unique_ptr<Parts> parts);
  const std::unique_ptr<Parts> parts_;
};

}  // namespace isotherm
