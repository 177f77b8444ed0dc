// SPDX-License-Identifier: Apache-2.0
#include "bench/support/process_cost.h"

#include <malloc.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <fstream>
#include <string>

namespace limitsurf::bench {
namespace {

/// The value of a line of /proc/self/status, in MiB.
double statusMib(const char* key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.compare(0, std::strlen(key), key) == 0)
      return std::stod(line.substr(line.find(':') + 1)) / 1024;
  }
  return 0;
}

Cost measureHere(const Opening& open) {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";  // resets the peak
  const double before = statusMib("VmRSS");
  const double cpu_before = cpuSeconds();
  const auto start = std::chrono::steady_clock::now();
  const std::shared_ptr<void> opened = open();
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  Cost cost;
  cost.seconds = elapsed.count();
  cost.cpu_seconds = cpuSeconds() - cpu_before;
  cost.peak_mib = statusMib("VmHWM") - before;
  malloc_trim(0);
  cost.kept_mib = statusMib("VmRSS") - before;
  return cost;
}

}  // namespace

double cpuSeconds() {
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

bool measureApart(const Opening& open, Cost& cost, const std::function<void()>& prepare) {
  int ends[2];
  if (pipe(ends) != 0) return false;
  const pid_t child = fork();
  if (child < 0) return false;
  if (child == 0) {
    if (prepare) prepare();
    const Cost measured = measureHere(open);
    const bool is_written = write(ends[1], &measured, sizeof measured) == sizeof measured;
    _exit(is_written ? 0 : 1);
  }
  close(ends[1]);
  const bool is_read = read(ends[0], &cost, sizeof cost) == sizeof cost;
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  return is_read && status == 0;
}

}  // namespace limitsurf::bench
