// Files that were read once and stay in memory, so that other machines read the same bytes.
#ifndef SHEAF_FORMATS_HELD_FILES_H_
#define SHEAF_FORMATS_HELD_FILES_H_

#include <string>
#include <vector>

namespace sheaf {

struct HeldFile {
  std::string path, bytes;
};

// From here on ReadWholeFile keeps what it reads, and reads it from memory the next time. Of the
// whole process, as is all of this; any thread may call it.
void HoldFiles();

// All that is held.
std::vector<HeldFile> HeldFiles();

// From here on these are the only files that ReadWholeFile finds.
void ReadOnlyHeldFiles(std::vector<HeldFile> files);

// Of ReadWholeFile: the bytes of a held file, or null; whether there are no others; keeps a file
// where files are held.
const std::string* FindHeldFile(const std::string& path);
bool AreAllFilesHeld();
void HoldFile(const std::string& path, const std::string& bytes);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_HELD_FILES_H_
