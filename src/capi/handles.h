// What stands behind <sheaf/capi.h>: its handles, and how a C++ call becomes a C call.
#ifndef SHEAF_CAPI_HANDLES_H_
#define SHEAF_CAPI_HANDLES_H_

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <deque>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "sheaf/capi.h"
#include "sheaf/error.h"
#include "sheaf/film.h"
#include "sheaf/formats.h"
#include "sheaf/geometry.h"
#include "sheaf/instances.h"
#include "sheaf/render.h"
#include "sheaf/target.h"

// NOLINTBEGIN: the names of <sheaf/capi.h>
struct sheaf_geometry_input {
  sheaf::GeometryInput input;
  // Copies of arrays whose elements lay apart. A deque moves none of them.
  std::deque<std::vector<float>> floats = {};
  std::deque<std::vector<double>> doubles = {};
  std::deque<std::vector<std::uint32_t>> indices = {};
};
struct sheaf_geometry {
  explicit sheaf_geometry(sheaf::Geometry built)
      : shared(std::make_shared<sheaf::Geometry>(std::move(built))), geometry(*shared) {}
  const std::shared_ptr<sheaf::Geometry> shared;  // with the instances that it stands in
  sheaf::Geometry& geometry;
};
struct sheaf_geometry_d {
  explicit sheaf_geometry_d(sheaf::GeometryD built)
      : shared(std::make_shared<sheaf::GeometryD>(std::move(built))), geometry(*shared) {}
  const std::shared_ptr<sheaf::GeometryD> shared;
  sheaf::GeometryD& geometry;
};
struct sheaf_instances {
  sheaf::Instances instances;
};
struct sheaf_scene {
  explicit sheaf_scene(sheaf::ReadSceneResult result)
      : read(std::move(result)), renderer(read.scene) {}
  const sheaf::ReadSceneResult read;
  const sheaf::Renderer renderer;
};
struct sheaf_progress {
  sheaf::RenderProgress progress;
};
struct sheaf_film {
  sheaf::Film film;
};
// NOLINTEND

namespace sheaf::capi {

// Keeps the message for this thread. Returns the status.
sheaf_status Fail(sheaf_status status, const char* message) noexcept;
sheaf_status Fail(const Error& error);

// Runs a call that may throw.
template <typename Call>
sheaf_status Guarded(Call&& call) noexcept {
  try {
    const Status status = call();
    return status ? SHEAF_OK : Fail(status.error());
  } catch (const std::bad_alloc&) {
    return Fail(SHEAF_OUT_OF_MEMORY, "not enough memory");
  } catch (const std::exception& error) {
    return Fail(SHEAF_INTERNAL, error.what());
  } catch (...) {
    return Fail(SHEAF_INTERNAL, "an exception of unknown kind");
  }
}

// The same for a call that makes a handle: a Result of what the handle holds.
template <typename Handle, typename Call>
sheaf_status Make(Handle** handle, const char* name, Call&& call) noexcept {
  if (handle == nullptr) return Fail(SHEAF_USAGE, name);
  *handle = nullptr;
  return Guarded([&]() -> Status {
    auto made = call();
    if (!made) return made.error();
    *handle = new Handle{std::move(made).value()};
    return Done{};
  });
}

inline Error UsageError(std::string message) { return {ErrorKind::kUsage, std::move(message)}; }

inline Status NotNull(const void* given, const char* name) {
  return given == nullptr ? Status(UsageError(std::string(name) + " is NULL")) : Status(Done{});
}

// What stands in an enumeration of C, where a caller may write any number. C++ may not read one
// that it does not name.
template <typename Enumeration>
std::size_t NumberIn(const Enumeration& given) {
  unsigned number = 0;
  static_assert(sizeof(number) == sizeof(given));
  std::memcpy(&number, &given, sizeof(number));
  return number;
}

// What a caller's structure says, in the structure of today: members that the caller does not know
// keep the defaults that `own` has; members that the library does not know have to be 0.
template <typename Struct>
Status Take(const Struct* given, const char* name, Struct* own) {
  if (given == nullptr) return UsageError(std::string(name) + " is NULL");
  const std::size_t size = given->size;
  if (size < sizeof(std::size_t)) {
    return UsageError(std::string(name) + ": its size is not set, as its INIT does");
  }
  std::memcpy(own, given, std::min(size, sizeof(Struct)));
  own->size = sizeof(Struct);
  const auto* const bytes = reinterpret_cast<const unsigned char*>(given);
  for (std::size_t i = sizeof(Struct); i < size; ++i) {
    if (bytes[i] != 0) {
      return UsageError(std::string(name) + ": it sets what Sheaf " + kVersion + " does not know");
    }
  }
  return Done{};
}

// Likewise where NULL stands for the defaults.
template <typename Struct>
Status TakeIfGiven(const Struct* given, const char* name, Struct* own) {
  return given == nullptr ? Status(Done{}) : Take(given, name, own);
}

// Writes what the caller's structure has room for, and 0 to what the library does not know.
template <typename Struct>
Status Put(const Struct& own, const char* name, Struct* given) {
  if (given == nullptr) return UsageError(std::string(name) + " is NULL");
  const std::size_t size = given->size;
  if (size < sizeof(std::size_t)) {
    return UsageError(std::string(name) + ": its size is not set, as its INIT does");
  }
  std::memcpy(given, &own, std::min(size, sizeof(Struct)));
  given->size = size;
  if (size > sizeof(Struct)) {
    std::memset(reinterpret_cast<unsigned char*>(given) + sizeof(Struct), 0, size - sizeof(Struct));
  }
  return Done{};
}

// The box around what a C++ object holds, in a structure of statistics.
template <typename From, typename Statistics>
void StoreBox(const From& from, Statistics* statistics) {
  const auto lower = from.lower(), upper = from.upper();
  std::copy(lower.begin(), lower.end(), statistics->lower);
  std::copy(upper.begin(), upper.end(), statistics->upper);
}

// The target of this name; NULL: the best.
Result<Target> TargetOf(const char* name);

// The layers of a sum of sheaf_layer.
Result<Layers> LayersOf(std::uint32_t bits);

}  // namespace sheaf::capi

#endif  // SHEAF_CAPI_HANDLES_H_
