// What `sheaf bench` measured, as a table and as JSON.
#ifndef SHEAF_APP_BENCH_REPORT_H_
#define SHEAF_APP_BENCH_REPORT_H_

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "sheaf/error.h"
#include "sheaf/render.h"
#include "src/app/machine.h"

namespace sheaf {

inline constexpr int kPhases = static_cast<int>(Phase::kCount);

// One target on one number of threads.
struct BenchRow {
  std::string target;
  int threads = 1;
  std::size_t lanes = 1;
  std::uint64_t rays = 0;
  std::vector<double> seconds;          // by repetition, not empty once measured
  std::vector<double> calibration;      // the same: CalibrationSeconds around it; may be empty
  std::vector<double> phases[kPhases];  // by repetition; summed over threads
  long page_faults = 0;                 // of all repetitions
  std::string verdict;                  // against the baseline; empty without one
};

struct BenchReport {
  std::string scene, camera;
  int width = 0, height = 0, samples = 0;
  std::vector<BenchRow> rows;
  Machine machine;         // empty where a file does not tell
  double other_cores = 0;  // that other processes kept busy meanwhile
};

// Adds what the machine is, and its load.
void AddMachine(const Machine& machine, nlohmann::ordered_json* json);

// Null where there is none.
const BenchRow* FindRow(const BenchReport& report, const std::string& target, int threads);

// What a row took in each repetition, in times of the scalar baseline next to it.
std::vector<double> InScalars(const BenchRow& row, const BenchRow& scalar);

// The tables for a person: rays a second, then milliseconds by phase.
std::string BenchText(const BenchReport& report);

// What --json writes, and the same read again. `path` is for messages; phases, lanes and verdicts
// are not read.
std::string BenchJson(const BenchReport& report);
Result<BenchReport> ParseBenchJson(const std::string& path, const std::string& text);

}  // namespace sheaf

#endif  // SHEAF_APP_BENCH_REPORT_H_
