// Gives every rank the bytes that rank 0 has read.
#ifndef SHEAF_CLUSTER_SHARE_FILES_H_
#define SHEAF_CLUSTER_SHARE_FILES_H_

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "src/cluster/ranks.h"
#include "src/formats/held_files.h"

namespace sheaf {

// What rank 0 tells the others before the first frame.
struct SharedWork {
  std::string options;  // that the picture's bits depend on, as text
  std::vector<HeldFile> files;
  // No part of it: what rank 0 has sent meanwhile, which may overtake pieces that ranks hand on.
  std::vector<RankMessage> early = {};
};

// Of rank 0: sends it, in pieces, to two ranks, each of which hands it on to two more. `stop` is
// asked meanwhile.
void ShareWork(const SharedWork& work, Ranks& ranks, const std::function<bool()>& stop);

// Of the others: nothing where rank 0 has stopped before there was work, or `stop` says so.
std::optional<SharedWork> ReceiveWork(Ranks& ranks, const std::function<bool()>& stop);

}  // namespace sheaf

#endif  // SHEAF_CLUSTER_SHARE_FILES_H_
