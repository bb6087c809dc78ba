#pragma once

#include <chrono>
#include <map>
#include <string>

namespace isotherm {

/// Names the calling thread for `top -H`, debuggers and ReadProcessorTimes. The kernel keeps the
/// first 15 characters.
void NameThread(const char* name);

/// Lets other threads go before the calling one; those that it creates inherit it. It cannot be
/// taken back.
void LowerThreadPriority(int niceness);

/// Returns the processor time that the calling thread has used so far, with what other threads
/// have worked for it (AddProcessorTimeOfHelpers). Differences of two are what lies between.
std::chrono::nanoseconds ThreadProcessorTime();

/// Adds what helpers, such as those of a thread pool, have worked for the calling thread.
void AddProcessorTimeOfHelpers(std::chrono::nanoseconds worked);

/// Processor time of a process in seconds, user and system together.
struct ProcessorTimes {
  double total_s = 0.0;
  /// Processor time of all living threads that bear a name together. The rest of the total was used
  /// by threads that have ended.
  std::map<std::string, double> by_thread_s;
};

/// Returns what this process has used so far; without `by_thread_s` if /proc cannot be read.
ProcessorTimes ReadProcessorTimes();

/// Returns the processor time in seconds that child processes which have ended and were waited for
/// used.
double ProcessorTimeOfChildren_s();

/// Returns what was used between two readings, with the threads that used anything. "ended" is what
/// belongs to no thread that lives at the second reading.
ProcessorTimes operator-(const ProcessorTimes& after, const ProcessorTimes& before);

/// Returns, for example, "4.1 s, 0.21 of a core: codec 0.11, record 0.05, others 0.05" over
/// `seconds` of work: threads by their fraction of a core, those below 1 % of a core together.
std::string ToText(const ProcessorTimes& used, double seconds);

}  // namespace isotherm
