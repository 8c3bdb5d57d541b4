// A glTF file as tinygltf parses it, with the files that it names.
#ifndef SHEAF_FORMATS_GLTF_DOCUMENT_H_
#define SHEAF_FORMATS_GLTF_DOCUMENT_H_

#include <tiny_gltf.h>

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sheaf/error.h"
#include "src/formats/scene_files.h"

namespace sheaf {

// What the readers of its parts share: the model, and the first fault that one of them finds.
class GltfDocument {
 public:
  GltfDocument(const std::string& name, SceneFiles& files) : name_(name), files_(files) {}
  GltfDocument(const GltfDocument&) = delete;
  GltfDocument& operator=(const GltfDocument&) = delete;

  // False with a fault. May throw what tinygltf throws.
  bool Parse(std::string_view bytes);

  const tinygltf::Model& model() const { return model_; }
  std::size_t buffer_bytes() const { return buffer_bytes_; }  // of the file and of all buffers

  // The bytes of an image as they lie in its file; empty where it cannot be read, and from the
  // second call on.
  std::string TakeImage(std::size_t index);

  // Keeps the first fault and returns false. `place` is a JSON pointer, or empty.
  bool Fail(std::string place, std::string_view what);
  Error Failure() const;

  // What is passed over; `place` is a JSON pointer, or empty.
  void Warn(const std::string& place, std::string_view what);

 private:
  std::string Folder() const;
  std::optional<std::string> Allowed(const std::string& path);
  static bool FileExists(const std::string& path, void* self);
  static bool ReadFile(std::vector<unsigned char>* out, std::string* error, const std::string& path,
                       void* self);
  static bool KeepImage(tinygltf::Image* image, int index, std::string* error, std::string* warning,
                        int width, int height, const unsigned char* bytes, int size, void* self);

  struct Fault {
    std::string place, what;
  };

  const std::string& name_;
  SceneFiles& files_;
  std::optional<Fault> fault_;
  std::optional<std::string> refused_;  // a file that the library asked for and may not have
  tinygltf::Model model_;
  std::size_t buffer_bytes_ = 0;
  std::vector<std::string> encoded_images_;
};

// Whether `index` is one of `things`.
template <typename Things>
bool IsIndexOf(int index, const Things& things) {
  return index >= 0 && static_cast<std::size_t>(index) < things.size();
}

// The first line of what a library says, safe to show.
std::string FirstLine(const std::string& text);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_GLTF_DOCUMENT_H_
