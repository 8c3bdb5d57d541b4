#include "src/formats/gltf.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <optional>
#include <set>
#include <utility>

#include "simd/tree.h"
#include "src/formats/image.h"
#include "src/formats/printable.h"
#include "src/formats/read_file.h"
#include "src/formats/read_scene.h"
#include "src/scene/transform.h"

namespace sheaf {
namespace {

constexpr int kMaxNodeDepth = 1024;

const std::set<std::string_view> kKnownExtensions = {
    "KHR_lights_punctual", "KHR_materials_ior", "KHR_materials_transmission",
    "KHR_mesh_quantization", "KHR_materials_emissive_strength"};

// A failed read somewhere below, with its place.
struct Fault {
  std::string place, what;
};

// The first line of what a library says.
std::string FirstLine(const std::string& text) {
  const std::string_view line = std::string_view(text).substr(0, text.find('\n'));
  return Printable(line);
}

// The JSON of a .gltf, or that of a .glb: its first chunk, or nothing where there is none.
std::string_view JsonOf(std::string_view bytes) {
  if (!bytes.starts_with("glTF")) return bytes;
  constexpr std::size_t kHeader = 20;  // of the file and of the chunk
  return bytes.size() > kHeader ? bytes.substr(kHeader) : std::string_view();
}

// tinygltf follows values down the stack: what nests deeper than this is refused before.
constexpr int kMaxNesting = 256;

bool NestsTooDeep(std::string_view json) {
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < json.size() && depth <= kMaxNesting; ++i) {
    const char c = json[i];
    if (in_string) {
      if (c == '\\') ++i;
      in_string = c != '"';
    } else if (c == '"') {
      in_string = true;
    } else if (c == '[' || c == '{') {
      ++depth;
    } else if (c == ']' || c == '}') {
      if (--depth == 0) return false;  // the end of the JSON; binary chunks may follow
    }
  }
  return depth > kMaxNesting;
}

class GltfReader {
 public:
  GltfReader(const std::string& name, SceneFiles& files) : name_(name), files_(files) {}

  Result<Scene> Read(std::string_view bytes) {
    try {
      if (!Parse(bytes) || !CheckExtensions() || !ReadMaterials() || !ReadNodes()) return Failure();
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& error) {  // of tinygltf and its JSON library
      return SceneError(name_, FirstLine(error.what()));
    }
    return std::move(scene_);
  }

 private:
  bool Fail(std::string place, std::string_view what) {
    if (!fault_) fault_ = {std::move(place), std::string(what)};
    return false;
  }
  Error Failure() const {
    return SceneError(name_, fault_->place.empty()
                                 ? fault_->what
                                 : fmt::format("{}: {}", fault_->place, fault_->what));
  }

  // ---- Parsing ----

  bool Parse(std::string_view bytes) {
    if (bytes.size() > 0xffffffffu) return Fail("", "larger than 4 GiB");
    if (NestsTooDeep(JsonOf(bytes))) {
      return Fail("", fmt::format("values nest deeper than {}", kMaxNesting));
    }
    tinygltf::TinyGLTF loader;
    loader.SetFsCallbacks({&FileExists, &KeepPath, &ReadFile, nullptr, this});
    loader.SetImageLoader(&KeepImage, this);
    std::string error, warning;
    const auto size = static_cast<unsigned>(bytes.size());
    const std::string folder = Folder();
    const bool is_binary = bytes.starts_with("glTF");
    const bool is_parsed =
        is_binary
            ? loader.LoadBinaryFromMemory(&model_, &error, &warning,
                                          reinterpret_cast<const unsigned char*>(bytes.data()),
                                          size, folder)
            : loader.LoadASCIIFromString(&model_, &error, &warning, bytes.data(), size, folder);
    if (refused_) return Fail("", *refused_);
    if (!is_parsed) return Fail("", error.empty() ? "no glTF 2.0" : FirstLine(error));
    buffer_bytes_ = bytes.size();
    for (const tinygltf::Buffer& buffer : model_.buffers) buffer_bytes_ += buffer.data.size();
    return true;
  }

  std::string Folder() const {
    const std::size_t slash = name_.rfind('/');
    return slash == std::string::npos ? "." : name_.substr(0, slash + 1);
  }

  // The library looks for files beside the scene and then in the working directory: only the first
  // is meant.
  std::optional<std::string> Allowed(const std::string& path) {
    const std::string folder = Folder();
    if (!path.starts_with(folder)) return std::nullopt;
    std::string reference = path.substr(folder.size());
    while (!reference.empty() && reference.front() == '/') reference.erase(0, 1);
    const Result<std::string> resolved = files_.Resolve(name_, reference);
    if (resolved) return resolved.value();
    refused_ = fmt::format("{}: {}", Printable(reference), resolved.error().message);
    return std::nullopt;
  }

  static bool FileExists(const std::string& path, void* self) {
    const auto allowed = static_cast<GltfReader*>(self)->Allowed(path);
    std::error_code ignored;
    return allowed && std::filesystem::is_regular_file(*allowed, ignored);
  }
  static std::string KeepPath(const std::string& path, void*) { return path; }
  static bool ReadFile(std::vector<unsigned char>* out, std::string* error, const std::string& path,
                       void* self) {
    const auto allowed = static_cast<GltfReader*>(self)->Allowed(path);
    if (!allowed) return false;
    const Result<std::string> bytes = ReadWholeFile(*allowed);
    if (!bytes) {
      *error += bytes.error().message;
      return false;
    }
    out->assign(bytes.value().begin(), bytes.value().end());
    return true;
  }
  // Images are decoded when a material asks for them.
  static bool KeepImage(tinygltf::Image*, const int index, std::string*, std::string*, int, int,
                        const unsigned char* bytes, int size, void* self) {
    auto& encoded = static_cast<GltfReader*>(self)->encoded_images_;
    const auto i = static_cast<std::size_t>(index);
    if (i >= encoded.size()) encoded.resize(i + 1);
    encoded[i].assign(reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(size));
    return true;
  }

  bool CheckExtensions() {
    for (const std::string& extension : model_.extensionsRequired) {
      if (!kKnownExtensions.contains(extension)) {
        return Fail("/extensionsRequired",
                    fmt::format("the extension \"{}\" is not known", Printable(extension)));
      }
    }
    for (const std::string& extension : model_.extensionsUsed) {
      if (kKnownExtensions.contains(extension)) continue;
      files_.Warn(fmt::format("{}: the extension \"{}\" is not known, and is passed over",
                              PrintablePath(name_), Printable(extension)));
    }
    return true;
  }

  // ---- Materials ----

  bool ReadMaterials() {
    for (std::size_t i = 0; i < model_.materials.size(); ++i) {
      if (!ReadMaterial(i)) return false;
    }
    return true;
  }

  static double Factor(const tinygltf::Material& material, const char* extension, const char* key,
                       double otherwise) {
    const auto found = material.extensions.find(extension);
    if (found == material.extensions.end() || !found->second.Has(key)) return otherwise;
    const tinygltf::Value& value = found->second.Get(key);
    return value.IsNumber() ? value.GetNumberAsDouble() : otherwise;
  }

  // docs/formats.md, "glTF": from metallic and roughness to what a Whitted tracer has.
  bool ReadMaterial(std::size_t index) {
    const tinygltf::Material& from = model_.materials[index];
    const std::string place = fmt::format("/materials/{}", index);
    const auto& pbr = from.pbrMetallicRoughness;
    const double metallic = std::clamp(pbr.metallicFactor, 0.0, 1.0);
    const double roughness = std::clamp(pbr.roughnessFactor, 0.0, 1.0);
    const double transmission =
        std::clamp(Factor(from, "KHR_materials_transmission", "transmissionFactor", 0), 0.0, 1.0);
    const double glow = Factor(from, "KHR_materials_emissive_strength", "emissiveStrength", 1);
    Colour base(1.0), emission(0.0);
    for (int c = 0; c < 3; ++c) {
      const auto k = static_cast<std::size_t>(c);
      if (k < pbr.baseColorFactor.size()) base[c] = std::max(pbr.baseColorFactor[k], 0.0);
      if (k < from.emissiveFactor.size())
        emission[c] = std::max(from.emissiveFactor[k] * glow, 0.0);
    }
    Material material;
    material.name = from.name;
    material.base_colour = base;
    material.emission = emission;
    material.ambient = kModelAmbient * (1 - transmission);
    const double matt = 1 - metallic * (1 - roughness);
    material.kd = matt * (1 - transmission);
    const double sharpness = (1 - roughness) * (1 - roughness);
    material.ks = (0.2 + 0.6 * metallic) * (1 - roughness);
    // Blinn and Phong's exponent for the roughness of a microfacet surface (Walter et al. 2007).
    const double alpha = std::max(roughness * roughness, 0.01);
    material.shininess = std::max(2 / (alpha * alpha) - 2, 1.0);
    if (metallic * sharpness > 0.02) {
      material.reflect = glm::min(base, Colour(1.0)) * (metallic * sharpness);
    }
    material.transmit = Colour(transmission * (1 - metallic));
    material.ior = std::clamp(Factor(from, "KHR_materials_ior", "ior", 1.5), 1.0, 1e6);
    for (const double number : {material.kd, material.ks, base.x, base.y, base.z, emission.x,
                                emission.y, emission.z, material.ior}) {
      if (!(number <= 1e6)) return Fail(place, "a number is not finite, or above 1e6");
    }
    if (pbr.baseColorTexture.index >= 0) {
      Texture texture;
      texture.factor = base;
      if (!ReadTexture(pbr.baseColorTexture.index, place, &texture)) return false;
      material.base_colour = texture;
    }
    if (from.alphaMode == "MASK" || from.alphaMode == "BLEND") {
      files_.Warn(fmt::format("{}: {}: alpha is not read: the material is opaque",
                              PrintablePath(name_), place));
    }
    scene_.materials.push_back(std::move(material));
    return true;
  }

  bool ReadTexture(int index, const std::string& place, Texture* out) {
    if (static_cast<std::size_t>(index) >= model_.textures.size()) {
      return Fail(place, fmt::format("texture {} of {}", index, model_.textures.size()));
    }
    const tinygltf::Texture& texture = model_.textures[static_cast<std::size_t>(index)];
    if (texture.source < 0 || static_cast<std::size_t>(texture.source) >= model_.images.size()) {
      return Fail(fmt::format("/textures/{}", index),
                  fmt::format("image {} of {}", texture.source, model_.images.size()));
    }
    if (!LoadImage(static_cast<std::size_t>(texture.source), &out->image)) return false;
    if (texture.sampler < 0) return true;
    if (static_cast<std::size_t>(texture.sampler) >= model_.samplers.size()) {
      return Fail(fmt::format("/textures/{}", index),
                  fmt::format("sampler {} of {}", texture.sampler, model_.samplers.size()));
    }
    const auto& sampler = model_.samplers[static_cast<std::size_t>(texture.sampler)];
    const auto wrap = [](int mode) {
      return mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE     ? Wrap::kClamp
             : mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::kMirror
                                                             : Wrap::kRepeat;
    };
    out->wrap_u = wrap(sampler.wrapS);
    out->wrap_v = wrap(sampler.wrapT);
    if (sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST) out->filter = Filter::kNearest;
    return true;
  }

  bool LoadImage(std::size_t index, std::shared_ptr<const Image>* out) {
    const std::string place = fmt::format("/images/{}", index);
    images_.resize(model_.images.size());
    std::shared_ptr<const Image>& image = images_[index];
    if (!image) {
      if (index >= encoded_images_.size() || encoded_images_[index].empty()) {
        return Fail(place, fmt::format("cannot read {}", Printable(model_.images[index].uri)));
      }
      Result<Image> decoded = DecodeImage(encoded_images_[index]);
      if (!decoded) return Fail(place, decoded.error().message);
      const std::string& uri = model_.images[index].uri;
      decoded.value().name = uri.starts_with("data:") ? "" : uri;
      image = std::make_shared<const Image>(std::move(decoded).value());
      encoded_images_[index].clear();
    }
    *out = image;
    return true;
  }

  // ---- Accessors ----

  static std::size_t ComponentBytes(int type) {
    const int size = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(type));
    return size > 0 ? static_cast<std::size_t>(size) : 0;
  }

  // `count` elements of `size` bytes, `stride` apart, within a buffer view; null with a fault
  // otherwise.
  const unsigned char* Bytes(const std::string& place, int view_index, std::size_t offset,
                             std::size_t count, std::size_t size, std::size_t* stride) {
    if (view_index < 0 || static_cast<std::size_t>(view_index) >= model_.bufferViews.size()) {
      Fail(place, fmt::format("bufferView {} of {}", view_index, model_.bufferViews.size()));
      return nullptr;
    }
    const tinygltf::BufferView& view = model_.bufferViews[static_cast<std::size_t>(view_index)];
    if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= model_.buffers.size()) {
      Fail(fmt::format("/bufferViews/{}", view_index),
           fmt::format("buffer {} of {}", view.buffer, model_.buffers.size()));
      return nullptr;
    }
    const auto& data = model_.buffers[static_cast<std::size_t>(view.buffer)].data;
    *stride = view.byteStride > 0 ? view.byteStride : size;
    const bool view_fits =
        view.byteOffset <= data.size() && view.byteLength <= data.size() - view.byteOffset;
    const bool fits =
        view_fits && *stride >= size &&
        (count == 0 || (count <= view.byteLength / *stride + 1 && offset <= view.byteLength &&
                        (count - 1) * *stride + size <= view.byteLength - offset));
    if (!fits) {
      Fail(place, fmt::format("{} elements of {} bytes reach beyond bufferView {}", count, size,
                              view_index));
      return nullptr;
    }
    return data.data() + view.byteOffset + offset;
  }

  static double Component(int type, bool normalized, const unsigned char* bytes) {
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

  // All numbers of an accessor whose elements have `low` to `high` components; *components says
  // how many. Nothing with a fault otherwise.
  std::optional<std::vector<double>> ReadAccessor(int index, int low, int high,
                                                  std::size_t* components) {
    const std::string place = fmt::format("/accessors/{}", index);
    if (index < 0 || static_cast<std::size_t>(index) >= model_.accessors.size()) {
      Fail(place, fmt::format("there are {} accessors", model_.accessors.size()));
      return std::nullopt;
    }
    const tinygltf::Accessor& accessor = model_.accessors[static_cast<std::size_t>(index)];
    const int given = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
    const std::size_t bytes = ComponentBytes(accessor.componentType);
    if (given < low || given > high || bytes == 0 ||
        accessor.componentType == TINYGLTF_COMPONENT_TYPE_DOUBLE) {
      Fail(place, "its type does not fit its use");
      return std::nullopt;
    }
    const auto size = static_cast<std::size_t>(given);
    *components = size;
    if (accessor.count > buffer_bytes_) {
      Fail(place, fmt::format("{} elements in a file of {} bytes", accessor.count, buffer_bytes_));
      return std::nullopt;
    }
    std::vector<double> values(accessor.count * size);
    const auto read_element = [&](const unsigned char* from, std::size_t element) {
      for (std::size_t c = 0; c < size; ++c) {
        values[element * size + c] =
            Component(accessor.componentType, accessor.normalized, from + c * bytes);
      }
    };
    std::size_t stride = 0;
    if (accessor.bufferView >= 0) {
      const unsigned char* data = Bytes(place, accessor.bufferView, accessor.byteOffset,
                                        accessor.count, size * bytes, &stride);
      if (data == nullptr) return std::nullopt;
      for (std::size_t i = 0; i < accessor.count; ++i) read_element(data + i * stride, i);
    }
    if (accessor.sparse.isSparse && !ReadSparse(accessor, place, size * bytes, read_element)) {
      return std::nullopt;
    }
    return values;
  }

  template <typename ReadElement>
  bool ReadSparse(const tinygltf::Accessor& accessor, const std::string& place, std::size_t size,
                  const ReadElement& read_element) {
    const auto& sparse = accessor.sparse;
    if (sparse.count < 0 || static_cast<std::size_t>(sparse.count) > accessor.count) {
      return Fail(place, fmt::format("{} sparse elements of {}", sparse.count, accessor.count));
    }
    const auto count = static_cast<std::size_t>(sparse.count);
    const std::size_t index_bytes = ComponentBytes(sparse.indices.componentType);
    if (index_bytes == 0 || sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0) {
      return Fail(place, "its sparse part is malformed");
    }
    std::size_t index_stride = 0, value_stride = 0;
    const unsigned char* indices =
        Bytes(place, sparse.indices.bufferView, static_cast<std::size_t>(sparse.indices.byteOffset),
              count, index_bytes, &index_stride);
    const unsigned char* values =
        Bytes(place, sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset),
              count, size, &value_stride);
    if (indices == nullptr || values == nullptr) return false;
    for (std::size_t i = 0; i < count; ++i) {
      const double element =
          Component(sparse.indices.componentType, false, indices + i * index_stride);
      if (!(element >= 0 && element < static_cast<double>(accessor.count))) {
        return Fail(place, fmt::format("sparse element {} of {}", element, accessor.count));
      }
      read_element(values + i * value_stride, static_cast<std::size_t>(element));
    }
    return true;
  }

  // Fills `out` with as many elements as there are positions, from an attribute that may be absent.
  template <typename Vector>
  bool ReadAttribute(const tinygltf::Primitive& primitive, const std::string& place,
                     const std::string& attribute, int low, int high, std::size_t count,
                     std::vector<Vector>* out) {
    const auto found = primitive.attributes.find(attribute);
    if (found == primitive.attributes.end()) return true;
    std::size_t components = 0;
    const auto values = ReadAccessor(found->second, low, high, &components);
    if (!values) return false;
    const std::size_t given = values->size() / components;
    if (count != 0 && given != count) {
      return Fail(place, fmt::format("{} has {} elements, POSITION {}", attribute, given, count));
    }
    out->resize(given);
    for (std::size_t i = 0; i < given; ++i) {
      for (int c = 0; c < Vector::length(); ++c) {
        const double value = (*values)[i * components + static_cast<std::size_t>(c)];
        if (!(std::abs(value) <= kMaxCoordinate)) {
          return Fail(place,
                      fmt::format("{} {}: a number is not finite, or beyond 1e30", attribute, i));
        }
        (*out)[i][c] = static_cast<float>(value);
      }
    }
    return true;
  }

  // ---- Meshes ----

  bool ReadIndices(const tinygltf::Primitive& primitive, const std::string& place,
                   std::size_t vertices, std::vector<std::uint32_t>* out) {
    if (primitive.indices < 0) {
      for (std::uint32_t i = 0; i < vertices; ++i) out->push_back(i);
      return true;
    }
    std::size_t components = 0;
    const auto values = ReadAccessor(primitive.indices, 1, 1, &components);
    if (!values) return false;
    for (const double value : *values) {
      if (!(value >= 0 && value < static_cast<double>(vertices)) || value != std::floor(value)) {
        return Fail(place, fmt::format("vertex {} of {}", value, vertices));
      }
      out->push_back(static_cast<std::uint32_t>(value));
    }
    return true;
  }

  std::string TextureCoordinates(const tinygltf::Primitive& primitive) const {
    int set = 0;
    if (primitive.material >= 0) {
      const auto& material = model_.materials[static_cast<std::size_t>(primitive.material)];
      set = material.pbrMetallicRoughness.baseColorTexture.texCoord;
    }
    return fmt::format("TEXCOORD_{}", set);
  }

  bool ReadPrimitive(const tinygltf::Primitive& primitive, const std::string& place, Mesh* mesh) {
    if (primitive.material >= 0 &&
        static_cast<std::size_t>(primitive.material) >= model_.materials.size()) {
      return Fail(place,
                  fmt::format("material {} of {}", primitive.material, model_.materials.size()));
    }
    if (!ReadAttribute(primitive, place, "POSITION", 3, 3, 0, &mesh->positions)) return false;
    const std::size_t count = mesh->positions.size();
    if (count == 0) return Fail(place, "no POSITION");
    if (!ReadAttribute(primitive, place, "NORMAL", 3, 3, count, &mesh->normals) ||
        !ReadAttribute(primitive, place, TextureCoordinates(primitive), 2, 2, count, &mesh->uv) ||
        !ReadAttribute(primitive, place, "COLOR_0", 3, 4, count, &mesh->colours)) {
      return false;
    }
    for (glm::vec3& colour : mesh->colours) colour = glm::max(colour, glm::vec3(0));
    std::vector<std::uint32_t> corners;
    if (!ReadIndices(primitive, place, count, &corners)) return false;
    const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
    if (mode == TINYGLTF_MODE_TRIANGLES && corners.size() % 3 != 0) {
      return Fail(place, fmt::format("{} corners do not divide by 3", corners.size()));
    }
    for (std::size_t i = 0; i + 2 < corners.size(); i += mode == TINYGLTF_MODE_TRIANGLES ? 3 : 1) {
      const std::size_t odd = mode == TINYGLTF_MODE_TRIANGLE_STRIP && i % 2 ? 1 : 0;
      const std::size_t first = mode == TINYGLTF_MODE_TRIANGLE_FAN ? 0 : i;
      mesh->triangles.push_back({corners[first], corners[i + 1 + odd], corners[i + 2 - odd]});
    }
    return true;
  }

  bool AddMesh(int index, const std::string& node_name, const Transform& transform) {
    if (static_cast<std::size_t>(index) >= model_.meshes.size()) {
      return Fail("/nodes", fmt::format("mesh {} of {}", index, model_.meshes.size()));
    }
    const tinygltf::Mesh& mesh = model_.meshes[static_cast<std::size_t>(index)];
    for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
      const tinygltf::Primitive& primitive = mesh.primitives[i];
      const std::string place = fmt::format("/meshes/{}/primitives/{}", index, i);
      if (primitive.mode >= 0 && primitive.mode < TINYGLTF_MODE_TRIANGLES) {
        files_.Warn(
            fmt::format("{}: {}: points and lines are passed over", PrintablePath(name_), place));
        continue;
      }
      Mesh built;
      if (!ReadPrimitive(primitive, place, &built)) return false;
      Scene one;
      one.objects.push_back({mesh.primitives.size() == 1 ? node_name : "", std::move(built),
                             MaterialOf(primitive.material)});
      const std::string fault = TransformScene(transform, &one);
      if (!fault.empty()) return Fail(place, fault);
      triangles_ += std::get<Mesh>(one.objects[0].shape).triangles.size();
      if (triangles_ > kMaxTreePrimitives) {
        return Fail(place, fmt::format("more than {} triangles in all", kMaxTreePrimitives));
      }
      scene_.objects.push_back(std::move(one.objects[0]));
    }
    return true;
  }

  std::uint32_t MaterialOf(int index) {
    if (index >= 0) return static_cast<std::uint32_t>(index);
    if (!plain_) {
      plain_ = static_cast<std::uint32_t>(scene_.materials.size());
      scene_.materials.push_back(PlainMaterial());
    }
    return *plain_;
  }

  // ---- Nodes ----

  bool ReadNodes() {
    std::vector<int> roots;
    if (model_.scenes.empty()) {
      std::set<int> children;
      for (const auto& node : model_.nodes) {
        children.insert(node.children.begin(), node.children.end());
      }
      for (int i = 0; i < static_cast<int>(model_.nodes.size()); ++i) {
        if (!children.contains(i)) roots.push_back(i);
      }
    } else {
      const int scene = std::max(model_.defaultScene, 0);
      if (static_cast<std::size_t>(scene) >= model_.scenes.size()) {
        return Fail("/scene", fmt::format("scene {} of {}", scene, model_.scenes.size()));
      }
      roots = model_.scenes[static_cast<std::size_t>(scene)].nodes;
    }
    visited_.assign(model_.nodes.size(), false);
    for (const int root : roots) {
      if (!Visit(root, Transform{}, 0)) return false;
    }
    return true;
  }

  bool Visit(int index, const Transform& parent, int depth) {
    const std::string place = fmt::format("/nodes/{}", index);
    if (index < 0 || static_cast<std::size_t>(index) >= model_.nodes.size()) {
      return Fail(place, fmt::format("there are {} nodes", model_.nodes.size()));
    }
    const auto i = static_cast<std::size_t>(index);
    // Nodes form trees: whoever is met twice has two parents, or is its own ancestor.
    if (visited_[i]) return Fail(place, "the node is met twice: nodes must not form cycles");
    visited_[i] = true;
    if (depth > kMaxNodeDepth) return Fail(place, "nodes nest too deep");
    const tinygltf::Node& node = model_.nodes[i];
    const Transform transform = parent * LocalTransform(node);
    for (int axis = 0; axis < 3; ++axis) {
      for (int k = 0; k < 3; ++k) {
        if (!(std::abs(transform.linear[axis][k]) <= kMaxCoordinate &&
              std::abs(transform.translation[k]) <= kMaxCoordinate)) {
          return Fail(place, "its transform is not finite, or beyond 1e30");
        }
      }
    }
    if (node.mesh >= 0 && !AddMesh(node.mesh, node.name, transform)) return false;
    if (node.camera >= 0 && !AddCamera(node, place, transform)) return false;
    if (!AddLight(node, place, transform)) return false;
    for (const int child : node.children) {
      if (!Visit(child, transform, depth + 1)) return false;
    }
    return true;
  }

  static Transform LocalTransform(const tinygltf::Node& node) {
    Transform local;
    if (node.matrix.size() == 16) {
      for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) {
          local.linear[column][row] = node.matrix[static_cast<std::size_t>(4 * column + row)];
        }
      }
      local.translation = {node.matrix[12], node.matrix[13], node.matrix[14]};
      return local;
    }
    if (node.rotation.size() == 4) {
      const double x = node.rotation[0], y = node.rotation[1], z = node.rotation[2],
                   w = node.rotation[3];
      const double length = x * x + y * y + z * z + w * w;
      const double s = length > 0 ? 2 / length : 0;
      local.linear = glm::dmat3(1 - s * (y * y + z * z), s * (x * y + w * z), s * (x * z - w * y),
                                s * (x * y - w * z), 1 - s * (x * x + z * z), s * (y * z + w * x),
                                s * (x * z + w * y), s * (y * z - w * x), 1 - s * (x * x + y * y));
    }
    if (node.scale.size() == 3) {
      for (int axis = 0; axis < 3; ++axis) {
        local.linear[axis] *= node.scale[static_cast<std::size_t>(axis)];
      }
    }
    if (node.translation.size() == 3) {
      local.translation = {node.translation[0], node.translation[1], node.translation[2]};
    }
    return local;
  }

  std::string FreeName(const std::string& wanted, const char* otherwise) const {
    const std::string base = wanted.empty() ? otherwise : wanted;
    std::string name = base;
    const auto is_taken = [&] {
      return std::any_of(scene_.cameras.begin(), scene_.cameras.end(),
                         [&](const Camera& camera) { return camera.name == name; });
    };
    for (int i = 2; is_taken(); ++i) name = fmt::format("{} {}", base, i);
    return name;
  }

  bool AddCamera(const tinygltf::Node& node, const std::string& place, const Transform& transform) {
    if (static_cast<std::size_t>(node.camera) >= model_.cameras.size()) {
      return Fail(place, fmt::format("camera {} of {}", node.camera, model_.cameras.size()));
    }
    const tinygltf::Camera& from = model_.cameras[static_cast<std::size_t>(node.camera)];
    const std::string camera_place = fmt::format("/cameras/{}", node.camera);
    Camera camera;
    camera.name = FreeName(node.name.empty() ? from.name : node.name, "camera");
    camera.eye = transform.translation;
    const Vec3d ahead = transform.Vector({0, 0, -1});
    camera.up = transform.Vector({0, 1, 0});
    if (!(glm::length(glm::cross(ahead, camera.up)) > 0)) {
      return Fail(place, "the node's transform leaves its camera no direction");
    }
    camera.look_at = camera.eye + ahead;
    if (from.type == "orthographic") {
      const double height = 2 * from.orthographic.ymag;
      if (!(height > 0 && height <= kMaxCoordinate))
        return Fail(camera_place, "ymag is not above 0");
      camera.projection = Orthographic{height};
    } else {
      const double fov = from.perspective.yfov * 57.295779513082320877;
      if (!(fov > 0 && fov < 180)) return Fail(camera_place, "yfov is not between 0 and pi");
      camera.projection = Perspective{fov};
    }
    scene_.cameras.push_back(camera);
    return true;
  }

  bool AddLight(const tinygltf::Node& node, const std::string& place, const Transform& transform) {
    const auto extension = node.extensions.find("KHR_lights_punctual");
    if (extension == node.extensions.end() || !extension->second.Has("light")) return true;
    const int index = extension->second.Get("light").GetNumberAsInt();
    if (index < 0 || static_cast<std::size_t>(index) >= model_.lights.size()) {
      return Fail(place, fmt::format("light {} of {}", index, model_.lights.size()));
    }
    const tinygltf::Light& from = model_.lights[static_cast<std::size_t>(index)];
    const std::string light_place = fmt::format("/extensions/KHR_lights_punctual/lights/{}", index);
    Light light;
    light.name = node.name.empty() ? from.name : node.name;
    for (std::size_t c = 0; c < 3 && c < from.color.size(); ++c) {
      light.colour[static_cast<int>(c)] = from.color[c];
    }
    light.intensity = from.intensity;
    for (const double number : {light.intensity, light.colour.x, light.colour.y, light.colour.z}) {
      if (!(number >= 0 && number <= 1e6)) {
        return Fail(light_place, "its colour or intensity is not in [0, 1e6]");
      }
    }
    const Vec3d direction = transform.Vector({0, 0, -1});
    if (!(glm::length(direction) > 0)) return Fail(place, "the transform leaves no direction");
    if (from.type == "directional") {
      light.source = DirectionalLight{direction};
    } else if (from.type == "point" || from.type == "spot") {
      PointLight point{transform.translation, {}};
      if (from.type == "spot") {
        constexpr double kDegrees = 57.295779513082320877;
        point.cone = Cone{direction, from.spot.innerConeAngle * kDegrees,
                          from.spot.outerConeAngle * kDegrees};
        // Radians of the whole quarter turn, rounded, may come to a little more than 90 degrees.
        point.cone->outer =
            point.cone->outer < 90.0001 ? std::min(point.cone->outer, 90.0) : point.cone->outer;
        if (!(point.cone->inner >= 0 && point.cone->inner < point.cone->outer &&
              point.cone->outer <= 90)) {
          return Fail(light_place, "its cone needs 0 <= inner < outer <= pi / 2");
        }
      }
      light.source = point;
    } else {
      return Fail(light_place, fmt::format("unknown type \"{}\"", Printable(from.type, 40)));
    }
    scene_.lights.push_back(light);
    return true;
  }

  const std::string& name_;
  SceneFiles& files_;
  std::optional<Fault> fault_;
  std::optional<std::string> refused_;  // a file that the library asked for and may not have
  tinygltf::Model model_;
  std::size_t buffer_bytes_ = 0;
  std::vector<std::string> encoded_images_;
  std::vector<std::shared_ptr<const Image>> images_;
  Scene scene_;
  std::optional<std::uint32_t> plain_;
  std::uint64_t triangles_ = 0;
  std::vector<bool> visited_;
};

}  // namespace

Result<Scene> ParseGltf(std::string_view bytes, const std::string& name, SceneFiles& files) {
  Result<Scene> scene = GltfReader(name, files).Read(bytes);
  if (scene && scene.value().objects.empty()) return SceneError(name, "no mesh in its scene");
  return scene;
}

}  // namespace sheaf
