// Runs the command as a user does, in a temporary folder.
#ifndef SHEAF_TESTS_RUN_COMMAND_H_
#define SHEAF_TESTS_RUN_COMMAND_H_

#include <sys/types.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

// Before kScene, which enumerators of these headers would shadow.
#include "sheaf/formats.h"

namespace sheaf {

inline const std::string kScene = SHEAF_SOURCE_DIR "/scenes/crystal-ball.json";

std::string ReadText(const std::string& path);
void WriteText(const std::string& path, const std::string& text);

bool Contains(const std::string& text, const std::string& part);
std::size_t LineCount(const std::string& text);

struct Outcome {
  int code;  // the exit code; minus the signal where one killed the command
  std::string out, err;
};

// A running `sheaf`. Its streams go to files, which fill no pipe and can be read meanwhile.
class Process {
 public:
  Process(std::vector<std::string> arguments, const std::string& out_path,
          const std::string& err_path);

  void Signal(int number) const;

  // Until the command has a handler for it, which the kernel tells; or a while, where it does not.
  void WaitUntilCaught(int number) const;
  std::string err() const { return ReadText(err_path_); }

  int WaitForExit() const;
  Outcome Wait() const;

 private:
  pid_t process_ = 0;
  std::string out_path_, err_path_;
};

// A folder for the pictures and one beside it for the streams; both go away with the test.
class Workspace {
 public:
  Workspace();
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;
  ~Workspace();

  std::string operator/(const std::string& name) const;

  // Names of what lies in the folder, sorted, hidden ones too.
  std::vector<std::string> Files() const;

  Process Start(const std::vector<std::string>& arguments) const;
  Outcome Run(const std::vector<std::string>& arguments) const { return Start(arguments).Wait(); }

  // `sheaf render SCENE` at a size that takes no time.
  Outcome Render(std::vector<std::string> arguments) const;

 private:
  std::filesystem::path root_;
};

}  // namespace sheaf

#endif  // SHEAF_TESTS_RUN_COMMAND_H_
