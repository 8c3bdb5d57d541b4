#include "src/formats/gltf_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <utility>

#include "src/core/out_of_memory.h"
#include "src/formats/gltf_validate.h"
#include "src/formats/printable.h"
#include "src/formats/read_file.h"

namespace sheaf {
namespace {

using nlohmann::json;

// Members of objects that may be anything.
const json* Member(const json& object, const char* key) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

int IndexMember(const json& object, const char* key) {
  const json* value = Member(object, key);
  const bool fits = value != nullptr && value->is_number_integer();
  return fits ? static_cast<int>(std::clamp<std::int64_t>(value->get<std::int64_t>(), -1, 1 << 30))
              : -1;
}

std::string StringMember(const json& object, const char* key) {
  const json* value = Member(object, key);
  return value != nullptr && value->is_string() ? value->get<std::string>() : "";
}

// An array, taken out of the file.
json TakeArray(json& file, const char* key) {
  const auto found = file.find(key);
  if (found == file.end()) return json::array();
  json array = std::move(*found);
  file.erase(found);
  return array.is_array() ? array : json::array();
}

bool IsGltf1(const json& file) {
  const json* asset = Member(file, "asset");
  if (asset != nullptr && StringMember(*asset, "version").starts_with("1.")) return true;
  // It had names where 2.0 has indices, and needed no asset.
  const json* meshes = Member(file, "meshes");
  return meshes != nullptr && meshes->is_object();
}

// The library refuses indices without a view, which compressed primitives have.
void DropCompressedIndices(json& file) {
  const json* accessors = Member(file, "accessors");
  const json* meshes = Member(file, "meshes");
  if (accessors == nullptr || meshes == nullptr || !meshes->is_array()) return;
  for (json& mesh : file["meshes"]) {
    if (Member(mesh, "primitives") == nullptr || !mesh["primitives"].is_array()) continue;
    for (json& primitive : mesh["primitives"]) {
      const int index = IndexMember(primitive, "indices");
      const json* extensions = Member(primitive, "extensions");
      if (extensions == nullptr || Member(*extensions, kDraco) == nullptr ||
          !IsIndexOf(index, *accessors) || !accessors->is_array()) {
        continue;
      }
      if (IndexMember((*accessors)[static_cast<std::size_t>(index)], "bufferView") < 0) {
        primitive.erase("indices");
      }
    }
  }
}

}  // namespace

std::string FirstLine(const std::string& text) {
  return Printable(std::string_view(text).substr(0, text.find('\n')));
}

bool GltfDocument::Fail(std::string place, std::string_view what) {
  if (!fault_) fault_ = {std::move(place), std::string(what)};
  return false;
}

Error GltfDocument::Failure() const {
  return SceneError(name_, fault_->place.empty()
                               ? fault_->what
                               : fmt::format("{}: {}", fault_->place, fault_->what));
}

std::string GltfDocument::PlaceIn(const std::string& pointer) const {
  return pointer.empty() ? PlaceOf(name_) : fmt::format("{}: {}", PlaceOf(name_), pointer);
}

void GltfDocument::Warn(const std::string& place, std::string_view kind, std::string_view detail) {
  files_.Warn(PlaceIn(place), kind, detail);
}

void GltfDocument::LeaveOut(const std::string& place, std::string_view kind,
                            std::string_view detail) {
  if (!left_out_) {
    left_out_ = SceneError(
        name_, fmt::format("{}: {}{}{}", place, kind, detail.empty() ? "" : ": ", detail));
  }
  Warn(place, kind, detail);
}

// Buffers and images are kept from the library: it reads URIs otherwise than RFC 3986, and refuses
// a model for an image.
bool GltfDocument::Parse(std::string_view bytes) {
  const Result<GltfSource> source = SplitGltf(bytes);
  if (!source) return Fail("", source.error().message);
  if (!CheckNesting(source.value().json, *this)) return false;
  json file = json::parse(source.value().json, nullptr, true, true);
  if (!file.is_object()) return Fail("", "no JSON object");
  if (IsGltf1(file)) return Fail("", kGltf1);
  for (const json& image : TakeArray(file, "images")) {
    images_.push_back({StringMember(image, "uri"), IndexMember(image, "bufferView")});
  }
  const json buffers = TakeArray(file, "buffers");
  DropCompressedIndices(file);
  buffer_bytes_ = bytes.size();
  return LoadModel(file.dump(-1, ' ', false, json::error_handler_t::replace)) &&
         CheckExtensions(*this) && LoadBuffers(buffers, source.value().binary);
}

bool GltfDocument::LoadModel(const std::string& json) {
  if (json.size() > 0xffffffffu) return Fail("", "JSON of more than 4 GiB");
  tinygltf::TinyGLTF loader;
  std::string error, warning;
  const auto size = static_cast<unsigned>(json.size());
  if (loader.LoadASCIIFromString(&model_, &error, &warning, json.data(), size, "")) return true;
  ThrowIfOutOfMemory(error);
  return Fail("", error.empty() ? "no glTF 2.0" : FirstLine(error));
}

bool GltfDocument::LoadBuffers(const json& buffers, std::optional<std::string_view> binary) {
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    const std::string uri = StringMember(buffers[i], "uri");
    tinygltf::Buffer buffer;
    if (!uri.empty()) {
      const Result<std::string> bytes = BytesOf(uri);
      if (!bytes) return Fail(fmt::format("/buffers/{}", i), bytes.error().message);
      buffer.data.assign(bytes.value().begin(), bytes.value().end());
    } else if (i == 0 && binary) {
      buffer.data.assign(binary->begin(), binary->end());
    }  // Others stand for what is compressed: views of them fail when they are asked for.
    buffer_bytes_ += buffer.data.size();
    model_.buffers.push_back(std::move(buffer));
  }
  return true;
}

Result<std::string> GltfDocument::BytesOf(const std::string& uri) {
  const auto failed = [](std::string what) { return Error{ErrorKind::kScene, std::move(what)}; };
  if (IsDataUri(uri)) {
    std::optional<std::string> bytes = DecodeDataUri(uri);
    if (!bytes) return failed(ShowUri(uri) + " is not valid");
    return std::move(*bytes);
  }
  const std::string reference = DecodeUriPath(uri);
  const Result<std::string> path = files_.Resolve(name_, reference);
  if (!path) return failed(fmt::format("{}: {}", Printable(reference), path.error().message));
  return files_.Read(path.value(), kMaxModelBytes);
}

Result<std::string> GltfDocument::ImageBytes(std::size_t index) {
  const auto failed = [](std::string what) { return Error{ErrorKind::kScene, std::move(what)}; };
  const GltfImage& image = images_[index];
  if (!image.uri.empty()) return BytesOf(image.uri);
  if (!IsIndexOf(image.view, model_.bufferViews)) {
    return failed(fmt::format("bufferView {} of {}", image.view, model_.bufferViews.size()));
  }
  const tinygltf::BufferView& view = model_.bufferViews[static_cast<std::size_t>(image.view)];
  if (!IsIndexOf(view.buffer, model_.buffers)) {
    return failed(fmt::format("buffer {} of {}", view.buffer, model_.buffers.size()));
  }
  const auto& data = model_.buffers[static_cast<std::size_t>(view.buffer)].data;
  if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset) {
    return failed(fmt::format("bufferView {} reaches beyond its buffer", image.view));
  }
  return std::string(reinterpret_cast<const char*>(data.data()) + view.byteOffset, view.byteLength);
}

}  // namespace sheaf
