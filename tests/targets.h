// Runs a test on every usable SIMD target, and makes sure that it is the one that ran.
#ifndef SHEAF_TESTS_TARGETS_H_
#define SHEAF_TESTS_TARGETS_H_

#include <doctest/doctest.h>

#include <string>

#include "sheaf/target.h"
#include "simd/kernels.h"
#include "src/core/running_target.h"

namespace sheaf {

// Calls body(target) for each target in turn. Checks the name that code compiled for the target
// reports: a chosen target that silently runs another is the classic false green.
template <typename Body>
void ForEachTarget(Body body) {
  int targets = 0;
  for (const std::string& name : UsableTargets()) {
    CAPTURE(name);
    const std::optional<Target> target = Target::Named(name);
    REQUIRE(target.has_value());
    REQUIRE(target->name() == name);
    REQUIRE(RunningTarget(*target) == name);
    body(*target);
    ++targets;
  }
  REQUIRE(targets >= 2);
}

}  // namespace sheaf

#endif  // SHEAF_TESTS_TARGETS_H_
