// The statements of an OBJ, before they are meshes.
#ifndef SHEAF_FORMATS_OBJ_STATEMENTS_H_
#define SHEAF_FORMATS_OBJ_STATEMENTS_H_

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "src/formats/losses.h"
#include "src/formats/mtl.h"

namespace sheaf {

// Of a corner: no coordinates, no normal.
inline constexpr std::int32_t kObjNone = -1;

struct ObjStatements {
  // Numbers from 0. Those not below the size of their array are for the user to find, because a
  // face may come before its vertices.
  struct Corner {
    std::int32_t position, uv, normal;
    bool operator==(const Corner&) const = default;
  };
  // Its corners, 3 at least, end where those of the next face begin.
  struct Face {
    std::size_t first_corner, line;
  };
  // Faces that follow each other with one group and one name of a material.
  struct Run {
    std::size_t first_face, end_face;
    std::uint32_t group, name;
  };
  struct MaterialName {
    std::string name;
    std::size_t line;  // of its first use
  };

  // One a statement. A statement that is not sound is NaN, so that the others keep their numbers.
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec2> uv;       // v up
  std::vector<glm::vec3> colours;  // of the first positions, not negative; white beyond them
  std::vector<Corner> corners;
  std::vector<Face> faces;  // and one more, of no corners
  std::vector<Run> runs;
  std::vector<std::string> groups;
  std::vector<MaterialName> names;  // the first, "", is that of faces before any usemtl
};

// Reads `text`, the file `name`. What is not sound is left out, libraries are read.
ObjStatements ReadObjStatements(std::string_view text, const std::string& name, SceneFiles& files,
                                Losses& losses, MtlLibraries& libraries);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_OBJ_STATEMENTS_H_
