#include "src/lab/calibrate.h"

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "src/core/parallel.h"

namespace sheaf {
namespace {

constexpr std::size_t kNumbers = 4096;  // 16 KiB: within the first cache
constexpr std::uint64_t kItemsAThread = 32;
constexpr int kSweepsAnItem = 24;

// Arithmetic like a tracer's, on few numbers: products, sums, a root, a choice.
float Sweep(std::array<float, kNumbers>& numbers) {
  for (std::size_t i = 0; i < kNumbers; ++i) {
    const float x = numbers[i], y = numbers[(i + 1) % kNumbers];
    const float root = std::sqrt(x * x + y + 0.25f);
    numbers[i] = root > 1.5f ? root - 0.75f : root;
  }
  return numbers[0];
}

}  // namespace

double CalibrationSeconds(int threads) {
  std::atomic<float> kept{0};  // so that the work is not left out
  const auto start = std::chrono::steady_clock::now();
  const std::uint64_t items = kItemsAThread * static_cast<std::uint64_t>(threads);
  ParallelFor(threads, items, [&](int, std::uint64_t item) {
    std::array<float, kNumbers> numbers;
    for (std::size_t i = 0; i < kNumbers; ++i) {
      numbers[i] = static_cast<float>((i * 37 + item) % 101) / 101.0f;
    }
    float sum = 0;
    for (int sweep = 0; sweep < kSweepsAnItem; ++sweep) sum += Sweep(numbers);
    kept.store(sum, std::memory_order_relaxed);
  });
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace sheaf
