#include "edge/camera_process/system_call_filter.h"

#include <fmt/format.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/netlink.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace isotherm {
namespace {

#if defined(__x86_64__)
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_AARCH64;
#else
constexpr std::uint32_t kArchitecture = 0;
#endif

#if defined(__x86_64__)
// Numbers of a second, rarely used interface to the same calls.
constexpr std::uint32_t kX32 = 0x4000'0000;
#endif

constexpr std::uint32_t kAllow = SECCOMP_RET_ALLOW;
constexpr std::uint32_t kRefuse = SECCOMP_RET_ERRNO | EPERM;
constexpr std::uint32_t kRefuseSocket = SECCOMP_RET_ERRNO | EACCES;

constexpr int kRefused[] = {
    // Other programs.
    SYS_execve, SYS_execveat, SYS_ptrace, SYS_process_vm_readv, SYS_process_vm_writev, SYS_kcmp,
    SYS_pidfd_getfd, SYS_pidfd_send_signal, SYS_tkill, SYS_rt_sigqueueinfo, SYS_rt_tgsigqueueinfo,
    // Ways around a filter.
    SYS_io_uring_setup, SYS_io_uring_enter, SYS_io_uring_register, SYS_bpf, SYS_userfaultfd,
    SYS_perf_event_open, SYS_unshare, SYS_setns,
    // The system.
    SYS_mount, SYS_umount2, SYS_pivot_root, SYS_chroot, SYS_move_mount, SYS_open_tree, SYS_fsopen,
    SYS_fsconfig, SYS_fsmount, SYS_fspick, SYS_init_module, SYS_finit_module, SYS_delete_module,
    SYS_kexec_load, SYS_reboot, SYS_swapon, SYS_swapoff, SYS_add_key, SYS_request_key, SYS_keyctl,
    SYS_settimeofday, SYS_clock_settime, SYS_adjtimex, SYS_clock_adjtime};

/// A program of the kernel's packet filter over the number and arguments of a system call.
class FilterProgram {
 public:
  void Load(std::size_t offset) {
    Add(BPF_LD | BPF_W | BPF_ABS, 0, 0, static_cast<std::uint32_t>(offset));
  }
  void LoadNumber() { Load(offsetof(seccomp_data, nr)); }
  /// The lower half, which is all of an int (both architectures are little-endian).
  void LoadArgument(std::size_t index) {
    Load(offsetof(seccomp_data, args) + index * sizeof(std::uint64_t));
  }
  void Return(std::uint32_t verdict) { Add(BPF_RET | BPF_K, 0, 0, verdict); }
  void ReturnIf(std::uint32_t value, std::uint32_t verdict) {
    SkipUnless(value, 1);
    Return(verdict);
  }
  /// The next `instructions` are for what equals `value`.
  void SkipUnless(std::uint32_t value, std::uint8_t instructions) {
    Add(BPF_JMP | BPF_JEQ | BPF_K, 0, instructions, value);
  }
  void ReturnUnless(std::uint32_t value, std::uint32_t verdict) {
    Add(BPF_JMP | BPF_JEQ | BPF_K, 1, 0, value);
    Return(verdict);
  }
  /// If it is `value` or more.
  void ReturnFrom(std::uint32_t value, std::uint32_t verdict) {
    Add(BPF_JMP | BPF_JGE | BPF_K, 0, 1, value);
    Return(verdict);
  }
  sock_fprog program() {
    return {static_cast<unsigned short>(instructions_.size()), instructions_.data()};
  }

 private:
  void Add(int code, std::uint8_t if_true, std::uint8_t if_false, std::uint32_t operand) {
    instructions_.push_back({static_cast<std::uint16_t>(code), if_true, if_false, operand});
  }
  std::vector<sock_filter> instructions_;
};

void AddSockets(FilterProgram& filter, bool local_sockets) {
  // Load, two for local ones, four for netlink, one to refuse.
  filter.SkipUnless(SYS_socket, local_sockets ? 8 : 6);
  filter.LoadArgument(0);
  if (local_sockets) filter.ReturnIf(AF_UNIX, kAllow);
  filter.SkipUnless(AF_NETLINK, 3);
  // Messages that a device was plugged in or out; none about the network.
  filter.LoadArgument(2);
  filter.ReturnIf(NETLINK_KOBJECT_UEVENT, kAllow);
  filter.Return(kRefuseSocket);
}

/// Only to this process itself: so it ends when it aborts.
void AddSignals(FilterProgram& filter) {
  for (const int number : {SYS_kill, SYS_tgkill}) {
    filter.SkipUnless(static_cast<std::uint32_t>(number), 4);
    filter.LoadArgument(0);
    filter.ReturnIf(static_cast<std::uint32_t>(::getpid()), kAllow);
    filter.Return(kRefuse);
  }
}

}  // namespace

Status FilterSystemCalls(bool local_sockets) {
  if (kArchitecture == 0) return FailedPrecondition("no filter for this kind of processor");
  FilterProgram filter;
  filter.Load(offsetof(seccomp_data, arch));
  filter.ReturnUnless(kArchitecture, kRefuse);
  filter.LoadNumber();
#if defined(__x86_64__)
  filter.ReturnFrom(kX32, kRefuse);
#endif
  for (const int number : kRefused) filter.ReturnIf(static_cast<std::uint32_t>(number), kRefuse);
  AddSignals(filter);
  AddSockets(filter, local_sockets);
  filter.Return(kAllow);
  const sock_fprog program = filter.program();
  // The older of two ways: services' filters of system calls allow it.
  if (::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program, 0, 0) == 0) return OkStatus();
  return FailedPrecondition(fmt::format("no filter of system calls: {}", std::strerror(errno)));
}

}  // namespace isotherm
