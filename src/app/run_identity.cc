#include "src/app/run_identity.h"

#include <fmt/format.h>

#include <fstream>
#include <set>
#include <vector>

#include "sheaf/version.h"
#include "src/core/checksum.h"
#include "src/formats/printable.h"

namespace sheaf {
namespace {

// With its length, so that no two texts in turn are like two others.
void AddText(const std::string& text, Checksum& checksum) {
  const std::uint64_t size = text.size();
  checksum.Add(&size, sizeof(size));
  checksum.Add(text.data(), text.size());
}

}  // namespace

Result<std::uint64_t> FileChecksum(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  Checksum checksum;
  std::vector<char> buffer(1 << 16);
  while (file) {
    file.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    checksum.Add(buffer.data(), static_cast<std::size_t>(file.gcount()));
  }
  if (!file.eof()) {
    return Error{ErrorKind::kInputOutput, fmt::format("{}: cannot be read", PrintablePath(path))};
  }
  return checksum.value();
}

std::uint64_t RunIdentity(const std::string& options, const std::vector<std::string>& files) {
  Checksum checksum;
  AddText(kVersion, checksum);
  AddText(options, checksum);
  for (const std::string& file : std::set<std::string>(files.begin(), files.end())) {
    const Result<std::uint64_t> bytes = FileChecksum(file);
    AddText(file, checksum);
    AddText(bytes ? fmt::format("{}", bytes.value()) : "absent", checksum);
  }
  return checksum.value();
}

}  // namespace sheaf
