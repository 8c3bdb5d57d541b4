// Stress cases of the numerics: each has a name, what is expected, and code that finds whether it
// holds on every target.
#ifndef SHEAF_LAB_STRESS_H_
#define SHEAF_LAB_STRESS_H_

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "src/scalar/ray.h"

namespace sheaf::stress {

using Ray = scalar::Ray<float>;

// The ray's numbers as hexadecimal floats between commas: origin, direction, t_min, t_max, source.
std::string RayText(const Ray& ray);
std::optional<Ray> ParseRay(const std::string& text);

enum class Effort { kUsual, kThorough };

// Collects what a case finds wrong. The first few failures are kept, all are counted.
class Report {
 public:
  explicit Report(Effort effort, std::optional<Ray> replay = std::nullopt)
      : effort_(effort), replay_(replay) {}

  // One condition of the case; `what` says it in words, `ray` is the ray that broke it.
  void Expect(bool holds, const std::string& what, const Ray* ray = nullptr);
  // A line of what the replayed ray met.
  void Note(const std::string& line) { notes_.push_back(line); }

  bool is_thorough() const { return effort_ == Effort::kThorough; }
  const std::optional<Ray>& replay() const { return replay_; }
  std::uint64_t checks() const { return checks_; }
  std::uint64_t failures() const { return failures_; }
  const std::vector<std::string>& lines() const { return lines_; }
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  static constexpr std::size_t kMaxLines = 5;

  Effort effort_;
  std::optional<Ray> replay_;
  std::uint64_t checks_ = 0, failures_ = 0;
  std::vector<std::string> lines_, notes_;
};

enum class Subject { kRays, kPictures };

struct Case {
  const char* name;  // lower case, '-' between words
  const char* expected;
  Subject subject;  // a single ray can be replayed where it is kRays
  void (*run)(Report& report);
};

std::span<const Case> Cases();

}  // namespace sheaf::stress

#endif  // SHEAF_LAB_STRESS_H_
