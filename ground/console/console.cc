#include "ground/console/console.h"

#include <fmt/format.h>

#include <utility>
#include <variant>

#include "common/base/log.h"
#include "common/base/processor_time.h"
#include "common/concurrency/worker.h"
#include "ground/console/console_routes.h"
#include "ground/console/door.h"
#include "ground/console/live_hub.h"
#include "ground/console/live_session.h"
#include "ground/console/web_server.h"
#include "ground/console/welcome.h"

namespace isotherm {
namespace {

/// The reconstruction goes first.
constexpr int kNiceness = 10;

WebServerOptions WithLimits(WebServerOptions server, const ConsoleOptions& options) {
  // A browser keeps up to six connections, of which one is the WebSocket.
  constexpr int kConnectionsPerViewer = 7;
  server.max_connections =
      static_cast<std::size_t>(kConnectionsPerViewer * options.expert().max_viewers());
  return server;
}

}  // namespace

/// In the order in which they are made: each knows those before it.
struct Console::Parts {
  Parts(const GroundOptions& ground_options, const Clock& its_clock, Door its_door,
        ConsoleServices services)
      : options(ground_options),
        clock(its_clock),
        door(std::move(its_door)),
        feed(options, clock, inbox),
        session{.clock = clock,
                .hub = hub,
                .inbox = inbox,
                .limits = {.bytes_per_s = options.console().expert().viewer_mbit_s() * 1e6 / 8.0},
                .welcome = MakeWelcome(options),
                .post = [this](std::function<void()> work) { server->Post(std::move(work)); }},
        routes(session, options.console(), Access(clock, door.tokens, door.is_secure)),
        presenter(options, clock, inbox, Counted(std::move(services)),
                  [this](LiveMessagePtr message) {
                    server->Post([this, message = std::move(message)] { hub.Publish(message); });
                  }) {}

  /// The console knows about itself best.
  ConsoleServices Counted(ConsoleServices services);
  void StartThreads();
  void Present(const std::stop_token& stop);

  const GroundOptions options;
  const Clock& clock;
  const Door door;
  ConsoleInbox inbox;
  ConsoleFeed feed;
  LiveHub hub;
  LiveSession::Context session;
  ConsoleRoutes routes;
  std::unique_ptr<WebServer> server;
  Presenter presenter;
  std::unique_ptr<Worker> io_thread, present_thread;
};

ConsoleServices Console::Parts::Counted(ConsoleServices services) {
  services.describe = [this, describe = std::move(services.describe)](live::State& state) {
    if (describe) describe(state);
    const WebServerCounters& counters = server->counters();
    live::State::Console& shown = *state.mutable_console();
    shown.set_sent_bytes(counters.sent_bytes);
    shown.set_refused(counters.refused_connections + counters.refused_requests);
    shown.set_dropped_clients(counters.dropped_sockets);
  };
  return services;
}

void Console::Parts::Present(const std::stop_token& stop) {
  LowerThreadPriority(kNiceness);
  while (!stop.stop_requested()) {
    const Nanoseconds patience = presenter.Turn();
    inbox.Wait(patience, stop);
  }
}

void Console::Parts::StartThreads() {
  io_thread = std::make_unique<Worker>("console-io",
                                       [this](const std::stop_token& stop) { server->Run(stop); });
  present_thread =
      std::make_unique<Worker>("console", [this](const std::stop_token& stop) { Present(stop); });
}

Console::Console(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}

Console::~Console() {
  parts_->present_thread.reset();
  parts_->io_thread.reset();
  // Questions that nobody answers hold connections of the server, which goes before the inbox.
  parts_->inbox.TakeEvents();
}

Result<std::unique_ptr<Console>> Console::Start(const GroundOptions& options, const Clock& clock,
                                                ConsoleServices services) {
  Result<Door> door = PrepareDoor(options);
  if (!door) return Err(door.error());
  auto parts = std::make_unique<Parts>(options, clock, std::move(*door), std::move(services));
  Result<std::unique_ptr<WebServer>> server =
      WebServer::Open(WithLimits(parts->door.server, options.console()), parts->routes.Handlers());
  if (!server) return Err(server.error());
  parts->server = std::move(*server);
  parts->presenter.Begin();
  parts->StartThreads();
  return std::unique_ptr<Console>(new Console(std::move(parts)));
}

ConsoleFeed& Console::feed() { return parts_->feed; }

void Console::EndScan(std::uint64_t scan, std::vector<ReadableMap> maps) {
  parts_->inbox.Add(ScanEnded{.scan = scan, .maps = std::move(maps)});
}

void Console::Show(ScanBegun scan, ScanEnded end) {
  parts_->inbox.Add(std::move(scan));
  parts_->inbox.Add(std::move(end));
}

void Console::OnCommandResult(const CommandResult& result) { parts_->inbox.Add(result); }

std::string Console::address() const { return parts_->door.Address(parts_->server->port()); }

std::string Console::HowToComeIn(bool is_terminal) const {
  const Door& door = parts_->door;
  const int port = parts_->server->port();
  std::string text = fmt::format("console: {}", door.Address(port));
  if (!door.fingerprint.empty()) text += fmt::format("\ncertificate: SHA-256 {}", door.fingerprint);
  if (!door.tokens) return text;
  // The journal is no place for secrets.
  if (!is_terminal) return text + fmt::format("\ncodes to come in: {}/codes.txt", door.state_dir);
  const std::string operate = door.Address(port, door.tokens->operator_token);
  return text + fmt::format("\nto operate:  {}\nto look on:  {}\n{}", operate,
                            door.Address(port, door.tokens->viewer), QrText(operate));
}

}  // namespace isotherm
