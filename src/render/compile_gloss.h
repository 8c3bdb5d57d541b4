// How much of the light that meets a rough surface its facets send to one another.
#ifndef SHEAF_RENDER_COMPILE_GLOSS_H_
#define SHEAF_RENDER_COMPILE_GLOSS_H_

#include <map>
#include <memory>
#include <tuple>
#include <vector>

#include "simd/shading.h"

namespace sheaf {

// The tables of a scene's rough materials, which live as long as this; a moved one keeps them where
// they are.
template <typename Real>
class GlossTables {
 public:
  // 2 * kGlossEntries numbers for a material that has facets: one over the share that leaves when
  // all is reflected and transmitted, so that throughputs times it lose nothing. kGlossRows times
  // as many where the width of their slopes varies. Of a material that transmits, the table is that
  // of its interface.
  const Real* TableOf(const MaterialData<Real>& material);

 private:
  // Slope width, below 0 for all of them; index; whether it transmits.
  using Key = std::tuple<double, double, bool>;
  std::map<Key, std::unique_ptr<std::vector<Real>>> tables_;
};

}  // namespace sheaf

#endif  // SHEAF_RENDER_COMPILE_GLOSS_H_
