// The processor and the build that a measurement is of, and who else used it meanwhile.
#ifndef SHEAF_APP_MACHINE_H_
#define SHEAF_APP_MACHINE_H_

#include <string>

namespace sheaf {

// As the system names it.
std::string ProcessorModel();

// What makes times comparable: all of it must be the same.
struct Machine {
  std::string processor;
  int cores = 0;         // online
  std::string affinity;  // those that this process may use, like "0-3,6"
  std::string compiler, flags, build_type;
  bool operator==(const Machine&) const = default;
};
Machine ThisMachine();

// How many cores this process may use.
int UsableCores();

// Processes that ran or waited in the last minute, on average; negative where unknown.
double LoadAverage();

// Today's date in UTC, like "2026-02-28".
std::string Today();

// How many cores other processes kept busy since construction; 0 where the system does not tell.
class OtherProcesses {
 public:
  OtherProcesses();
  double cores() const;

 private:
  double wall_, busy_, own_;  // seconds at the start
};

// Memory pages that this process has touched for the first time so far.
long PageFaults();

// Freed memory stays with the process from here on: what a frame uses is there for the next one.
void KeepFreedMemory();

}  // namespace sheaf

#endif  // SHEAF_APP_MACHINE_H_
