#include "src/render/compile_gloss.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <mutex>
#include <span>

#include "simd/query.h"
#include "src/scalar/spawn.h"

namespace sheaf {
namespace {

// Points a cosine: no light is lost or won by more than a thousandth, or by more than three where
// slopes vary in width, whose tables are long (tests/microfacet_test.cc).
constexpr std::uint32_t kPoints = 8192, kPointsOfRows = 2048;
constexpr double kAnyWidth = -1;
constexpr std::size_t kMostKept = 4096;  // tables

// The share of light that leaves facets in one step, when it arrives at this cosine.
double ShareThatLeaves(const MaterialData<double>& material, double cosine, std::uint32_t source,
                       std::uint32_t points) {
  scalar::Surface<double> surface{};
  surface.normal = surface.face = {0, 0, 1};
  surface.direction = {-std::sqrt(1 - cosine * cosine), 0, -cosine};
  surface.source = source;
  const double all[3] = {1, 1, 1};
  double sum = 0;
  for (std::uint32_t i = 0; i < points; ++i) {
    const auto point = scalar::DrawSample<double>(0, i, kGlossDimension);
    surface.facet = scalar::DrawFacet(material.slope_width, surface, point);
    const scalar::Spawned<double> spawned = scalar::Spawn(material, surface, all);
    sum += spawned.reflected.throughput[0] + spawned.refracted.throughput[0];
  }
  return sum / points;
}

// Cosines are those of GlossAt. A ray along the surface is one just above it.
double CosineOf(int step) {
  const double root = std::max(step, 1) / static_cast<double>(kGlossSteps);
  return std::min(root * root, 1.0);
}

using Table = std::vector<double>;
using Key = std::tuple<double, double, bool>;  // as of GlossTables

// `row`: both sides of a table, for a material that sends all on.
void FillRow(const MaterialData<double>& white, std::uint32_t points, std::span<double> row) {
  for (int i = 0; i < kGlossEntries; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const double cosine = CosineOf(i);
    row[at] = 1 / ShareThatLeaves(white, cosine, 0, points);
    // A mirror is alike from both sides.
    row[kGlossEntries + at] = AnyPositive(white.transmit)
                                  ? 1 / ShareThatLeaves(white, cosine, kInsideBit, points)
                                  : row[at];
  }
}

Table MakeTable(const Key& key) {
  const auto [width, ior, transmits] = key;
  MaterialData<double> white{};
  white.ior = ior;
  (transmits ? white.transmit : white.reflect)[0] = 1;
  constexpr std::size_t kRow = 2 * kGlossEntries;
  Table table(width == kAnyWidth ? kGlossRows * kRow : kRow);
  if (width != kAnyWidth) {
    white.slope_width = width;
    FillRow(white, kPoints, table);
    return table;
  }
  white.finish.has_facets = true;
  for (std::size_t i = 0; i < kGlossRows; ++i) {
    MaterialData<double> of_row = white;
    const double root = std::min(static_cast<double>(i) / kGlossRowSteps, 1.0);
    of_row.slope_width = root * root;
    FillRow(of_row, kPointsOfRows, std::span(table).subspan(i * kRow, kRow));
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
  const Key key(material.finish.has_facets ? kAnyWidth : static_cast<double>(material.slope_width),
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
