#include "src/core/build_info.h"

#include "sheaf/version.h"

namespace sheaf {
namespace {

#ifdef SHEAF_HAS_OPENEXR
constexpr bool kHasOpenExr = true;
#else
constexpr bool kHasOpenExr = false;
#endif

#ifdef SHEAF_HAS_OPENIMAGEIO
constexpr bool kHasOpenImageIo = true;
#else
constexpr bool kHasOpenImageIo = false;
#endif

#ifdef SHEAF_HAS_WINDOW
constexpr bool kHasWindow = true;
#else
constexpr bool kHasWindow = false;
#endif

#ifdef SHEAF_HAS_MPI
constexpr bool kHasMpi = true;
#else
constexpr bool kHasMpi = false;
#endif

#ifdef SHEAF_HAS_OIDN
constexpr bool kHasOidn = true;
#else
constexpr bool kHasOidn = false;
#endif

constexpr OptionalPart kOptionalParts[] = {
    {"OpenEXR", "reads and writes .exr", kHasOpenExr},
    {"OpenImageIO", "reads textures and environments of BMP, TGA, TIFF, WebP, HDR and EXR",
     kHasOpenImageIo},
    {"window", "shows scenes in a window, by GLFW, OpenGL and Dear ImGui", kHasWindow},
    {"MPI", "renders one picture on many machines, by mpirun", kHasMpi},
    {kOidnPart, "denoises instead of Sheaf's own filter", kHasOidn},
};

}  // namespace

const char* LibraryVersion() { return kVersion; }
const char* CompilerName() { return SHEAF_COMPILER; }
const char* CompilerFlags() { return SHEAF_COMPILER_FLAGS; }
const char* BuildTypeName() { return SHEAF_BUILD_TYPE; }
std::span<const OptionalPart> OptionalParts() { return kOptionalParts; }

}  // namespace sheaf
