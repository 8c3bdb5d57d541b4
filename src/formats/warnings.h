// What was lost while a scene was read.
#ifndef SHEAF_FORMATS_WARNINGS_H_
#define SHEAF_FORMATS_WARNINGS_H_

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace sheaf {

// `path`, printable, and with a line where it has one: `a.obj:12`.
std::string PlaceOf(std::string_view path);
std::string PlaceOf(std::string_view path, std::size_t line);

// One warning a kind: where it came first, and how often it came. A model with a thousand bad faces
// has one line to read.
class Warnings {
 public:
  // `kind` says what is left out or replaced, and is what is counted. `detail`, which may differ
  // from place to place, is kept of the first. All of it is printable.
  void Add(std::string_view place, std::string_view kind, std::string_view detail = {});

  // In the order of their first places: `place: kind: detail (7 in all)`.
  std::vector<std::string> Lines() const;

 private:
  struct First {
    std::string text;
    std::size_t count = 1;
  };
  std::vector<First> firsts_;
  std::map<std::string, std::size_t, std::less<>> index_;  // of a kind's first
};

}  // namespace sheaf

#endif  // SHEAF_FORMATS_WARNINGS_H_
