#include "ground/link_emulator/emulated_host.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <linux/if_tun.h>
#include <net/if.h>
#include <sched.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

namespace isotherm {
namespace {

/// Names what a keeper does, in this order; the first that fails is told.
enum class Step : int { kNamespaces, kUserMap, kTunnel, kAddress, kDone };

/// Holds what a keeper says once, together with the tunnel's file.
struct KeeperReport {
  Step failed = Step::kDone;
  int error = 0;  ///< errno.
};

std::string Explain(const KeeperReport& report) {
  const std::string why = std::strerror(report.error);
  switch (report.failed) {
    case Step::kNamespaces:
      return "this kernel gives no network namespace (" + why +
             "): run as root, or allow user namespaces";
    case Step::kUserMap:
      return "this kernel gives no user namespace (" + why + "): run as root";
    case Step::kTunnel:
      return "/dev/net/tun: " + why + ": run as root, or load the kernel's module tun";
    case Step::kAddress:
      return "the emulated interface cannot be configured: " + why;
    case Step::kDone:
      break;
  }
  return "the process that keeps an emulated network has ended";
}

/// Holds what is prepared before the fork: behind it nothing may allocate.
struct KeeperPlan {
  bool is_root = false;
  std::string user_map, group_map;
  sockaddr_in address{};
};

int WriteFile(const char* path, const std::string& text) {
  const int file = ::open(path, O_WRONLY | O_CLOEXEC);
  if (file < 0) return errno;
  const bool written = ::write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  const int error = written ? 0 : errno;
  ::close(file);
  return error;
}

/// In a user namespace of its own a process is root, and has its networks.
int MapUser(const KeeperPlan& plan) {
  if (plan.is_root) return 0;
  if (const int error = WriteFile("/proc/self/setgroups", "deny")) return error;
  if (const int error = WriteFile("/proc/self/uid_map", plan.user_map)) return error;
  return WriteFile("/proc/self/gid_map", plan.group_map);
}

ifreq Named(const char* interface) {
  ifreq request{};
  std::strncpy(request.ifr_name, interface, sizeof(request.ifr_name) - 1);
  return request;
}

int BringUp(int socket, const char* interface) {
  ifreq request = Named(interface);
  if (::ioctl(socket, SIOCGIFFLAGS, &request) != 0) return errno;
  request.ifr_flags = static_cast<short>(request.ifr_flags | IFF_UP | IFF_RUNNING);
  return ::ioctl(socket, SIOCSIFFLAGS, &request) != 0 ? errno : 0;
}

int Configure(const KeeperPlan& plan) {
  // A frame is hundreds of packets at once; the default of 500 would lose some of them.
  constexpr int kQueuePackets = 10000;
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (socket < 0) return errno;
  ifreq address = Named(EmulatedHost::kInterface);
  std::memcpy(&address.ifr_addr, &plan.address, sizeof(plan.address));
  ifreq mask = Named(EmulatedHost::kInterface);
  sockaddr_in bits{};
  bits.sin_family = AF_INET;
  bits.sin_addr.s_addr = htonl(0xFFFFFF00U);
  std::memcpy(&mask.ifr_netmask, &bits, sizeof(bits));
  ifreq queue = Named(EmulatedHost::kInterface);
  queue.ifr_qlen = kQueuePackets;
  int error = 0;
  if (::ioctl(socket, SIOCSIFADDR, &address) != 0 || ::ioctl(socket, SIOCSIFNETMASK, &mask) != 0 ||
      ::ioctl(socket, SIOCSIFTXQLEN, &queue) != 0) {
    error = errno;
  }
  // Without the local one the middleware cannot wake its own threads.
  if (error == 0) error = BringUp(socket, "lo");
  if (error == 0) error = BringUp(socket, EmulatedHost::kInterface);
  ::close(socket);
  return error;
}

KeeperReport MakeHost(const KeeperPlan& plan, int* tunnel) {
  const int namespaces = plan.is_root ? CLONE_NEWNET : CLONE_NEWUSER | CLONE_NEWNET;
  if (::unshare(namespaces) != 0) return {Step::kNamespaces, errno};
  if (const int error = MapUser(plan)) return {Step::kUserMap, error};
  *tunnel = ::open("/dev/net/tun", O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (*tunnel < 0) return {Step::kTunnel, errno};
  ifreq request = Named(EmulatedHost::kInterface);
  request.ifr_flags = IFF_TUN | IFF_NO_PI;
  if (::ioctl(*tunnel, TUNSETIFF, &request) != 0) return {Step::kTunnel, errno};
  if (const int error = Configure(plan)) return {Step::kAddress, error};
  return {};
}

/// Holds the room for one file in a message between processes.
union FileMessage {
  cmsghdr header;
  std::array<char, CMSG_SPACE(sizeof(int))> bytes;
};

/// Sends the report and, if there is one, the file.
void Send(int socket, KeeperReport report, int file) {
  iovec content{&report, sizeof(report)};
  FileMessage control{};
  msghdr message{};
  message.msg_iov = &content;
  message.msg_iovlen = 1;
  if (file >= 0) {
    message.msg_control = control.bytes.data();
    message.msg_controllen = control.bytes.size();
    cmsghdr* const header = CMSG_FIRSTHDR(&message);
    header->cmsg_level = SOL_SOCKET;
    header->cmsg_type = SCM_RIGHTS;
    header->cmsg_len = CMSG_LEN(sizeof(int));
    std::memcpy(CMSG_DATA(header), &file, sizeof(file));
  }
  static_cast<void>(!::sendmsg(socket, &message, 0));
}

/// Returns what the keeper sent; -1 in place of the file if there is none.
std::pair<KeeperReport, int> Receive(int socket) {
  KeeperReport report;
  iovec content{&report, sizeof(report)};
  FileMessage control{};
  msghdr message{};
  message.msg_iov = &content;
  message.msg_iovlen = 1;
  message.msg_control = control.bytes.data();
  message.msg_controllen = control.bytes.size();
  ssize_t received = -1;
  do {
    received = ::recvmsg(socket, &message, MSG_CMSG_CLOEXEC);
  } while (received < 0 && errno == EINTR);
  if (received != static_cast<ssize_t>(sizeof(report))) return {{}, -1};
  const cmsghdr* const header = CMSG_FIRSTHDR(&message);
  int file = -1;
  if (header != nullptr && header->cmsg_type == SCM_RIGHTS)
    std::memcpy(&file, CMSG_DATA(header), sizeof(file));
  return {report, file};
}

/// In the child: nothing here may allocate or lock.
[[noreturn]] void Keep(const KeeperPlan& plan, pid_t parent, int socket) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);  // Gone before that.
  // Ctrl-C is for those who run here; it ends with its parent.
  ::signal(SIGINT, SIG_IGN);
  // Files of the parent stay open as long as anybody has them: sockets of other keepers, pipes of a
  // test.
  constexpr int kSocket = 0;
  if (::dup2(socket, kSocket) != kSocket || ::close_range(kSocket + 1, ~0U, 0) != 0) ::_exit(1);
  int tunnel = -1;
  const KeeperReport report = MakeHost(plan, &tunnel);
  Send(kSocket, report, report.error == 0 ? tunnel : -1);
  char nothing = 0;
  // Until the other end is closed.
  while (::read(kSocket, &nothing, 1) < 0 && errno == EINTR) {
  }
  ::_exit(0);
}

}  // namespace

Result<EmulatedHost> EmulatedHost::Create(const std::string& address) {
  KeeperPlan plan;
  plan.is_root = ::geteuid() == 0;
  plan.user_map = fmt::format("0 {} 1", ::geteuid());
  plan.group_map = fmt::format("0 {} 1", ::getegid());
  plan.address.sin_family = AF_INET;
  if (::inet_pton(AF_INET, address.c_str(), &plan.address.sin_addr) != 1)
    return Err(InvalidArgument("'" + address + "' is no IPv4 address"));
  std::array<int, 2> sockets{};
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, sockets.data()) != 0)
    return Err(Unavailable(fmt::format("no pair of sockets: {}", std::strerror(errno))));
  FileDescriptor control(sockets[0]), of_keeper(sockets[1]);
  const pid_t parent = ::getpid();
  const pid_t keeper = ::fork();
  if (keeper == 0) {
    ::close(control.get());
    Keep(plan, parent, of_keeper.get());
  }
  if (keeper < 0) return Err(Unavailable(fmt::format("fork: {}", std::strerror(errno))));
  of_keeper.Close();
  const auto [report, tunnel] = Receive(control.get());
  // From here on it is ended by the destructor, whatever it said.
  EmulatedHost host(keeper, std::move(control), FileDescriptor(tunnel));
  if (tunnel < 0) return Err(Unavailable(Explain(report)));
  return host;
}

EmulatedHost::EmulatedHost(EmulatedHost&& other) noexcept
    : keeper_(std::exchange(other.keeper_, -1)),
      control_(std::move(other.control_)),
      packets_(std::move(other.packets_)) {}

EmulatedHost::~EmulatedHost() {
  if (keeper_ < 0) return;
  control_.Close();
  ::waitpid(keeper_, nullptr, 0);
}

std::vector<std::string> EmulatedHost::CommandPrefix() const {
  std::vector<std::string> words{"/usr/bin/nsenter", "--net=" + network_namespace().string()};
  if (::geteuid() != 0) {
    words.push_back(fmt::format("--user=/proc/{}/ns/user", keeper_));
    words.emplace_back("--preserve-credentials");
  }
  words.emplace_back("--");
  return words;
}

std::filesystem::path EmulatedHost::network_namespace() const {
  return fmt::format("/proc/{}/ns/net", keeper_);
}

}  // namespace isotherm
