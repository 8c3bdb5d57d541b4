#include "src/app/band_journal.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <utility>

#include "src/core/checksum.h"
#include "src/formats/printable.h"

namespace sheaf {
namespace {

struct Header {
  char magic[8] = {'S', 'H', 'E', 'A', 'F', 'J', '1', '\n'};
  std::uint64_t identity = 0;
};

// Before the floats of a band: its colours, then its layers in their order.
struct BandHeader {
  std::uint64_t rows, bytes, checksum;  // of what precedes it, and the floats
};

Error Failed(const std::string& path, const char* what) {
  return {ErrorKind::kInputOutput,
          fmt::format("{}: {}: {}", PrintablePath(path), what, std::strerror(errno))};
}

// Whether all of it was there.
bool ReadAt(int descriptor, std::uint64_t offset, void* data, std::size_t size) {
  for (std::size_t done = 0; done < size;) {
    const ssize_t read = pread(descriptor, static_cast<char*>(data) + done, size - done,
                               static_cast<off_t>(offset + done));
    if (read < 0 && errno == EINTR) continue;
    if (read <= 0) return false;
    done += static_cast<std::size_t>(read);
  }
  return true;
}

bool WriteAt(int descriptor, std::uint64_t offset, const void* data, std::size_t size) {
  for (std::size_t done = 0; done < size;) {
    const ssize_t written = pwrite(descriptor, static_cast<const char*>(data) + done, size - done,
                                   static_cast<off_t>(offset + done));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    done += static_cast<std::size_t>(written);
  }
  return true;
}

// Visits the arrays of a film that it has.
template <typename F, typename Visit>
void ForEachArray(F& film, Visit visit) {
  visit(film.rgb);
  for (auto& layer : film.layers) {
    if (!layer.empty()) visit(layer);
  }
}

BandHeader HeaderOf(const Film& band) {
  BandHeader header{static_cast<std::uint64_t>(band.height), 0, 0};
  Checksum checksum;
  ForEachArray(band, [&](const Film::Floats& floats) {
    header.bytes += floats.size() * sizeof(float);
    checksum.Add(floats.data(), floats.size() * sizeof(float));
  });
  checksum.Add(&header, offsetof(BandHeader, checksum));
  header.checksum = checksum.value();
  return header;
}

}  // namespace

std::string JournalPath(const std::string& output) {
  const std::size_t name = output.rfind('/') + 1;
  return output.substr(0, name) + "." + output.substr(name) + ".sheaf-journal";
}

void RemoveJournal(const std::string& path) { unlink(path.c_str()); }

Result<BandJournal> BandJournal::Open(const std::string& path, std::uint64_t identity) {
  const int descriptor = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (descriptor < 0) return Failed(path, "cannot be opened");
  BandJournal journal(descriptor, path);
  if (flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    return Failed(path,
                  errno == EWOULDBLOCK ? "another run is at this picture" : "cannot be locked");
  }
  Header header;
  const bool is_there = ReadAt(descriptor, 0, &header, sizeof(header));
  const bool is_ours =
      is_there && std::equal(std::begin(header.magic), std::end(header.magic), Header().magic);
  if (is_ours && header.identity == identity) {
    journal.end_ = sizeof(Header);
    return journal;
  }
  struct stat status;
  journal.was_other_ = fstat(descriptor, &status) == 0 && status.st_size > 0 &&
                       (is_ours || status.st_size >= static_cast<off_t>(sizeof(Header)));
  if (const Status started = journal.Start(identity); !started) return started.error();
  return journal;
}

Status BandJournal::Start(std::uint64_t identity) {
  Header header;
  header.identity = identity;
  if (ftruncate(descriptor_, 0) != 0 || !WriteAt(descriptor_, 0, &header, sizeof(header))) {
    return Failed(path_, "cannot be written");
  }
  end_ = sizeof(header);
  return Done{};
}

BandJournal::BandJournal(BandJournal&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      path_(std::move(other.path_)),
      was_other_(other.was_other_),
      end_(other.end_) {}

BandJournal::~BandJournal() {
  if (descriptor_ >= 0) close(descriptor_);
}

Result<bool> BandJournal::Read(int width, Layers layers, int rows, Film* band) {
  BandHeader header;
  const bool has_header = ReadAt(descriptor_, end_, &header, sizeof(header));
  if (has_header && header.rows >= 1 && header.rows <= static_cast<std::uint64_t>(rows)) {
    *band = Film(width, static_cast<int>(header.rows), layers);
    std::uint64_t at = end_ + sizeof(header);
    bool is_whole = true;
    ForEachArray(*band, [&](Film::Floats& floats) {
      const std::size_t bytes = floats.size() * sizeof(float);
      is_whole = is_whole && ReadAt(descriptor_, at, floats.data(), bytes);
      at += bytes;
    });
    if (is_whole) {
      const BandHeader found = HeaderOf(*band);
      is_whole = found.bytes == header.bytes && found.checksum == header.checksum;
    }
    if (is_whole) {
      end_ = at;
      return true;
    }
  }
  // What is torn must not stand behind a shorter record.
  if (ftruncate(descriptor_, static_cast<off_t>(end_)) != 0) {
    return Failed(path_, "cannot be written");
  }
  return false;
}

Status BandJournal::Append(const Film& band) {
  const BandHeader header = HeaderOf(band);
  std::uint64_t at = end_;
  bool is_written = WriteAt(descriptor_, at, &header, sizeof(header));
  at += sizeof(header);
  ForEachArray(band, [&](const Film::Floats& floats) {
    const std::size_t bytes = floats.size() * sizeof(float);
    is_written = is_written && WriteAt(descriptor_, at, floats.data(), bytes);
    at += bytes;
  });
  if (!is_written) return Failed(path_, "cannot be written");
  end_ = at;
  return Done{};
}

}  // namespace sheaf
