// The finished areas of a picture on disk, so that a killed run can be gone on with.
#ifndef SHEAF_APP_AREA_JOURNAL_H_
#define SHEAF_APP_AREA_JOURNAL_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "sheaf/error.h"
#include "sheaf/film.h"
#include "src/cluster/kept_areas.h"

namespace sheaf {

// The path of a picture's journal, hidden beside it: `.NAME.sheaf-journal`.
std::string JournalPath(const std::string& output);

// The picture is complete.
void RemoveJournal(const std::string& path);

// A header with the identity of the work, then a record an area, appended in any order of areas: a
// torn last one is as none. The bytes are those of this machine's floats. It stays until
// RemoveJournal.
class AreaJournal : public KeptAreas {
 public:
  // Opens the journal at `path`, or starts it. One of another identity is started anew.
  // kInputOutput where another process has it open, or it cannot be written.
  static Result<AreaJournal> Open(const std::string& path, std::uint64_t identity);

  AreaJournal(AreaJournal&& other) noexcept;
  AreaJournal& operator=(AreaJournal&& other) = delete;
  ~AreaJournal() override;

  // Whether a journal of other work was there.
  bool was_other() const { return was_other_; }

  // Finds what earlier runs have left of `picture`, with these layers. What follows a record that
  // is not whole is cut off. Once, before all calls below.
  Status Load(const PixelRect& picture, Layers layers);

  // The next rows, from row `y` on and as wide as the picture, which are earlier no more; empty
  // where they are not all there in one piece.
  Result<Film> TakeRows(int y);

  const std::vector<PixelRect>& earlier() const override { return earlier_; }
  Result<Film> Read(std::size_t index) override;
  Status Keep(const PixelRect& area, const Film& pixels) override;

 private:
  AreaJournal(int descriptor, std::string path) : descriptor_(descriptor), path_(std::move(path)) {}
  Status Start(std::uint64_t identity);
  // Whether a whole record is at end_, which is moved on.
  bool Index();

  int descriptor_;  // -1 once moved from
  std::string path_;
  bool was_other_ = false;
  PixelRect picture_;
  Layers layers_;
  std::uint64_t end_ = 0;  // of the records that are whole, in bytes
  std::vector<PixelRect> earlier_;
  std::vector<std::uint64_t> offsets_;  // of the floats of each in the file
};

}  // namespace sheaf

#endif  // SHEAF_APP_AREA_JOURNAL_H_
