// A picture file of the format that SHEAF_FUZZ_ENDING names. What is read can be written, and has
// then the same sides.
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>

#include "sheaf/formats.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string folder = std::filesystem::is_directory("/dev/shm") ? "/dev/shm" : "/tmp";
  static const std::string path =
      folder + "/sheaf-fuzz-" + std::to_string(getpid()) + SHEAF_FUZZ_ENDING;
  std::FILE* const file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) return 0;
  std::fwrite(data, 1, size, file);
  std::fclose(file);
  const auto read = sheaf::ReadPicture(path);
  std::remove(path.c_str());
  if (!read) {
    if (read.error().message.empty() || read.error().message.ends_with(": ")) {
      sheaf::fuzz::Fail("an error without a reason");
    }
    return 0;
  }
  const sheaf::Film& film = read.value().film;
  if (film.width < 1 || film.height < 1 || film.rgb.size() != 3 * film.pixel_count()) {
    sheaf::fuzz::Fail("sides and pixels");
  }
  return 0;
}
