#include "src/app/area_journal.h"

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
#include <numeric>
#include <optional>
#include <utility>

#include "src/core/checksum.h"
#include "src/formats/printable.h"

namespace sheaf {
namespace {

struct Header {
  char magic[8] = {'S', 'H', 'E', 'A', 'F', 'J', '2', '\n'};
  std::uint64_t identity = 0;
};

// Before the floats of an area: its colours, then its layers in their order.
struct AreaHeader {
  std::int32_t x0, y0, x1, y1;
  std::uint64_t bytes, checksum;  // of the floats; of what precedes it, and the floats
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

AreaHeader HeaderOf(const PixelRect& area, const Film& pixels) {
  AreaHeader header{area.x0, area.y0, area.x1, area.y1, 0, 0};
  Checksum checksum;
  ForEachArray(pixels, [&](const Film::Floats& floats) {
    header.bytes += floats.size() * sizeof(float);
    checksum.Add(floats.data(), floats.size() * sizeof(float));
  });
  checksum.Add(&header, offsetof(AreaHeader, checksum));
  header.checksum = checksum.value();
  return header;
}

// The floats of an area from `offset` on, which is moved behind them; nothing where they end early.
std::optional<Film> ReadFloats(int descriptor, const PixelRect& area, Layers layers,
                               std::uint64_t* offset) {
  Film film(area.width(), area.height(), layers);
  bool is_whole = true;
  ForEachArray(film, [&](Film::Floats& floats) {
    const std::size_t bytes = floats.size() * sizeof(float);
    is_whole = is_whole && ReadAt(descriptor, *offset, floats.data(), bytes);
    *offset += bytes;
  });
  if (!is_whole) return std::nullopt;
  return film;
}

}  // namespace

std::string JournalPath(const std::string& output) {
  const std::size_t name = output.rfind('/') + 1;
  return output.substr(0, name) + "." + output.substr(name) + ".sheaf-journal";
}

void RemoveJournal(const std::string& path) { unlink(path.c_str()); }

Result<AreaJournal> AreaJournal::Open(const std::string& path, std::uint64_t identity) {
  const int descriptor = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (descriptor < 0) return Failed(path, "cannot be opened");
  AreaJournal journal(descriptor, path);
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

Status AreaJournal::Start(std::uint64_t identity) {
  Header header;
  header.identity = identity;
  if (ftruncate(descriptor_, 0) != 0 || !WriteAt(descriptor_, 0, &header, sizeof(header))) {
    return Failed(path_, "cannot be written");
  }
  end_ = sizeof(header);
  return Done{};
}

AreaJournal::AreaJournal(AreaJournal&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      path_(std::move(other.path_)),
      was_other_(other.was_other_),
      picture_(other.picture_),
      layers_(other.layers_),
      end_(other.end_),
      earlier_(std::move(other.earlier_)),
      offsets_(std::move(other.offsets_)) {}

AreaJournal::~AreaJournal() {
  if (descriptor_ >= 0) close(descriptor_);
}

Status AreaJournal::Load(const PixelRect& picture, Layers layers) {
  picture_ = picture;
  layers_ = layers;
  while (Index()) continue;
  // What is torn must not stand behind a shorter record.
  if (ftruncate(descriptor_, static_cast<off_t>(end_)) != 0) {
    return Failed(path_, "cannot be written");
  }
  std::vector<std::size_t> order(earlier_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const PixelRect &first = earlier_[a], &second = earlier_[b];
    return std::pair(first.y0, first.x0) < std::pair(second.y0, second.x0);
  });
  std::vector<PixelRect> areas;
  std::vector<std::uint64_t> offsets;
  for (const std::size_t i : order) {
    areas.push_back(earlier_[i]);
    offsets.push_back(offsets_[i]);
  }
  earlier_ = std::move(areas);
  offsets_ = std::move(offsets);
  return Done{};
}

bool AreaJournal::Index() {
  AreaHeader header;
  if (!ReadAt(descriptor_, end_, &header, sizeof(header))) return false;
  const PixelRect area{header.x0, header.y0, header.x1, header.y1};
  if (area.x0 < picture_.x0 || area.x0 >= area.x1 || area.x1 > picture_.x1 ||
      area.y0 < picture_.y0 || area.y0 >= area.y1 || area.y1 > picture_.y1) {
    return false;
  }
  std::uint64_t at = end_ + sizeof(header);
  const std::optional<Film> film = ReadFloats(descriptor_, area, layers_, &at);
  if (!film) return false;
  const AreaHeader found = HeaderOf(area, *film);
  if (found.bytes != header.bytes || found.checksum != header.checksum) return false;
  earlier_.push_back(area);
  offsets_.push_back(end_ + sizeof(header));
  end_ = at;
  return true;
}

Result<Film> AreaJournal::TakeRows(int y) {
  if (earlier_.empty() || earlier_[0].y0 != y || earlier_[0].width() != picture_.width()) {
    return Film();
  }
  Result<Film> rows = Read(0);
  earlier_.erase(earlier_.begin());
  offsets_.erase(offsets_.begin());
  return rows;
}

Result<Film> AreaJournal::Read(std::size_t index) {
  std::uint64_t at = offsets_[index];
  errno = 0;
  std::optional<Film> film = ReadFloats(descriptor_, earlier_[index], layers_, &at);
  if (!film) return Failed(path_, "cannot be read");
  return std::move(*film);
}

Status AreaJournal::Keep(const PixelRect& area, const Film& pixels) {
  const AreaHeader header = HeaderOf(area, pixels);
  std::uint64_t at = end_;
  bool is_written = WriteAt(descriptor_, at, &header, sizeof(header));
  at += sizeof(header);
  ForEachArray(pixels, [&](const Film::Floats& floats) {
    const std::size_t bytes = floats.size() * sizeof(float);
    is_written = is_written && WriteAt(descriptor_, at, floats.data(), bytes);
    at += bytes;
  });
  if (!is_written) return Failed(path_, "cannot be written");
  end_ = at;
  return Done{};
}

}  // namespace sheaf
