#include "src/app/machine.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <climits>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <thread>
#include <vector>

#ifdef __linux__
#include <malloc.h>
#include <sched.h>
#endif

#include "src/core/build_info.h"

namespace sheaf {
namespace {

std::vector<int> UsableProcessors() {
  std::vector<int> processors;
#ifdef __linux__
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) == 0) {
    for (int i = 0; i < CPU_SETSIZE; ++i) {
      if (CPU_ISSET(i, &set)) processors.push_back(i);
    }
  }
#endif
  return processors;
}

// {0, 1, 2, 5} becomes "0-2,5".
std::string RangesText(const std::vector<int>& numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t last = i;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
    if (!text.empty()) text += ",";
    text +=
        last == i ? fmt::format("{}", numbers[i]) : fmt::format("{}-{}", numbers[i], numbers[last]);
    i = last + 1;
  }
  return text;
}

double Now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double OwnSeconds() {
  rusage usage;
  if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

// Of all processes on all cores: user, nice, system, interrupts, steal; not idle time.
double BusySeconds() {
  std::ifstream file("/proc/stat");
  std::string name;
  double user = 0, nice = 0, system = 0, idle = 0, wait = 0, irq = 0, soft = 0, steal = 0;
  if (!(file >> name >> user >> nice >> system >> idle >> wait >> irq >> soft >> steal)) return -1;
  return (user + nice + system + irq + soft + steal) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

}  // namespace

std::string ProcessorModel() {
  // Linux names the processor here ("model name" on x86); other systems just say less.
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown processor";
}

Machine ThisMachine() {
  return {ProcessorModel(),
          static_cast<int>(std::thread::hardware_concurrency()),
          RangesText(UsableProcessors()),
          CompilerName(),
          CompilerFlags(),
          BuildTypeName()};
}

int UsableCores() {
  const std::size_t usable = UsableProcessors().size();
  return usable > 0 ? static_cast<int>(usable)
                    : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

double LoadAverage() {
  double load = -1;
  return getloadavg(&load, 1) == 1 ? load : -1;
}

std::string Today() {
  const std::time_t now = std::time(nullptr);
  std::tm date = {};
  gmtime_r(&now, &date);
  return fmt::format("{:04}-{:02}-{:02}", date.tm_year + 1900, date.tm_mon + 1, date.tm_mday);
}

OtherProcesses::OtherProcesses() : wall_(Now()), busy_(BusySeconds()), own_(OwnSeconds()) {}

double OtherProcesses::cores() const {
  const double busy = BusySeconds(), wall = Now() - wall_;
  // The system counts in hundredths of a second: shorter spans tell nothing.
  if (busy < 0 || wall < 0.1) return 0;
  return std::max(0.0, (busy - busy_ - (OwnSeconds() - own_)) / wall);
}

long PageFaults() {
  rusage usage;
  return getrusage(RUSAGE_SELF, &usage) == 0 ? usage.ru_minflt : 0;
}

void KeepFreedMemory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, INT_MAX);
#endif
}

}  // namespace sheaf
