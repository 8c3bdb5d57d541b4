// A glTF file as tinygltf parses it, with the files that it names.
#ifndef SHEAF_FORMATS_GLTF_DOCUMENT_H_
#define SHEAF_FORMATS_GLTF_DOCUMENT_H_

#include <tiny_gltf.h>

#include <cstddef>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sheaf/error.h"
#include "src/formats/gltf_source.h"
#include "src/formats/scene_files.h"

namespace sheaf {

// Where the bytes of an image lie: behind a URI, or else in a view of a buffer.
struct GltfImage {
  std::string uri;
  int view = -1;
};

// What the readers of its parts share: the model, and the first fault that one of them finds.
class GltfDocument {
 public:
  GltfDocument(const std::string& name, SceneFiles& files) : name_(name), files_(files) {}
  GltfDocument(const GltfDocument&) = delete;
  GltfDocument& operator=(const GltfDocument&) = delete;

  // False with a fault. May throw what tinygltf and its JSON library throw.
  bool Parse(std::string_view bytes);

  // All of it but `images`, which are below.
  const tinygltf::Model& model() const { return model_; }
  std::vector<tinygltf::Node>& nodes() { return model_.nodes; }  // for animations to move
  std::size_t buffer_bytes() const { return buffer_bytes_; }     // of the file and of all buffers

  std::size_t image_count() const { return images_.size(); }
  const GltfImage& image(std::size_t index) const { return images_[index]; }
  // The bytes of an image as they lie in its file. An error, without a place, where there are none.
  Result<std::string> ImageBytes(std::size_t index);

  // As DecodedImages::Decode.
  Result<std::shared_ptr<const Image>> Decode(std::string_view bytes, const std::string& name) {
    return files_.images().Decode(bytes, name);
  }

  // Keeps the first fault and returns false. `place` is a JSON pointer, or empty.
  bool Fail(std::string place, std::string_view what);
  Error Failure() const;

  // As SceneFiles has it.
  void AddAnimation(const std::string& name, double seconds) { files_.AddAnimation(name, seconds); }

  // What is left out or replaced, as Warnings::Add takes it; `place` is a JSON pointer, or empty.
  void Warn(const std::string& place, std::string_view kind, std::string_view detail = {});
  // The same for a part of the model's geometry.
  void LeaveOut(const std::string& place, std::string_view kind, std::string_view detail = {});
  // The first part that was left out.
  const std::optional<Error>& left_out() const { return left_out_; }

 private:
  bool LoadBuffers(const nlohmann::json& buffers, std::optional<std::string_view> binary);
  bool LoadModel(const std::string& json);
  Result<std::string> BytesOf(const std::string& uri);
  std::string PlaceIn(const std::string& pointer) const;

  struct Fault {
    std::string place, what;
  };

  const std::string& name_;
  SceneFiles& files_;
  std::optional<Fault> fault_;
  std::optional<Error> left_out_;
  tinygltf::Model model_;
  std::vector<GltfImage> images_;
  std::size_t buffer_bytes_ = 0;
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
