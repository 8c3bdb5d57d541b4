// How a frame's light becomes a picture of bytes: what the command line says, or the scene.
#ifndef SHEAF_APP_CHOOSE_LOOK_H_
#define SHEAF_APP_CHOOSE_LOOK_H_

#include <optional>
#include <string>

#include "sheaf/error.h"
#include "sheaf/render.h"
#include "sheaf/scene.h"

namespace CLI {
class App;
}

namespace sheaf {

// What --exposure says.
struct Exposure {
  std::optional<double> ev;  // none: metered
};

// --exposure and --tone, where they were given.
struct LookOptions {
  std::optional<Exposure> exposure;
  std::string tone;  // empty: the scene's
};

void AddLookOptions(CLI::App& app, LookOptions& look);

// The name of one of these options that the command line has; null where it has none.
const char* GivenLookOption(const LookOptions& look);

// The option that was given for a picture of this path, which holds light as it is: kUsage.
Status CheckLook(const LookOptions& look, const std::string& named);

// Stops and curve.
struct Look {
  double ev = 0;
  Tone tone = Tone::kLinear;
};

// What --tone names, or `otherwise`.
Tone ToneOf(const LookOptions& given, Tone otherwise);

// Whether the exposure is that of what a camera sees.
bool IsMetered(const LookOptions& given, const Settings& settings);

// Where the exposure is metered, it renders a small picture.
Result<Look> ChooseLook(const LookOptions& given, const Renderer& renderer, const Camera& camera,
                        const RenderOptions& options);

}  // namespace sheaf

#endif  // SHEAF_APP_CHOOSE_LOOK_H_
