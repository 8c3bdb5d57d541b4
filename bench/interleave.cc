#include "bench/interleave.h"

#include <chrono>

namespace sheaf::bench {

double SecondsOf(const std::function<void()>& f) {
  const auto start = std::chrono::steady_clock::now();
  f();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::vector<std::vector<double>> Interleave(const std::vector<Contestant>& contestants,
                                            int repetitions) {
  const std::size_t n = contestants.size();
  std::vector<std::vector<double>> seconds(n);
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t turn = (i + repetition) % n;
      contestants[turn].prepare();
      seconds[turn].push_back(SecondsOf(contestants[turn].run));
    }
  }
  return seconds;
}

double MedianRatio(const std::vector<double>& a, const std::vector<double>& b) {
  // Each contestant's runs are in the order of the repetitions, whoever began them.
  std::vector<double> ratios;
  for (std::size_t i = 0; i < a.size(); ++i) ratios.push_back(a[i] / b[i]);
  return Median(ratios);
}

}  // namespace sheaf::bench
