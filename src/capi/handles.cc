#include "src/capi/handles.h"

#include "src/core/build_info.h"

namespace sheaf::capi {
namespace {

thread_local std::string kept_message;
// Of the message above, or of a text that needs no memory.
thread_local const char* shown_message = "";

const std::vector<std::string>& TargetNames() {
  static const std::vector<std::string> kNames = UsableTargets();
  return kNames;
}

sheaf_status StatusOf(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::kUsage:
      return SHEAF_USAGE;
    case ErrorKind::kScene:
      return SHEAF_BAD_SCENE;
    case ErrorKind::kInputOutput:
      return SHEAF_INPUT_OUTPUT;
    case ErrorKind::kInterrupted:
      return SHEAF_INTERRUPTED;
  }
  return SHEAF_INTERNAL;
}

std::string BuildText() {
  std::string text = std::string("sheaf ") + LibraryVersion() + "\ncompiler " + CompilerName() +
                     "\nbuild type " + BuildTypeName() + "\n";
  for (const OptionalPart& part : OptionalParts()) {
    text += std::string(part.is_built_in ? "with " : "without ") + part.name + "\n";
  }
  return text;
}

}  // namespace

sheaf_status Fail(sheaf_status status, const char* message) noexcept {
  try {
    kept_message = message;
    shown_message = kept_message.c_str();
  } catch (...) {
    shown_message = "not enough memory";
  }
  return status;
}

sheaf_status Fail(const Error& error) { return Fail(StatusOf(error.kind), error.message.c_str()); }

Result<Target> TargetOf(const char* name) {
  if (name == nullptr) return Target();
  if (const auto target = Target::Named(name)) return *target;
  std::string known = "scalar";
  for (const std::string& usable : TargetNames()) known += ", " + usable;
  return UsageError(std::string("target \"") + name + "\": this processor has " + known);
}

Result<Layers> LayersOf(std::uint32_t bits) {
  Layers layers;
  for (int i = 0; i < kLayerCount; ++i) {
    if (bits >> i & 1u) layers.Add(static_cast<Layer>(i));
  }
  if (bits >> kLayerCount != 0) return UsageError("layers: a bit that stands for no layer");
  return layers;
}

}  // namespace sheaf::capi

using sheaf::capi::TargetNames;

const char* sheaf_error_message() { return sheaf::capi::shown_message; }

const char* sheaf_version() { return sheaf::LibraryVersion(); }

const char* sheaf_build_info() {
  try {
    static const std::string kText = sheaf::capi::BuildText();
    return kText.c_str();
  } catch (...) {
    return "";
  }
}

size_t sheaf_target_count() {
  try {
    return TargetNames().size();
  } catch (...) {
    return 0;
  }
}

const char* sheaf_target_name(size_t index) {
  return index < sheaf_target_count() ? TargetNames()[index].c_str() : nullptr;
}
