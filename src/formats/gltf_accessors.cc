#include "src/formats/gltf_accessors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace sheaf {
namespace {

std::size_t ComponentBytes(int type) {
  const int size = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(type));
  return size > 0 ? static_cast<std::size_t>(size) : 0;
}

double Component(int type, bool normalized, const unsigned char* bytes) {
  const auto as = [bytes](auto value) {
    std::memcpy(&value, bytes, sizeof(value));
    return static_cast<double>(value);
  };
  const auto scaled = [normalized](double value, double most) {
    return normalized ? std::max(value / most, -1.0) : value;
  };
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return scaled(as(std::int8_t{}), 127);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return scaled(as(std::uint8_t{}), 255);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return scaled(as(std::int16_t{}), 32767);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return scaled(as(std::uint16_t{}), 65535);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return as(std::uint32_t{});
    default:
      return as(float{});
  }
}

// Equal pieces of a buffer view.
struct Pieces {
  const unsigned char* data = nullptr;
  std::size_t stride = 0;

  const unsigned char* at(std::size_t i) const { return data + i * stride; }
};

// `count` elements of `size` bytes each, from `offset` on; nothing, with a fault, where the view
// ends before them.
std::optional<Pieces> FindPieces(GltfDocument& document, const std::string& place, int view_index,
                                 std::size_t offset, std::size_t count, std::size_t size) {
  const tinygltf::Model& model = document.model();
  if (!IsIndexOf(view_index, model.bufferViews)) {
    document.Fail(place, fmt::format("bufferView {} of {}", view_index, model.bufferViews.size()));
    return std::nullopt;
  }
  const tinygltf::BufferView& view = model.bufferViews[static_cast<std::size_t>(view_index)];
  if (!IsIndexOf(view.buffer, model.buffers)) {
    document.Fail(fmt::format("/bufferViews/{}", view_index),
                  fmt::format("buffer {} of {}", view.buffer, model.buffers.size()));
    return std::nullopt;
  }
  const auto& data = model.buffers[static_cast<std::size_t>(view.buffer)].data;
  const std::size_t stride = view.byteStride > 0 ? view.byteStride : size;
  const bool view_fits =
      view.byteOffset <= data.size() && view.byteLength <= data.size() - view.byteOffset;
  const bool fits =
      view_fits && stride >= size &&
      (count == 0 || (count <= view.byteLength / stride + 1 && offset <= view.byteLength &&
                      (count - 1) * stride + size <= view.byteLength - offset));
  if (!fits) {
    document.Fail(place, fmt::format("{} elements of {} bytes reach beyond bufferView {}", count,
                                     size, view_index));
    return std::nullopt;
  }
  return Pieces{data.data() + view.byteOffset + offset, stride};
}

// One accessor, and where its elements go.
class AccessorReader {
 public:
  AccessorReader(GltfDocument& document, const tinygltf::Accessor& accessor, std::string place,
                 std::size_t components)
      : document_(document),
        accessor_(accessor),
        place_(std::move(place)),
        component_bytes_(ComponentBytes(accessor.componentType)),
        numbers_{components, std::vector<double>(accessor.count * components)} {}

  std::optional<GltfNumbers> Read() {
    if (accessor_.bufferView >= 0 && !ReadDense()) return std::nullopt;
    if (accessor_.sparse.isSparse && !ReadSparse()) return std::nullopt;
    return std::move(numbers_);
  }

 private:
  std::size_t element_bytes() const { return numbers_.components * component_bytes_; }

  void ReadElement(const unsigned char* from, std::size_t element) {
    for (std::size_t c = 0; c < numbers_.components; ++c) {
      numbers_.values[element * numbers_.components + c] =
          Component(accessor_.componentType, accessor_.normalized, from + c * component_bytes_);
    }
  }

  bool ReadDense() {
    const auto pieces = FindPieces(document_, place_, accessor_.bufferView, accessor_.byteOffset,
                                   accessor_.count, element_bytes());
    if (!pieces) return false;
    for (std::size_t i = 0; i < accessor_.count; ++i) ReadElement(pieces->at(i), i);
    return true;
  }

  bool ReadSparse() {
    const auto& sparse = accessor_.sparse;
    if (sparse.count < 0 || static_cast<std::size_t>(sparse.count) > accessor_.count) {
      return document_.Fail(place_,
                            fmt::format("{} sparse elements of {}", sparse.count, accessor_.count));
    }
    const auto count = static_cast<std::size_t>(sparse.count);
    const std::size_t index_bytes = ComponentBytes(sparse.indices.componentType);
    if (index_bytes == 0 || sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0) {
      return document_.Fail(place_, "its sparse part is malformed");
    }
    const auto indices =
        FindPieces(document_, place_, sparse.indices.bufferView,
                   static_cast<std::size_t>(sparse.indices.byteOffset), count, index_bytes);
    const auto values =
        FindPieces(document_, place_, sparse.values.bufferView,
                   static_cast<std::size_t>(sparse.values.byteOffset), count, element_bytes());
    if (!indices || !values) return false;
    for (std::size_t i = 0; i < count; ++i) {
      const double element = Component(sparse.indices.componentType, false, indices->at(i));
      if (!(element >= 0 && element < static_cast<double>(accessor_.count))) {
        return document_.Fail(place_,
                              fmt::format("sparse element {} of {}", element, accessor_.count));
      }
      ReadElement(values->at(i), static_cast<std::size_t>(element));
    }
    return true;
  }

  GltfDocument& document_;
  const tinygltf::Accessor& accessor_;
  std::string place_;
  std::size_t component_bytes_;
  GltfNumbers numbers_;
};

}  // namespace

std::optional<GltfNumbers> ReadAccessor(GltfDocument& document, int index, int low, int high) {
  const std::string place = fmt::format("/accessors/{}", index);
  const auto& accessors = document.model().accessors;
  if (!IsIndexOf(index, accessors)) {
    document.Fail(place, fmt::format("there are {} accessors", accessors.size()));
    return std::nullopt;
  }
  const tinygltf::Accessor& accessor = accessors[static_cast<std::size_t>(index)];
  const int given = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
  if (given < low || given > high || ComponentBytes(accessor.componentType) == 0 ||
      accessor.componentType == TINYGLTF_COMPONENT_TYPE_DOUBLE) {
    document.Fail(place, "its type does not fit its use");
    return std::nullopt;
  }
  if (accessor.count > document.buffer_bytes()) {
    document.Fail(place, fmt::format("{} elements in a file of {} bytes", accessor.count,
                                     document.buffer_bytes()));
    return std::nullopt;
  }
  return AccessorReader(document, accessor, place, static_cast<std::size_t>(given)).Read();
}

}  // namespace sheaf
