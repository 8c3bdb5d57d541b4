// Random numbers: kernels against src/scalar, and how evenly points fill the square.
#include "src/scalar/draw_sample.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

#include "bits.h"
#include "random_scene.h"
#include "simd/kernels.h"
#include "src/stream/stream.h"
#include "targets.h"

namespace sheaf {
namespace {

TEST_CASE_TEMPLATE("points have the bits of the specification on every target", Real, float,
                   double) {
  ForEachTarget([](Target target) {
    const Kernels<Real> kernels = StrictKernels<Real>(target.id());
    Random random(3);
    for (const std::uint32_t count : {1u, 7u, 8u, 16u, 17u, 200u}) {
      AlignedArray<std::uint32_t> seeds;
      seeds.Allocate(StreamCapacity(count));
      for (std::uint32_t i = 0; i < count; ++i) seeds[i] = static_cast<std::uint32_t>(random());
      SampleStream<Real> points;
      points.Allocate(count);
      const auto index = static_cast<std::uint32_t>(random() % 100000);
      const auto dimension = static_cast<std::uint32_t>(random() % 40);
      kernels.draw_samples(seeds.data(), index, dimension, count, points.output());
      for (std::uint32_t i = 0; i < count; ++i) {
        const auto want = scalar::DrawSample<Real>(seeds[i], index, dimension);
        REQUIRE(SameBits(want.u, points.view().u[i]));
        REQUIRE(SameBits(want.v, points.view().v[i]));
        REQUIRE(want.u >= 0);
        REQUIRE(want.u < 1);
        REQUIRE(want.v < 1);
      }
    }
  });
}

// Sobol's sequence in base 2 is a (0, 2)-sequence: any aligned 2^k points have one in each of the
// 2^k boxes of every shape, whatever the scrambling.
TEST_CASE("powers of two of a pixel's samples fill every elementary interval once") {
  Random random(4);
  for (int round = 0; round < 20; ++round) {
    const auto seed = static_cast<std::uint32_t>(random());
    for (const int k : {4, 8}) {
      const std::uint32_t count = 1u << k, first = count * static_cast<std::uint32_t>(round);
      for (int wide = 0; wide <= k; ++wide) {
        std::set<std::uint32_t> boxes;
        for (std::uint32_t i = 0; i < count; ++i) {
          const auto point = scalar::DrawSample<double>(seed, first + i, 5);
          const auto x = static_cast<std::uint32_t>(point.u * (1u << wide));
          const auto y = static_cast<std::uint32_t>(point.v * (1u << (k - wide)));
          boxes.insert(x << 16 | y);
        }
        REQUIRE(boxes.size() == count);
      }
    }
  }
}

// The mean square of the error of a smooth integral over the square falls about as n^-3 with
// scrambled nets, as n^-1 with independent points.
TEST_CASE("means converge faster than those of independent points") {
  const auto variance = [](std::uint32_t count) {
    double sum = 0;
    for (std::uint32_t seed = 0; seed < 400; ++seed) {
      double mean = 0;
      for (std::uint32_t i = 0; i < count; ++i) {
        const auto p = scalar::DrawSample<double>(scalar::Hash(seed), i, 1);
        mean += p.u * p.v + p.u * p.u;
      }
      mean = mean / count - (0.25 + 1.0 / 3);
      sum += mean * mean;
    }
    return sum / 400;
  };
  const double slope = std::log2(variance(256) / variance(16)) / 4;
  CHECK(slope < -2.4);
}

// Different uses, pixels and kinds of rays have nothing to do with one another.
TEST_CASE("numbers of different seeds and dimensions are not correlated") {
  const auto correlation = [](auto a, auto b) {
    double sum = 0;
    for (std::uint32_t i = 0; i < 4096; ++i) sum += (a(i) - 0.5) * (b(i) - 0.5);
    return std::abs(sum / 4096 * 12);
  };
  const auto of = [](std::uint32_t x, std::uint32_t dimension) {
    return [=](std::uint32_t i) {
      return scalar::DrawSample<double>(scalar::PixelSeed(x + i % 64, i / 64), 0, dimension).u;
    };
  };
  CHECK(correlation(of(0, 1), of(0, 2)) < 0.06);
  CHECK(correlation(of(0, 1), of(1, 1)) < 0.06);
  const auto child = [](ChildKind kind) {
    return [=](std::uint32_t i) {
      const std::uint32_t seed = scalar::ChildSeed(scalar::PixelSeed(i % 64, i / 64), kind);
      return scalar::DrawSample<double>(seed, 0, 1).u;
    };
  };
  CHECK(correlation(of(0, 1), child(ChildKind::kReflected)) < 0.06);
  CHECK(correlation(child(ChildKind::kRefracted), child(ChildKind::kReflected)) < 0.06);
}

}  // namespace
}  // namespace sheaf
