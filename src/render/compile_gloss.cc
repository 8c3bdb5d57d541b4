#include "src/render/compile_gloss.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <mutex>

#include "simd/query.h"
#include "src/scalar/spawn.h"

namespace sheaf {
namespace {

// Points a cosine: no light is lost or won by more than a thousandth (tests/microfacet_test.cc).
constexpr std::uint32_t kPoints = 8192;
constexpr std::size_t kMostKept = 4096;  // tables

// The share of light that leaves facets in one step, when it arrives at this cosine.
double ShareThatLeaves(const MaterialData<double>& material, double cosine, std::uint32_t source) {
  scalar::Surface<double> surface{};
  surface.normal = surface.face = {0, 0, 1};
  surface.direction = {-std::sqrt(1 - cosine * cosine), 0, -cosine};
  surface.source = source;
  const double all[3] = {1, 1, 1};
  double sum = 0;
  for (std::uint32_t i = 0; i < kPoints; ++i) {
    const auto point = scalar::DrawSample<double>(0, i, kGlossDimension);
    surface.facet = scalar::DrawFacet(material.slope_width, surface, point);
    const scalar::Spawned<double> spawned = scalar::Spawn(material, surface, all);
    sum += spawned.reflected.throughput[0] + spawned.refracted.throughput[0];
  }
  return sum / kPoints;
}

// Cosines are those of GlossAt. A ray along the surface is one just above it.
double CosineOf(int step) {
  const double root = std::max(step, 1) / static_cast<double>(kGlossSteps);
  return std::min(root * root, 1.0);
}

using Table = std::vector<double>;
using Key = std::tuple<double, double, bool>;  // slope width, index, whether it transmits

Table MakeTable(const Key& key) {
  const auto [width, ior, transmits] = key;
  MaterialData<double> white{};
  white.slope_width = width;
  white.ior = ior;
  (transmits ? white.transmit : white.reflect)[0] = 1;
  Table table;
  const auto add_side = [&](std::uint32_t source) {
    for (int i = 0; i < kGlossEntries; ++i) {
      table.push_back(1 / ShareThatLeaves(white, CosineOf(i), source));
    }
  };
  add_side(0);
  if (transmits) {
    add_side(kInsideBit);
  } else {  // a mirror is alike from both sides
    table.insert(table.end(), table.begin(), table.begin() + kGlossEntries);
  }
  return table;
}

// Kept from frame to frame: a table takes as long as a small picture.
std::shared_ptr<const Table> TableFor(const Key& key) {
  static std::mutex mutex;
  static std::map<Key, std::shared_ptr<const Table>> tables;
  const std::lock_guard lock(mutex);
  if (tables.size() > kMostKept) tables.clear();
  std::shared_ptr<const Table>& table = tables[key];
  if (!table) table = std::make_shared<const Table>(MakeTable(key));
  return table;
}

}  // namespace

template <typename Real>
const Real* GlossTables<Real>::TableOf(const MaterialData<Real>& material) {
  const bool transmits = AnyPositive(material.transmit);
  const Key key(static_cast<double>(material.slope_width),
                transmits ? static_cast<double>(material.ior) : 1.0, transmits);
  auto& table = tables_[key];
  if (table) return table->data();
  const std::shared_ptr<const Table> exact = TableFor(key);
  table = std::make_unique<std::vector<Real>>();
  for (const double entry : *exact) table->push_back(static_cast<Real>(entry));
  return table->data();
}

template class GlossTables<float>;
template class GlossTables<double>;

}  // namespace sheaf
