#include "src/formats/gltf_document.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "src/formats/gltf_validate.h"
#include "src/formats/printable.h"
#include "src/formats/read_file.h"

namespace sheaf {

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

void GltfDocument::Warn(const std::string& place, std::string_view what) {
  files_.Warn(place.empty() ? PlaceOf(name_) : fmt::format("{}: {}", PlaceOf(name_), place), what);
}

bool GltfDocument::Parse(std::string_view bytes) {
  if (bytes.size() > 0xffffffffu) return Fail("", "larger than 4 GiB");
  if (!CheckNesting(bytes, *this)) return false;
  tinygltf::TinyGLTF loader;
  const auto keep_path = [](const std::string& path, void*) { return path; };
  loader.SetFsCallbacks({&FileExists, keep_path, &ReadFile, nullptr, this});
  loader.SetImageLoader(&KeepImage, this);
  std::string error, warning;
  const auto size = static_cast<unsigned>(bytes.size());
  const std::string folder = Folder();
  const bool is_binary = bytes.starts_with("glTF");
  const bool is_parsed =
      is_binary ? loader.LoadBinaryFromMemory(&model_, &error, &warning,
                                              reinterpret_cast<const unsigned char*>(bytes.data()),
                                              size, folder)
                : loader.LoadASCIIFromString(&model_, &error, &warning, bytes.data(), size, folder);
  if (refused_) return Fail("", *refused_);
  if (!is_parsed) return Fail("", error.empty() ? "no glTF 2.0" : FirstLine(error));
  buffer_bytes_ = bytes.size();
  for (const tinygltf::Buffer& buffer : model_.buffers) buffer_bytes_ += buffer.data.size();
  return CheckExtensions(*this);
}

std::string GltfDocument::TakeImage(std::size_t index) {
  return index < encoded_images_.size() ? std::exchange(encoded_images_[index], {}) : "";
}

std::string GltfDocument::Folder() const {
  const std::size_t slash = name_.rfind('/');
  return slash == std::string::npos ? "." : name_.substr(0, slash + 1);
}

// The library looks for files beside the scene and then in the working directory: only the first
// is meant.
std::optional<std::string> GltfDocument::Allowed(const std::string& path) {
  const std::string folder = Folder();
  if (!path.starts_with(folder)) return std::nullopt;
  std::string reference = path.substr(folder.size());
  while (!reference.empty() && reference.front() == '/') reference.erase(0, 1);
  const Result<std::string> resolved = files_.Resolve(name_, reference);
  if (resolved) return resolved.value();
  refused_ = fmt::format("{}: {}", Printable(reference), resolved.error().message);
  return std::nullopt;
}

bool GltfDocument::FileExists(const std::string& path, void* self) {
  const auto allowed = static_cast<GltfDocument*>(self)->Allowed(path);
  std::error_code ignored;
  return allowed && std::filesystem::is_regular_file(*allowed, ignored);
}

bool GltfDocument::ReadFile(std::vector<unsigned char>* out, std::string* error,
                            const std::string& path, void* self) {
  const auto allowed = static_cast<GltfDocument*>(self)->Allowed(path);
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
bool GltfDocument::KeepImage(tinygltf::Image*, int index, std::string*, std::string*, int, int,
                             const unsigned char* bytes, int size, void* self) {
  auto& encoded = static_cast<GltfDocument*>(self)->encoded_images_;
  const auto i = static_cast<std::size_t>(index);
  if (i >= encoded.size()) encoded.resize(i + 1);
  encoded[i].assign(reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(size));
  return true;
}

}  // namespace sheaf
