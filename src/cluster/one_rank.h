// A process alone as a rank: it leads, and nobody follows.
#ifndef SHEAF_CLUSTER_ONE_RANK_H_
#define SHEAF_CLUSTER_ONE_RANK_H_

#include <cstddef>
#include <string>

#include "src/cluster/ranks.h"

namespace sheaf {

class OneRank : public Ranks {
 public:
  int rank() const override { return 0; }
  int count() const override { return 1; }
  void Send(int, int, std::string) override {}
  void Drive() override {}
  bool Receive(RankMessage*) override { return false; }
  std::size_t pending() const override { return 0; }
  void Leave() override {}
};

}  // namespace sheaf

#endif  // SHEAF_CLUSTER_ONE_RANK_H_
