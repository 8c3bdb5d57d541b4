// Pictures: quantisation, round trips, damaged files, and files that appear whole or not at all.
#include "src/formats/picture.h"

#include <doctest/doctest.h>
#include <png.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "sheaf/version.h"
#include "src/core/atomic_file.h"
#include "src/formats/pfm.h"
#include "src/formats/png.h"
#include "src/formats/quantize.h"

namespace sheaf {
namespace {

namespace fs = std::filesystem;

// A folder that goes away with the test.
class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "sheaf-test-XXXXXX").string();
    REQUIRE(mkdtemp(name.data()) != nullptr);
    path_ = name;
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() { fs::remove_all(path_); }

  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  // Hidden files count: a temporary left behind is one.
  std::size_t FileCount() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(path_), fs::directory_iterator()));
  }

 private:
  fs::path path_;
};

std::string ReadText(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void WriteText(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

Film RandomFilm(int width, int height) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> channel(-0.2f, 1.2f);
  Film film(width, height);
  for (float& value : film.rgb) value = channel(random);
  return film;
}

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

std::uint8_t Quantized(float value, Transfer transfer = Transfer::kLinear) {
  Film film(1, 1);
  film.rgb = {value, 0.0f, 0.0f};
  return QuantizeTo8Bit(film, transfer)[0];
}

TEST_CASE("quantisation clamps, and NaN is black") {
  const float inf = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const Transfer transfer : {Transfer::kLinear, Transfer::kSrgb}) {
    CHECK(Quantized(nan, transfer) == 0);
    CHECK(Quantized(-nan, transfer) == 0);
    CHECK(Quantized(inf, transfer) == 255);
    CHECK(Quantized(-inf, transfer) == 0);
    CHECK(Quantized(0.0f, transfer) == 0);
    CHECK(Quantized(-0.0f, transfer) == 0);
    CHECK(Quantized(-1.0f, transfer) == 0);
    CHECK(Quantized(1.0f, transfer) == 255);
    CHECK(Quantized(std::nextafter(1.0f, 0.0f), transfer) == 255);
    CHECK(Quantized(3e38f, transfer) == 255);
    CHECK(Quantized(std::numeric_limits<float>::denorm_min(), transfer) == 0);
  }
}

TEST_CASE("quantisation rounds to nearest at every boundary") {
  for (int level = 0; level < 255; ++level) {
    // The float on each side of (level + .5) / 255, judged in long double.
    const long double boundary = (static_cast<long double>(level) + 0.5L) / 255.0L;
    float below = static_cast<float>(boundary);
    while (static_cast<long double>(below) >= boundary) below = std::nextafter(below, 0.0f);
    float above = std::nextafter(below, 1.0f);
    CHECK(Quantized(below) == level);
    CHECK(Quantized(above) == level + 1);
  }
  CHECK(Quantized(0.5f) == 128);  // 127.5 exactly: halves go up
}

TEST_CASE("every 8-bit sRGB level survives linear light") {
  for (int level = 0; level < 256; ++level) {
    const double encoded = level / 255.0;
    const double linear =
        encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
    CHECK(Quantized(static_cast<float>(linear), Transfer::kSrgb) == level);
  }
}

TEST_CASE("the ending chooses the format") {
  for (const std::string path : {"a.png", "a.PNG", "/x.y/a.b.pfm", "a.Pfm", ".png"}) {
    CHECK_MESSAGE(CheckPicturePath(path).ok(), path);
  }
  for (const std::string path : {"", "a", "png", "a.jpg", "a.png/b", "a.png.", "a.pngx"}) {
    const Status status = CheckPicturePath(path);
    REQUIRE_MESSAGE(!status.ok(), path);
    CHECK(status.error().kind == ErrorKind::kUsage);
    CHECK(status.error().message.find(".pfm") != std::string::npos);
  }
}

TEST_CASE("PFM keeps every bit") {
  const Folder folder;
  for (const auto& [width, height] : {std::pair(1, 1), {1, 7}, {13, 1}, {33, 17}}) {
    Film film = RandomFilm(width, height);
    film.rgb.front() = std::bit_cast<float>(0x7fc12345u);  // a NaN with a payload
    film.rgb.back() = -0.0f;
    const std::string path = folder / "a.pfm";
    REQUIRE(WritePicture(film, Transfer::kSrgb, path).ok());
    const Result<Film> read = ReadPfm(path);
    REQUIRE(read.ok());
    CHECK(read.value().width == width);
    CHECK(read.value().height == height);
    REQUIRE(read.value().rgb.size() == film.rgb.size());
    for (std::size_t i = 0; i < film.rgb.size(); ++i) {
      CHECK(std::bit_cast<std::uint32_t>(read.value().rgb[i]) ==
            std::bit_cast<std::uint32_t>(film.rgb[i]));
    }
  }
  CHECK(folder.FileCount() == 1);
}

TEST_CASE("PFM is laid out as its format says") {
  const Folder folder;
  Film film(1, 2);
  film.rgb = {1.0f, 0.0f, 0.0f, 0.0f, 2.0f, 0.0f};
  REQUIRE(WritePfm(film, folder / "a.pfm").ok());
  const std::string zero(4, '\0');
  const std::string one("\0\0\x80\x3f", 4), two("\0\0\0\x40", 4);
  CHECK(ReadText(folder / "a.pfm") ==
        "PF\n1 2\n-1.0\n" + zero + two + zero + one + zero + zero);  // bottom row first
}

TEST_CASE("PFM of the other byte order reads the same") {
  const Folder folder;
  WriteText(folder / "a.pfm",
            std::string("PF\n1 1\n1.0\n") + std::string("\x3f\x80\0\0\x40\0\0\0\0\0\0\0", 12));
  const Result<Film> read = ReadPfm(folder / "a.pfm");
  REQUIRE(read.ok());
  CHECK(read.value().rgb == decltype(Film::rgb){1.0f, 2.0f, 0.0f});
}

TEST_CASE("damaged PFM files are errors") {
  const Folder folder;
  const std::string pixel(12, '\0');
  const std::string damaged[] = {
      "",
      "PF",
      "Pf\n1 1\n-1.0\n" + pixel,
      "P6\n1 1\n-1.0\n" + pixel,
      "PF\n1\n",
      "PF\n0 1\n-1.0\n" + pixel,
      "PF\n-1 1\n-1.0\n" + pixel,
      "PF\n1 1x\n-1.0\n" + pixel,
      "PF\n65537 1\n-1.0\n" + pixel,
      "PF\n1 99999999999999999999\n-1.0\n" + pixel,
      "PF\n65536 65536\n-1.0\n" + pixel,
      "PF\n1 1\n0\n" + pixel,
      "PF\n1 1\nnan\n" + pixel,
      "PF\n1 1\ninf\n" + pixel,
      "PF\n1 1\n-1.0",
      "PF\n1 1\n-1.0\n",
      "PF\n1 1\n-1.0\n" + pixel.substr(1),
      "PF\n1 1\n-1.0\n" + pixel + "x",
  };
  for (const std::string& bytes : damaged) {
    WriteText(folder / "a.pfm", bytes);
    const Result<Film> read = ReadPfm(folder / "a.pfm");
    REQUIRE_MESSAGE(!read.ok(), bytes);
    CHECK(read.error().kind == ErrorKind::kInputOutput);
    CHECK(read.error().message.starts_with((folder / "a.pfm") + ": "));
  }
  CHECK(!ReadPfm(folder / "absent.pfm").ok());
  CHECK(!ReadPfm(folder / ".").ok());
}

TEST_CASE("PNG gives back the quantised picture and names its writer") {
  const Folder folder;
  for (const Transfer transfer : {Transfer::kLinear, Transfer::kSrgb}) {
    for (const auto& [width, height] : {std::pair(1, 1), {1, 7}, {13, 1}, {133, 57}}) {
      const Film film = RandomFilm(width, height);
      REQUIRE(WritePicture(film, transfer, folder / "a.png").ok());
      const Result<Picture8> read = ReadPng(folder / "a.png");
      REQUIRE(read.ok());
      CHECK(read.value().width == width);
      CHECK(read.value().height == height);
      CHECK(read.value().rgb == QuantizeTo8Bit(film, transfer));
    }
    const std::string bytes = ReadText(folder / "a.png");
    CHECK(bytes.find(std::string("Software\0sheaf ", 15) + kVersion) != std::string::npos);
    CHECK((bytes.find("sRGB") != std::string::npos) == (transfer == Transfer::kSrgb));
  }
}

TEST_CASE("the same film gives the same PNG bytes") {
  const Folder folder;
  const Film film = RandomFilm(40, 30);
  REQUIRE(WritePicture(film, Transfer::kLinear, folder / "a.png").ok());
  REQUIRE(WritePicture(film, Transfer::kLinear, folder / "b.png").ok());
  CHECK(ReadText(folder / "a.png") == ReadText(folder / "b.png"));
}

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

// Two pixels in a format of libpng's simplified interface; the bytes are what it takes for them.
void WriteForeignPng(const std::string& path, png_uint_32 format, const void* pixels,
                     const void* palette = nullptr, png_uint_32 colours = 0) {
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  image.width = 2;
  image.height = 1;
  image.format = format;
  image.colormap_entries = colours;
  REQUIRE(png_image_write_to_file(&image, path.c_str(), 0, pixels, 0, palette) != 0);
}

TEST_CASE("PNG of other pixel formats becomes RGB") {
  const Folder folder;
  const std::string path = folder / "a.png";
  const std::uint8_t grey[] = {10, 200}, rgba[] = {1, 2, 3, 255, 4, 5, 6, 0};
  const std::uint8_t palette[] = {7, 8, 9, 10, 11, 12}, indices[] = {1, 0};

  WriteForeignPng(path, PNG_FORMAT_GRAY, grey);
  REQUIRE(ReadPng(path).ok());
  CHECK(ReadPng(path).value().rgb == std::vector<std::uint8_t>{10, 10, 10, 200, 200, 200});
  WriteForeignPng(path, PNG_FORMAT_RGBA, rgba);
  REQUIRE(ReadPng(path).ok());
  CHECK(ReadPng(path).value().rgb == std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6});
  WriteForeignPng(path, PNG_FORMAT_RGB_COLORMAP, indices, palette, 2);
  REQUIRE(ReadPng(path).ok());
  CHECK(ReadPng(path).value().rgb == std::vector<std::uint8_t>{10, 11, 12, 7, 8, 9});
}

TEST_CASE("damaged PNG files are errors") {
  const Folder folder;
  const std::string path = folder / "a.png";
  REQUIRE(WritePicture(RandomFilm(20, 20), Transfer::kLinear, path).ok());
  const std::string whole = ReadText(path);

  for (std::size_t length = 0; length < whole.size(); length += 7) {
    WriteText(path, whole.substr(0, length));
    const Result<Picture8> read = ReadPng(path);
    REQUIRE_MESSAGE(!read.ok(), length);
    CHECK(read.error().kind == ErrorKind::kInputOutput);
    CHECK(read.error().message.starts_with(path + ": "));
  }
  // Any damaged byte must be survived; most are found by a checksum.
  for (std::size_t i = 0; i < whole.size(); i += 3) {
    std::string damaged = whole;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x55);
    WriteText(path, damaged);
    (void)ReadPng(path).ok();
  }
  CHECK(!ReadPng(folder / "absent.png").ok());
  CHECK(!ReadPng(folder / ".").ok());
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
