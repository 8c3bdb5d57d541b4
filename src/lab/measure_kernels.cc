#include "src/lab/measure_kernels.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <utility>

#include "sheaf/target.h"
#include "src/lab/kernel_cases.h"

namespace sheaf {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double kLeastSeconds = 1e-3;  // of a measurement: a clock's tick is nothing beside it

struct Engine {
  Target target;
  Kernels<float> kernels;  // unused for the baseline
};

void Call(const KernelCase& work, const Engine& engine) {
  if (engine.target.is_scalar()) {
    work.scalar();
  } else {
    work.simd(engine.kernels);
  }
}

double Seconds(const KernelCase& work, const Engine& engine, int calls) {
  const Clock::time_point start = Clock::now();
  for (int i = 0; i < calls; ++i) Call(work, engine);
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// As many calls as last long enough, which warm the caches and branches besides.
int CallsFor(const KernelCase& work, const Engine& engine) {
  int calls = 1;
  while (Seconds(work, engine, calls) < kLeastSeconds && calls < (1 << 20)) calls *= 2;
  return calls;
}

}  // namespace

std::uint64_t KernelSteps(std::size_t targets, int repetitions) {
  return MakeKernelCases().size() * targets * static_cast<std::uint64_t>(repetitions + 1);
}

Result<std::vector<KernelRow>> MeasureKernels(const std::vector<std::string>& targets,
                                              int repetitions,
                                              const std::function<Status()>& step) {
  const std::vector<KernelCase> cases = MakeKernelCases();
  std::vector<Engine> engines;
  for (const std::string& name : targets) {
    const std::optional<Target> target = Target::Named(name);
    if (!target) return Error{ErrorKind::kUsage, "unknown target " + name};
    engines.push_back({*target, StrictKernels<float>(target->is_scalar() ? 0 : target->id())});
  }
  std::vector<KernelRow> rows;
  std::vector<int> calls;  // of a measurement, by case and engine
  for (const KernelCase& work : cases) {
    KernelRow& row = rows.emplace_back(KernelRow{work.name, work.element, work.live, {}});
    for (std::size_t k = 0; k < engines.size(); ++k) {
      row.times.push_back({targets[k], static_cast<int>(engines[k].target.lanes()), {}});
      calls.push_back(CallsFor(work, engines[k]));
      if (const Status going = step(); !going) return going.error();
    }
  }
  const std::size_t all = calls.size();
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    for (std::size_t i = 0; i < all; ++i) {
      // Each repetition begins elsewhere, so that no measurement always follows the same one.
      const std::size_t at = (i + static_cast<std::size_t>(repetition) * 7) % all;
      const std::size_t row = at / engines.size(), k = at % engines.size();
      const double seconds = Seconds(cases[row], engines[k], calls[at]);
      rows[row].times[k].nanoseconds.push_back(1e9 * seconds / calls[at] / cases[row].elements);
      if (const Status going = step(); !going) return going.error();
    }
  }
  return rows;
}

}  // namespace sheaf
