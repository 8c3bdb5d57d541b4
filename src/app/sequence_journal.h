// Which pictures of a sequence an earlier run has finished.
#ifndef SHEAF_APP_SEQUENCE_JOURNAL_H_
#define SHEAF_APP_SEQUENCE_JOURNAL_H_

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "sheaf/error.h"

namespace sheaf {

// A small file that is written anew, atomically, after each picture. A picture counts as finished
// where its files still have the bytes that this work wrote.
class SequenceJournal {
 public:
  // Reads the journal at `path`, where there is one. One of another identity counts for nothing.
  static Result<SequenceJournal> Open(const std::string& path, std::uint64_t identity);

  // Whether a journal of other work was there.
  bool was_other() const { return was_other_; }

  // Whether all of these files are as a finished picture left them.
  bool Has(const std::vector<std::string>& files) const;

  // They are finished.
  Status Add(const std::vector<std::string>& files);

 private:
  explicit SequenceJournal(std::string path, std::uint64_t identity)
      : path_(std::move(path)), identity_(identity) {}

  std::string path_;
  std::uint64_t identity_;
  bool was_other_ = false;
  std::map<std::string, std::uint64_t> checksums_;  // by path
};

}  // namespace sheaf

#endif  // SHEAF_APP_SEQUENCE_JOURNAL_H_
