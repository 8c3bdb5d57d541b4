#include "src/formats/gltf.h"

#include <exception>
#include <new>

#include "src/core/out_of_memory.h"
#include "src/formats/gltf_animations.h"
#include "src/formats/gltf_document.h"
#include "src/formats/gltf_materials.h"
#include "src/formats/gltf_meshes.h"
#include "src/formats/gltf_nodes.h"
#include "src/formats/read_file.h"

namespace sheaf {

Result<Scene> ParseGltf(std::string_view bytes, const std::string& name, SceneFiles& files) {
  Scene scene;
  GltfDocument document(name, files);
  GltfMaterials materials(document, scene);
  GltfMeshes meshes(document, materials, scene);
  GltfNodes nodes(document, meshes, scene);
  try {
    if (!document.Parse(bytes) ||
        !ApplyAnimations(document, {files.options().time, files.options().animation}) ||
        !materials.Read() || !nodes.Read()) {
      return document.Failure();
    }
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {  // of tinygltf and its JSON library
    ThrowIfOutOfMemory(error.what());
    return SceneError(name, FirstLine(error.what()));
  }
  const bool is_empty = scene.objects.empty() && scene.instances.empty();
  if (is_empty && document.left_out()) return *document.left_out();
  if (is_empty) return SceneError(name, "no mesh in its scene");
  return scene;
}

}  // namespace sheaf
