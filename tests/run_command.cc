#include "tests/run_command.h"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <thread>

extern char** environ;

namespace sheaf {

namespace fs = std::filesystem;

std::string ReadText(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void WriteText(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

bool Contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::size_t LineCount(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

Process::Process(std::vector<std::string> arguments, const std::string& out_path,
                 const std::string& err_path)
    : out_path_(out_path), err_path_(err_path) {
  arguments.insert(arguments.begin(), SHEAF_COMMAND);
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  const int flags = O_WRONLY | O_CREAT | O_TRUNC;
  posix_spawn_file_actions_addopen(&actions, 1, out_path.c_str(), flags, 0644);
  posix_spawn_file_actions_addopen(&actions, 2, err_path.c_str(), flags, 0644);
  // A test run in the background may have these ignored, and the command honours that.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t deadly;
  sigemptyset(&deadly);
  sigaddset(&deadly, SIGINT);
  sigaddset(&deadly, SIGTERM);
  posix_spawnattr_setsigdefault(&attributes, &deadly);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
  const int failure =
      posix_spawn(&process_, SHEAF_COMMAND, &actions, &attributes, argv.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  REQUIRE(failure == 0);
}

void Process::Signal(int number) const { kill(process_, number); }

void Process::WaitUntilCaught(int number) const {
  const std::string path = "/proc/" + std::to_string(process_) + "/status";
  for (int i = 0; i < 1000; ++i) {
    const std::string status = ReadText(path);
    const std::size_t at = status.find("SigCgt:");
    if (at == std::string::npos) break;
    if (std::stoull(status.substr(at + 7), nullptr, 16) >> (number - 1) & 1) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
}

int Process::WaitForExit() const {
  int status = 0;
  while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

Outcome Process::Wait() const {
  const int code = WaitForExit();
  return {code, ReadText(out_path_), ReadText(err_path_)};
}

Workspace::Workspace() {
  std::string name = (fs::temp_directory_path() / "sheaf-test-XXXXXX").string();
  REQUIRE(mkdtemp(name.data()) != nullptr);
  root_ = name;
  fs::create_directory(root_ / "files");
}

Workspace::~Workspace() { fs::remove_all(root_); }

std::string Workspace::operator/(const std::string& name) const {
  return (root_ / "files" / name).string();
}

std::vector<std::string> Workspace::Files() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(root_ / "files")) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

Process Workspace::Start(const std::vector<std::string>& arguments) const {
  return {arguments, (root_ / "out").string(), (root_ / "err").string()};
}

Outcome Workspace::Render(std::vector<std::string> arguments) const {
  const std::vector<std::string> begin = {"render", kScene, "--size", "32x24"};
  arguments.insert(arguments.begin(), begin.begin(), begin.end());
  return Run(arguments);
}

}  // namespace sheaf
