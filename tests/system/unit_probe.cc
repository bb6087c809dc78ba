// Prints what the sandbox of a unit lets its service do, one word per line; run in the service's
// place.

#include <linux/landlock.h>
#include <sched.h>
#include <sys/syscall.h>
#include <sys/timex.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <fstream>

int main() {
  timex clock{};
  if (adjtimex(&clock) != -1) std::puts("reads-clock");
  clock.modes = ADJ_FREQUENCY;
  if (adjtimex(&clock) != -1) std::puts("sets-clock");
  if (std::ifstream("/etc/shadow").good()) std::puts("reads-passwords");
  // A node as udev makes them for thermal cameras: for the group only.
  if (std::ifstream("/srv/camera").good()) std::puts("cameras");
  if (std::ofstream("/usr/isotherm-probe").good()) std::puts("writes-system");
  const landlock_ruleset_attr rules{LANDLOCK_ACCESS_FS_EXECUTE};
  // Kernels without it say something else.
  if (syscall(SYS_landlock_create_ruleset, &rules, sizeof(rules), 0) >= 0 || errno != EPERM)
    std::puts("landlock");
  if (unshare(CLONE_NEWUSER | CLONE_NEWNET) == 0) std::puts("own-network");
  if (unshare(CLONE_NEWPID) == 0) std::puts("own-processes");
  return 0;
}
