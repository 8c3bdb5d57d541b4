#include "src/scene/projection.h"

#include <cstddef>
#include <type_traits>
#include <utility>
#include <variant>

namespace sheaf {
namespace {

// The number of any projection, or a null pointer.
double* NumberOf(Projection& projection) {
  return std::visit(
      []<typename T>(T& kind) -> double* {
        if constexpr (std::is_empty_v<T>) {
          return nullptr;
        } else {
          auto& [number] = kind;
          return &number;
        }
      },
      projection);
}

template <std::size_t... kIndex>
Projection ProjectionAt(std::size_t index, std::index_sequence<kIndex...>) {
  Projection projection;
  ((index == kIndex ? void(projection.emplace<kIndex>()) : void()), ...);
  return projection;
}

}  // namespace

const ProjectionKind& KindOf(const Projection& projection) {
  return kProjectionKinds[projection.index()];
}

std::vector<std::string_view> ProjectionNames() {
  std::vector<std::string_view> names;
  for (const ProjectionKind& kind : kProjectionKinds) names.push_back(kind.name);
  return names;
}

std::optional<Projection> ProjectionNamed(std::string_view name) {
  for (std::size_t i = 0; i < std::size(kProjectionKinds); ++i) {
    if (kProjectionKinds[i].name != name) continue;
    Projection projection =
        ProjectionAt(i, std::make_index_sequence<std::variant_size_v<Projection>>());
    SetParameter(projection, kProjectionKinds[i].usual);
    return projection;
  }
  return std::nullopt;
}

double ParameterOf(const Projection& projection) {
  Projection copy = projection;
  const double* number = NumberOf(copy);
  return number ? *number : 0;
}

void SetParameter(Projection& projection, double value) {
  if (double* number = NumberOf(projection)) *number = value;
}

}  // namespace sheaf
