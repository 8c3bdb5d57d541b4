// The keys of the window, and what they do.
#ifndef SHEAF_VIEW_KEYS_H_
#define SHEAF_VIEW_KEYS_H_

#include <span>

namespace sheaf {

enum class Action {
  kClose,
  kShowFirst,  // Shown::kColour; the others follow in the order of Shown
  kNextCamera = kShowFirst + 7,
  kPreviousCamera,
  kNextView,
  kReset,
  kNextTarget,
  kBeside,
  kBrighter,
  kDarker,
  kMeter,
  kMoreSamples,
  kFewerSamples,
  kWider,
  kNarrower,
  kSavePicture,
  kSaveCamera,
  kPanel,
};

// Keys are characters, letters in upper case, and these.
inline constexpr int kKeyEscape = 256, kKeyTab = 258, kKeyF1 = 290;

struct Key {
  int key;
  const char* name;
  Action action;
  const char* help;
};
std::span<const Key> Keys();

// What moves the camera while it is held or turned, for the help alone.
struct Motion {
  const char* name;
  const char* help;
};
std::span<const Motion> Motions();

}  // namespace sheaf

#endif  // SHEAF_VIEW_KEYS_H_
