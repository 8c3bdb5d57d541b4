#include "sheaf/scene.h"

namespace sheaf {

const char* IntegratorName(Integrator integrator) {
  switch (integrator) {
    case Integrator::kWhitted:
      return "whitted";
    case Integrator::kDistributed:
      return "distributed";
    case Integrator::kPath:
      break;
  }
  return "path";
}

}  // namespace sheaf
