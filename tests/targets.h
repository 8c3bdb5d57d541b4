// Runs a test on every usable SIMD target, and makes sure that it is the one that ran.
#ifndef SHEAF_TESTS_TARGETS_H_
#define SHEAF_TESTS_TARGETS_H_

#include <doctest/doctest.h>

#include <string>

#include "simd/target.h"

namespace sheaf {

// Forces each target in turn around `body(name)`. Checks, before and after, the name that code
// compiled for the target reports: a forced target that silently runs another is the classic false
// green.
template <typename Body>
void ForEachTarget(Body body) {
  int targets = 0;
  for (const std::string& name : simd::UsableTargets()) {
    CAPTURE(name);
    REQUIRE(simd::ForceTarget(name));
    REQUIRE(simd::RunningTarget() == name);
    body(name);
    REQUIRE(simd::RunningTarget() == name);
    ++targets;
  }
  REQUIRE(simd::ForceTarget("auto"));
  REQUIRE(targets >= 2);
}

}  // namespace sheaf

#endif  // SHEAF_TESTS_TARGETS_H_
