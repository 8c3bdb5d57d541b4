// The header of a PLY: what its elements hold.
#ifndef SHEAF_FORMATS_PLY_HEADER_H_
#define SHEAF_FORMATS_PLY_HEADER_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sheaf/error.h"
#include "src/formats/scene_files.h"

namespace sheaf {

enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };
enum class PlyEncoding { kAscii, kLittle, kBig };

// Where a number of a vertex or of a face goes.
enum PlySlot {
  kX,
  kY,
  kZ,
  kNx,
  kNy,
  kNz,
  kU,
  kV,
  kRed,
  kGreen,
  kBlue,
  kAlpha,
  kTexture,  // the number of a face's texture
  kPlySlots,
  kNoSlot = kPlySlots
};

enum class PlyList { kSkipped, kIndices, kCoordinates };  // the last: u and v of each corner

struct PlyProperty {
  PlyType type = PlyType::kFloat;
  std::optional<PlyType> count_type;  // of a list
  PlySlot slot = kNoSlot;
  PlyList list = PlyList::kSkipped;
};

enum class PlyKind { kSkipped, kVertices, kFaces, kStrips };

struct PlyElement {
  std::string_view name;
  std::uint64_t count = 0;
  PlyKind kind = PlyKind::kSkipped;
  std::vector<PlyProperty> properties;
  bool has[kPlySlots + 1] = {};

  bool Has(PlySlot first, int count_of_slots) const;
  bool HasList(PlyList list) const;
};

struct PlyTexture {
  std::string_view file;
  std::size_t line = 0;
};

// Views of the text. Vertices come before what is made of them.
struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::kAscii;
  std::vector<PlyElement> elements;
  std::vector<PlyTexture> textures;  // of `comment TextureFile`
  std::string_view body;
  std::size_t body_line = 0;  // the first one's number
  char line_end = '\n';
};

Result<PlyHeader> ReadPlyHeader(std::string_view text, const std::string& name, SceneFiles& files);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_PLY_HEADER_H_
