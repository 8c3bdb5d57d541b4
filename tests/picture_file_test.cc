// Files that appear whole or not at all, whatever disk and path do.
#include <doctest/doctest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <utility>

#include "folder.h"
#include "picture_files.h"
#include "sheaf/formats.h"
#include "src/core/atomic_file.h"

namespace sheaf {
namespace {

namespace fs = std::filesystem;

// Makes every write past `bytes` fail with EFBIG, as a full disk would with ENOSPC.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : old_handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    REQUIRE(getrlimit(RLIMIT_FSIZE, &old_limit_) == 0);
    rlimit limit = old_limit_;
    limit.rlim_cur = bytes;
    REQUIRE(setrlimit(RLIMIT_FSIZE, &limit) == 0);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &old_limit_);
    std::signal(SIGXFSZ, old_handler_);
  }

 private:
  void (*old_handler_)(int);
  rlimit old_limit_ = {};
};

// Rows [y, y + count) of a film.
Film RowsOf(const Film& film, int y, int count) {
  Film rows(film.width, count);
  std::copy_n(film.pixel(0, y), rows.rgb.size(), rows.rgb.begin());
  return rows;
}

// Writes the film `chunk` rows at a time.
Status WriteInChunks(const Film& film, int chunk, const std::string& path) {
  Result<PictureWriter> writer =
      PictureWriter::Create(path, film.width, film.height, Transfer::kSrgb);
  if (!writer) return writer.error();
  for (int y = 0; y < film.height; y += chunk) {
    const Film rows = RowsOf(film, y, std::min(chunk, film.height - y));
    const Status written = writer.value().WriteRows(rows);
    if (!written) return written;
  }
  return writer.value().Finish();
}

TEST_CASE("rows in chunks of any height give the file of the whole film") {
  const Folder folder;
  for (const std::string ending : {".png", ".pfm"}) {
    for (const auto& [width, height] : {std::pair(1, 1), {5, 1}, {1, 9}, {37, 23}}) {
      const Film film = RandomFilm(width, height);
      REQUIRE(WritePicture(film, Transfer::kSrgb, folder / ("whole" + ending)).ok());
      const std::string whole = ReadText(folder / ("whole" + ending));
      REQUIRE(whole.size() > 20);
      for (const int chunk : {1, 2, 7, 22, 23}) {
        CAPTURE(chunk);
        REQUIRE(WriteInChunks(film, chunk, folder / ("chunks" + ending)).ok());
        CHECK(ReadText(folder / ("chunks" + ending)) == whole);
      }
    }
  }
}

TEST_CASE("a picture without its Finish does not appear, and the old one stays") {
  const Folder folder;
  const Film film = RandomFilm(30, 20);
  for (const std::string ending : {".png", ".pfm"}) {
    const std::string fresh = folder / ("new" + ending), old = folder / ("old" + ending);
    WriteText(old, "the old picture");
    const std::size_t count = folder.FileCount();
    for (const std::string& path : {fresh, old}) {
      Result<PictureWriter> writer = PictureWriter::Create(path, 30, 20, Transfer::kLinear);
      REQUIRE(writer.ok());
      REQUIRE(writer.value().WriteRows(RowsOf(film, 0, 13)).ok());
    }
    CHECK(folder.FileCount() == count);
    CHECK(ReadText(old) == "the old picture");
  }
}

TEST_CASE("a picture that cannot be opened is an error before its first row") {
  const Folder folder;
  for (const char* name : {"absent/a.png", "absent/a.pfm"}) {
    const Result<PictureWriter> writer =
        PictureWriter::Create(folder / name, 8, 8, Transfer::kLinear);
    REQUIRE(!writer.ok());
    CHECK(writer.error().kind == ErrorKind::kInputOutput);
    CHECK(writer.error().message.starts_with((folder / name) + ": "));
  }
  const Result<PictureWriter> unknown =
      PictureWriter::Create(folder / "a.jpg", 8, 8, Transfer::kLinear);
  REQUIRE(!unknown.ok());
  CHECK(unknown.error().kind == ErrorKind::kUsage);
  if (!fs::exists("/dev/full")) return;
  for (const char* name : {"full.png", "full.pfm"}) {
    fs::create_symlink("/dev/full", folder / name);
    CHECK(!PictureWriter::Create(folder / name, 8, 8, Transfer::kLinear).ok());
  }
}

TEST_CASE("a disk that fills up between two rows leaves no file") {
  const Folder folder;
  const Film film = RandomFilm(64, 64);
  for (const char* name : {"a.png", "a.pfm"}) {
    Result<PictureWriter> writer = PictureWriter::Create(folder / name, 64, 128, Transfer::kLinear);
    REQUIRE(writer.ok());
    REQUIRE(writer.value().WriteRows(film).ok());
    const FileSizeLimit limit(100);
    Status written = writer.value().WriteRows(film);
    // libpng may keep the last bytes to itself until the end.
    if (written) written = writer.value().Finish();
    REQUIRE(!written.ok());
    CHECK(written.error().kind == ErrorKind::kInputOutput);
    CHECK(written.error().message.starts_with((folder / name) + ": "));
  }
  CHECK(folder.FileCount() == 0);
}

TEST_CASE("a pipe gets the bytes of the file") {
  const Folder folder;
  const Film film = RandomFilm(33, 17);
  for (const std::string ending : {".png", ".pfm"}) {
    const std::string pipe = folder / ("pipe" + ending);
    REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
    std::string read;
    std::thread reader([&] { read = ReadText(pipe); });
    const Status written = WriteInChunks(film, 5, pipe);
    reader.join();
    REQUIRE(written.ok());
    REQUIRE(WriteInChunks(film, 5, folder / ("file" + ending)).ok());
    CHECK(read == ReadText(folder / ("file" + ending)));
  }
}

TEST_CASE("a failed write leaves no file and does not touch the old one") {
  const Folder folder;
  const Film film = RandomFilm(64, 64);
  for (const char* ending : {".png", ".pfm"}) {
    const std::string fresh = folder / (std::string("new") + ending);
    const std::string old = folder / (std::string("old") + ending);
    WriteText(old, "the old picture");
    const std::size_t count = folder.FileCount();
    {
      const FileSizeLimit limit(100);
      for (const std::string& path : {fresh, old}) {
        const Status status = WritePicture(film, Transfer::kLinear, path);
        REQUIRE(!status.ok());
        CHECK(status.error().kind == ErrorKind::kInputOutput);
        CHECK(status.error().message.starts_with(path + ": "));
      }
    }
    CHECK(folder.FileCount() == count);
    CHECK(ReadText(old) == "the old picture");
    REQUIRE(WritePicture(film, Transfer::kLinear, old).ok());
    CHECK(ReadText(old).size() > 100);
  }
}

TEST_CASE("a file appears at Commit and not before") {
  const Folder folder;
  const std::string path = folder / "a";
  {
    Result<AtomicFile> file = AtomicFile::Create(path);
    REQUIRE(file.ok());
    REQUIRE(file.value().Write("new", 3).ok());
    CHECK(!fs::exists(path));
    REQUIRE(file.value().Commit().ok());
    CHECK(ReadText(path) == "new");
  }
  CHECK(ReadText(path) == "new");
  {
    Result<AtomicFile> abandoned = AtomicFile::Create(path);
    REQUIRE(abandoned.ok());
    REQUIRE(abandoned.value().Write("never", 5).ok());
    CHECK(folder.FileCount() <= 2);  // a hidden temporary where the system has no nameless ones
    const AtomicFile moved = std::move(abandoned).value();
  }
  CHECK(ReadText(path) == "new");
  CHECK(folder.FileCount() == 1);
}

TEST_CASE("bytes go to their offsets in any order") {
  const Folder folder;
  Result<AtomicFile> file = AtomicFile::Create(folder / "a");
  REQUIRE(file.ok());
  CHECK(file.value().seekable());
  REQUIRE(file.value().Write("ab", 2).ok());
  REQUIRE(file.value().WriteAt(6, "gh", 2).ok());
  REQUIRE(file.value().WriteAt(4, "ef", 2).ok());
  REQUIRE(file.value().Write("c", 1).ok());
  REQUIRE(file.value().Commit().ok());
  CHECK(ReadText(folder / "a") == std::string("abc\0efgh", 8));
  const Result<AtomicFile> device = AtomicFile::Create("/dev/null");
  REQUIRE(device.ok());
  CHECK(!device.value().seekable());
}

TEST_CASE("a replaced file keeps its permissions, a symbolic link stays a link") {
  const Folder folder;
  WriteText(folder / "a", "old");
  fs::permissions(folder / "a", fs::perms(0640));
  fs::create_symlink("a", folder / "link");
  REQUIRE(WriteFileWhole(folder / "link", "new").ok());
  CHECK(fs::is_symlink(folder / "link"));
  CHECK(ReadText(folder / "a") == "new");
  CHECK(fs::status(folder / "a").permissions() == fs::perms(0640));
}

TEST_CASE("a new file obeys the umask") {
  const Folder folder;
  const mode_t old_mask = umask(027);
  const bool written = WriteFileWhole(folder / "a", "x").ok();
  umask(old_mask);
  REQUIRE(written);
  CHECK(fs::status(folder / "a").permissions() == fs::perms(0640));
}

TEST_CASE("places that cannot be written are known beforehand") {
  const Folder folder;
  WriteText(folder / "file", "");
  CHECK(CheckWritable(folder / "new").ok());
  CHECK(CheckWritable(folder / "file").ok());
  CHECK(CheckWritable("relative-name").ok());
  CHECK(CheckWritable("/dev/null").ok());
  for (const std::string& path :
       {std::string(), folder / ".", folder / "absent/new", folder / "new/", folder / "file/new",
        folder / std::string(300, 'n')}) {
    const Status status = CheckWritable(path);
    REQUIRE_MESSAGE(!status.ok(), path);
    CHECK(status.error().kind == ErrorKind::kInputOutput);
  }
  CHECK(CheckWritable(folder / std::string(255, 'n')).ok());
  CHECK(WriteFileWhole(folder / std::string(255, 'n'), "x").ok());
  // Permissions do not bind root.
  if (geteuid() != 0) {
    fs::permissions(folder / "file", fs::perms(0440));
    CHECK(!CheckWritable(folder / "file").ok());
    fs::permissions(folder / ".", fs::perms(0550));
    CHECK(!CheckWritable(folder / "new").ok());
    fs::permissions(folder / ".", fs::perms(0750));
  }
}

TEST_CASE("devices are written directly and report their errors") {
  CHECK(WriteFileWhole("/dev/null", "x").ok());
  if (!fs::exists("/dev/full")) return;
  const Status status = WriteFileWhole("/dev/full", "x");
  REQUIRE(!status.ok());
  CHECK(status.error().kind == ErrorKind::kInputOutput);
}

}  // namespace
}  // namespace sheaf
