// The finished bands of a picture on disk, so that a killed run can be gone on with.
#ifndef SHEAF_APP_BAND_JOURNAL_H_
#define SHEAF_APP_BAND_JOURNAL_H_

#include <cstdint>
#include <string>

#include "sheaf/error.h"
#include "sheaf/film.h"

namespace sheaf {

// The path of a picture's journal, hidden beside it: `.NAME.sheaf-journal`.
std::string JournalPath(const std::string& output);

// The picture is complete.
void RemoveJournal(const std::string& path);

// A header with the identity of the work, then a record a band, appended: a torn last one is as
// none. The bytes are those of this machine's floats. It stays until RemoveJournal.
class BandJournal {
 public:
  // Opens the journal at `path`, or starts it. One of another identity is started anew.
  // kInputOutput where another process has it open, or it cannot be written.
  static Result<BandJournal> Open(const std::string& path, std::uint64_t identity);

  BandJournal(BandJournal&& other) noexcept;
  BandJournal& operator=(BandJournal&& other) = delete;
  ~BandJournal();

  // Whether a journal of other work was there.
  bool was_other() const { return was_other_; }

  // The next band of an earlier run, as wide and with the layers as `band` is made, of at most
  // `rows` rows. False where none is left, or none that is whole: bands are then appended from here
  // on.
  Result<bool> Read(int width, Layers layers, int rows, Film* band);

  // After Read has said that none is left.
  Status Append(const Film& band);

 private:
  BandJournal(int descriptor, std::string path) : descriptor_(descriptor), path_(std::move(path)) {}
  Status Start(std::uint64_t identity);

  int descriptor_;  // -1 once moved from
  std::string path_;
  bool was_other_ = false;
  std::uint64_t end_ = 0;  // of the records that are whole and read, in bytes
};

}  // namespace sheaf

#endif  // SHEAF_APP_BAND_JOURNAL_H_
