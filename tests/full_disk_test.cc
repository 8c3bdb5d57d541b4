// Disks that are full, small or read-only, folders that may not be written, and a limit on the size
// of files: the old picture or the whole new one, one line, the exit code of input and output.
//
// The disks are small ones in memory, mounted in a namespace of the test's own. Where the system
// grants none, their cases say so and are left out.
#include <doctest/doctest.h>
#include <fcntl.h>
#include <linux/capability.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/run_command.h"

namespace sheaf {
namespace {

namespace fs = std::filesystem;

constexpr char kOld[] = "OLD";

// Gives this process mounts of its own. It has one thread yet.
bool EnterNamespace() {
  const std::string user = std::to_string(getuid()), group = std::to_string(getgid());
  const auto map = [](const char* path, const std::string& text) {
    return static_cast<bool>(std::ofstream(path) << text << std::flush);
  };
  if (unshare(CLONE_NEWUSER | CLONE_NEWNS) == 0) {
    if (!map("/proc/self/setgroups", "deny") || !map("/proc/self/uid_map", "0 " + user + " 1") ||
        !map("/proc/self/gid_map", "0 " + group + " 1")) {
      return false;
    }
  } else if (unshare(CLONE_NEWNS) != 0) {
    return false;
  }
  return mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0;
}

// Another process tries first: half a namespace would take this one's rights.
bool HasNamespace() {
  static const bool has = [] {
    const pid_t child = fork();
    if (child == 0) _exit(EnterNamespace() ? 0 : 1);
    int status = 1;
    waitpid(child, &status, 0);
    return status == 0 && EnterNamespace();
  }();
  if (!has) MESSAGE("skipped: no disk can be mounted here");
  return has;
}

// A disk of its own in a folder.
class Disk {
 public:
  Disk(const std::string& folder, std::size_t bytes) : folder_(folder) {
    fs::create_directories(folder_);
    const std::string size = "size=" + std::to_string(bytes);
    REQUIRE(mount("tmpfs", folder_.c_str(), "tmpfs", 0, size.c_str()) == 0);
  }
  Disk(const Disk&) = delete;
  Disk& operator=(const Disk&) = delete;
  ~Disk() { umount2(folder_.c_str(), MNT_DETACH); }

  void Remount(unsigned long flags, std::size_t bytes) const {
    const std::string size = "size=" + std::to_string(bytes);
    REQUIRE(mount("tmpfs", folder_.c_str(), "tmpfs", MS_REMOUNT | flags, size.c_str()) == 0);
  }

  // Takes all of its room but `rest`.
  void Fill(std::size_t rest) const {
    const std::string path = folder_ + "/fill";
    const int file = open(path.c_str(), O_WRONLY | O_CREAT, 0600);
    const std::string page(4096, 'x');
    std::size_t size = 0;
    for (ssize_t wrote = 0; (wrote = write(file, page.data(), page.size())) > 0;) {
      size += static_cast<std::size_t>(wrote);
    }
    REQUIRE(ftruncate(file, static_cast<off_t>(size - std::min(size, rest))) == 0);
    close(file);
  }

 private:
  const std::string folder_;
};

// What commands read, and a folder that they are to write to.
class Inputs {
 public:
  Inputs() {
    for (const std::string ending : {".png", ".pfm", ".exr"}) {
      REQUIRE(work_.Render({"-q", "-o", work_ / ("in" + ending)}).code == 0);
      for (const std::string part : {"1", "2"}) {
        REQUIRE(work_.Render({"-q", "--tile", part + "/2", "-o", work_ / ("part" + part + ending)})
                    .code == 0);
      }
    }
    REQUIRE(work_.Render({"-q", "--aov", "albedo,normal", "-o", work_ / "layers.exr"}).code == 0);
    fs::create_directory(out());
  }
  const Workspace& work() const { return work_; }
  std::string out() const { return work_ / "out"; }

  struct Command {
    std::string output;
    std::vector<std::string> words;
  };
  // Each command that writes a picture, for each format, and those that write something else.
  std::vector<Command> Commands() const {
    std::vector<Command> commands;
    const auto add = [&](const std::string& name, std::vector<std::string> words) {
      const std::string output = out() + "/" + name;
      words.insert(words.end(), {"-o", output});
      commands.push_back({output, words});
    };
    for (const std::string e : {".png", ".pfm", ".exr"}) {
      add("render" + e, {"render", kScene, "--size", "64x48", "-q"});
      add("resume" + e, {"render", kScene, "--size", "64x48", "-q", "--resume"});
      add("merge" + e, {"merge", work_ / ("part1" + e), work_ / ("part2" + e)});
      add("convert" + e, {"convert", work_ / (e == ".pfm" ? "in.exr" : "in.pfm")});
      add("denoise" + e, {"denoise", work_ / "layers.exr"});
    }
    add("scene.json", {"convert", kScene});
    return commands;
  }

 private:
  Workspace work_;
};

// The files of a folder but the one that fills its disk.
std::vector<std::string> FilesOf(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().filename() != "fill") names.push_back(entry.path().filename().string());
  }
  return names;
}

// Of a run that could not write.
void CheckRefused(const Outcome& outcome, const std::string& output) {
  CAPTURE(outcome.err);
  CHECK(outcome.code == 4);
  CHECK(LineCount(outcome.err) == 1);
  CHECK(Contains(outcome.err, fs::path(output).filename().string()));
  CHECK_FALSE(Contains(outcome.err, ": \n"));
}

// Nothing but the old file is there, unless a journal is kept on purpose.
void CheckOldIsLeft(const std::string& output) {
  CHECK(ReadText(output) == kOld);
  for (const std::string& name : FilesOf(fs::path(output).parent_path())) {
    CAPTURE(name);
    CHECK((name == fs::path(output).filename() || Contains(name, ".sheaf-journal")));
  }
}

// Every command is refused, and its old file stays alone.
void CheckNothingIsWritten(const Inputs& inputs) {
  const std::size_t count = FilesOf(inputs.out()).size();
  for (const auto& command : inputs.Commands()) {
    CAPTURE(command.output);
    CheckRefused(inputs.work().Run(command.words), command.output);
    CHECK(ReadText(command.output) == kOld);
  }
  CHECK(FilesOf(inputs.out()).size() == count);
}

TEST_CASE("a read-only disk") {
  if (!HasNamespace()) return;
  const Inputs inputs;
  const Disk disk(inputs.out(), 1 << 20);
  for (const auto& command : inputs.Commands()) WriteText(command.output, kOld);
  disk.Remount(MS_RDONLY, 1 << 20);
  CheckNothingIsWritten(inputs);
}

TEST_CASE("a folder that may not be written") {
  // Root may write it nevertheless, unless what it starts has lost that power.
  for (const int power : {CAP_DAC_OVERRIDE, CAP_DAC_READ_SEARCH}) {
    if (geteuid() != 0 || prctl(PR_CAPBSET_DROP, power, 0, 0, 0) == 0) continue;
    MESSAGE("skipped: root may write every folder");
    return;
  }
  const Inputs inputs;
  for (const auto& command : inputs.Commands()) WriteText(command.output, kOld);
  REQUIRE(chmod(inputs.out().c_str(), 0555) == 0);
  CheckNothingIsWritten(inputs);
  REQUIRE(chmod(inputs.out().c_str(), 0755) == 0);
}

TEST_CASE("a disk without any room, and with a little") {
  if (!HasNamespace()) return;
  const Inputs inputs;
  int refused = 0, whole = 0;
  for (const auto& command : inputs.Commands()) {
    CAPTURE(command.output);
    REQUIRE(inputs.work().Run(command.words).code == 0);
    const std::string expected = ReadText(command.output);
    REQUIRE(expected.size() > 8);
    fs::remove(command.output);
    for (const std::size_t rest : {0, 4096, 3 * 4096, 9 * 4096, 40 * 4096}) {
      CAPTURE(rest);
      const Disk disk(inputs.out(), 1 << 20);
      WriteText(command.output, kOld);
      disk.Fill(rest);
      const Outcome outcome = inputs.work().Run(command.words);
      if (outcome.code == 0) {
        CHECK(rest > 0);
        ++whole;
        CHECK(outcome.err == "");
        CHECK(ReadText(command.output) == expected);
        CHECK(FilesOf(inputs.out()).size() == 1);
        continue;
      }
      ++refused;
      CheckRefused(outcome, command.output);
      CheckOldIsLeft(command.output);
      // With room it is made, by the journal too where one was kept.
      disk.Remount(0, 4 << 20);
      CHECK(inputs.work().Run(command.words).code == 0);
      CHECK(ReadText(command.output) == expected);
      CHECK(FilesOf(inputs.out()).size() == 1);
    }
  }
  std::printf("small disks: %d runs refused, %d whole, 0 lost\n", refused, whole);
  CHECK(refused >= 16);
  CHECK(whole >= 16);
}

TEST_CASE("a journal that fills the disk is gone on with where there is room") {
  if (!HasNamespace()) return;
  const Inputs inputs;
  const std::vector<std::string> options = {"render",    kScene, "--size", "128x1024",
                                            "--threads", "1",    "-q",     "-o"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), options.begin(), options.end());
    return more;
  };
  REQUIRE(inputs.work().Run(with({inputs.work() / "one.png"})).code == 0);
  const std::string output = inputs.out() + "/a.png";
  const Disk disk(inputs.out(), 1 << 20);  // of the 1.5 MB that the journal takes
  CheckRefused(inputs.work().Run(with({output, "--resume"})), output);
  CHECK(FilesOf(inputs.out()) == std::vector<std::string>{".a.png.sheaf-journal"});
  disk.Remount(0, 8 << 20);
  const Outcome resumed = inputs.work().Run(with({output, "--resume", "--json"}));
  CHECK(resumed.code == 0);
  CHECK(Contains(resumed.out, "\"resumed_rows\""));
  CHECK(ReadText(output) == ReadText(inputs.work() / "one.png"));
  CHECK(FilesOf(inputs.out()) == std::vector<std::string>{"a.png"});
}

TEST_CASE("text and statistics on a disk without any room") {
  if (!HasNamespace()) return;
  const Inputs inputs;
  const Workspace& work = inputs.work();
  const Disk disk(inputs.out(), 1 << 16);
  WriteText(inputs.out() + "/stats.json", kOld);
  disk.Fill(0);
  const std::vector<std::string> submit = {"submit", kScene, "-o", work / "a.png", "--parts", "3"};
  auto list = submit;
  list.push_back("--list=all");
  for (const auto& words : {submit, list}) {
    const Outcome outcome = Process(words, inputs.out() + "/text", work / "err").Wait();
    CHECK(outcome.code == 4);
    CHECK(LineCount(outcome.err) == 1);
    CHECK(Contains(outcome.err, "No space left on device"));
  }
  fs::remove(inputs.out() + "/text");
  const std::string stats = inputs.out() + "/stats.json";
  CheckRefused(work.Render({"-q", "-o", work / "b.png", "--json=" + stats}), stats);
  CHECK(FilesOf(inputs.out()).size() == 1);
}

// What a shell's `ulimit -f` sets; everywhere, without mounts.
class FileLimit {
 public:
  explicit FileLimit(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit limit = {bytes, old_.rlim_max};
    REQUIRE(setrlimit(RLIMIT_FSIZE, &limit) == 0);
  }
  FileLimit(const FileLimit&) = delete;
  FileLimit& operator=(const FileLimit&) = delete;
  ~FileLimit() { setrlimit(RLIMIT_FSIZE, &old_); }

 private:
  rlimit old_;
};

TEST_CASE("a limit on the size of files") {
  const Inputs inputs;
  for (const auto& command : inputs.Commands()) {
    CAPTURE(command.output);
    REQUIRE(inputs.work().Run(command.words).code == 0);
    const std::string expected = ReadText(command.output);
    // The last fails at the last byte. A journal is longer than its picture, and so fails before.
    for (const std::size_t limit : {std::size_t{0}, expected.size() / 2, expected.size() - 1}) {
      CAPTURE(limit);
      WriteText(command.output, kOld);
      Process process = [&] {
        const FileLimit limited(std::max<rlim_t>(limit, 1));
        return inputs.work().Start(command.words);
      }();
      const Outcome outcome = process.Wait();
      // Its line does not fit in the limit.
      CHECK(outcome.code == 4);
      CheckOldIsLeft(command.output);
    }
    for (const std::string& name : FilesOf(inputs.out())) fs::remove(inputs.out() + "/" + name);
  }
}

}  // namespace
}  // namespace sheaf
