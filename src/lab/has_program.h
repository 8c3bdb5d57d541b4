// Whether another program can be run.
#ifndef SHEAF_LAB_HAS_PROGRAM_H_
#define SHEAF_LAB_HAS_PROGRAM_H_

#include <cstdlib>
#include <string>

namespace sheaf {

// Whether `name`, a plain word, is a program on the path.
inline bool HasProgram(const std::string& name) {
  return std::system(("command -v " + name + " >/dev/null 2>&1").c_str()) == 0;
}

}  // namespace sheaf

#endif  // SHEAF_LAB_HAS_PROGRAM_H_
