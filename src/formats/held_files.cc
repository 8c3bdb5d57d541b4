#include "src/formats/held_files.h"

#include <map>
#include <mutex>
#include <utility>

namespace sheaf {
namespace {

// Nodes of a map stay where they are, and none is removed.
struct Held {
  std::mutex mutex;
  bool holds = false, is_all = false;
  std::map<std::string, std::string> files;
};

Held& TheHeld() {
  static Held held;
  return held;
}

}  // namespace

void HoldFiles() {
  const std::lock_guard lock(TheHeld().mutex);
  TheHeld().holds = true;
}

std::vector<HeldFile> HeldFiles() {
  const std::lock_guard lock(TheHeld().mutex);
  std::vector<HeldFile> files;
  for (const auto& [path, bytes] : TheHeld().files) files.push_back({path, bytes});
  return files;
}

void ReadOnlyHeldFiles(std::vector<HeldFile> files) {
  const std::lock_guard lock(TheHeld().mutex);
  TheHeld().is_all = true;
  for (HeldFile& file : files) TheHeld().files.insert_or_assign(file.path, std::move(file.bytes));
}

const std::string* FindHeldFile(const std::string& path) {
  const std::lock_guard lock(TheHeld().mutex);
  const auto found = TheHeld().files.find(path);
  return found == TheHeld().files.end() ? nullptr : &found->second;
}

bool AreAllFilesHeld() {
  const std::lock_guard lock(TheHeld().mutex);
  return TheHeld().is_all;
}

void HoldFile(const std::string& path, const std::string& bytes) {
  const std::lock_guard lock(TheHeld().mutex);
  if (TheHeld().holds) TheHeld().files.emplace(path, bytes);
}

}  // namespace sheaf
